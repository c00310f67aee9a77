//! The gallery: a page with the studies of `studies/cases`. The text of a study is the comment at the head of its file. Its
//! picture is a stored figure of `docs/figures`, or a figure that a run of the study writes.

use super::tree;

/// A study of `studies/cases`.
struct Exhibit {
    /// Name of its file.
    study: &'static str,
    /// A path below `docs/`, or the name of a figure that its run writes.
    figure: &'static str,
    /// Text alternative of the figure.
    alternative: &'static str,
}

const fn exhibit(study: &'static str, figure: &'static str, alternative: &'static str) -> Exhibit {
    Exhibit { study, figure, alternative }
}

/// Headings and their studies. Studies of more than ten seconds have stored figures.
const EXHIBITS: [(&str, &[Exhibit]); 7] = [
    (
        "Bridges",
        &[
            exhibit(
                "prestwood",
                "case-0002-scene.svg",
                "Arch with fill, a wheel load, the thrust line and four hinges",
            ),
            exhibit("viaduct", "figures/viaduct_worst.svg", "Three spans on piers under a bogie"),
            exhibit("bolton", "case-0000-scene.svg", "Arch of two rings with fill and a load"),
            exhibit("abutments", "sweep.svg", "Load over the rise, fixed supports and abutments 8 m and 3 m wide"),
            exhibit("rise_fill", "sweep.svg", "Load over the rise with and without fill"),
        ],
    ),
    (
        "Limit analysis",
        &[
            exhibit("strathmashie_rise", "sweep.svg", "Load at collapse over the rise, two strengths"),
            exhibit("milankovitch", "case-0000-mechanism.svg", "Mechanism of a semicircular ring"),
            exhibit("best_inclination", "optimum.svg", "Load over the inclination of the supports, three rises"),
            exhibit("wall", "case-0000-mechanism.svg", "Mechanism of a wall that is pushed"),
        ],
    ),
    (
        "Flow rules",
        &[
            exhibit("flow_rule_ten_scenes", "figures/flow_rule_ten_scenes.svg", "Ratios of four loads, ten scenes"),
            exhibit("flow_rule_rings", "figures/flow_rule_rings.svg", "Ratios of loads over friction"),
            exhibit("flow_rule_walls", "figures/flow_rule_walls.svg", "Ratios of loads of three walls"),
            exhibit("flow_rule_map", "figures/flow_rule_map.svg", "Map over friction and height of a block"),
        ],
    ),
    (
        "Space",
        &[
            exhibit("space_dome", "case-0000-mechanism.svg", "Mechanism of a dome that is pushed"),
            exhibit(
                "space_flow_rule_wall",
                "figures/space_flow_rule_wall.svg",
                "Ratios of loads of a wall with a pier",
            ),
            exhibit(
                "space_flow_rule_barrel",
                "figures/space_flow_rule_barrel.svg",
                "Ratios of loads of a barrel vault",
            ),
            exhibit("space_flow_rule_vault", "figures/space_flow_rule_vault.svg", "Ratios of loads of a groin vault"),
            exhibit("space_flow_rule_dome", "figures/space_flow_rule_dome.svg", "Ratios of loads of a dome"),
        ],
    ),
    (
        "Paths",
        &[
            exhibit("strathmashie_elastic", "figures/strathmashie_path.svg", "Load over displacement with hinges"),
            exhibit("strathmashie_finite", "figures/finite_peak.svg", "Peak over grading, three meshes"),
            exhibit("shallow_arch", "figures/shallow_path.svg", "Load over displacement with a peak"),
            exhibit("spreading_supports", "case-0002-mechanism.svg", "Arch whose right support has moved out"),
            exhibit("cohesive_bar", "figures/softening_bar.svg", "Softening and snap-back of two bars"),
            exhibit("cohesive_arch", "curve.svg", "Load over displacement with several bonds"),
            exhibit("strathmashie_cap", "figures/crushing_mechanism.svg", "Elements that have yielded"),
            exhibit(
                "rise_softening",
                "figures/rise_softening.svg",
                "Load over the rise, stone that softens and that does not",
            ),
            exhibit("softening_arch", "figures/softening_stone.svg", "Load over displacement, softening stone"),
        ],
    ),
    (
        "Earthquakes",
        &[
            exhibit("seismic_facade", "seismic.svg", "Capacity curve of a facade that overturns"),
            exhibit("seismic_portal", "figures/seismic_portal.svg", "Capacity curve of a portal"),
            exhibit("seismic_arch", "seismic.svg", "Capacity curve of an arch on two piers"),
        ],
    ),
    (
        "One point",
        &[
            exhibit("point_cap_uniaxial", "path.svg", "Stress over strain, two strengths"),
            exhibit("point_cap_triaxial", "path.svg", "Stress over strain under lateral pressure"),
            exhibit("point_cap_compaction", "path.svg", "Pressure over shortening"),
            exhibit("point_cap_crushing", "path.svg", "Softening of two band widths"),
            exhibit("point_softening", "path.svg", "Axial stress over strain with softening"),
            exhibit("point_wearing", "path.svg", "Shear of a rough joint that wears"),
            exhibit("point_lourenco_rots", "path.svg", "Shear of a mortar joint under three pressures"),
            exhibit("point_cohesive", "path.svg", "Shear of a mortar joint down to friction"),
        ],
    ),
];

fn exhibits() -> impl Iterator<Item = &'static Exhibit> {
    EXHIBITS.iter().flat_map(|(_, all)| all.iter())
}

impl Exhibit {
    /// Its picture in the book.
    fn picture(&self) -> String {
        if self.figure.contains('/') { self.figure.into() } else { format!("gallery/{}.svg", self.study) }
    }

    /// The first paragraph of the comment at the head of its file.
    fn text(&self) -> String {
        let path = tree().join(format!("studies/cases/{}.toml", self.study));
        let source = std::fs::read_to_string(&path).unwrap_or_else(|error| panic!("{}: {error}", path.display()));
        let lines: Vec<&str> = source.lines().map_while(|line| line.strip_prefix("# ")).collect();
        assert!(!lines.is_empty(), "{} does not begin with a comment", path.display());
        lines.join(" ")
    }
}

/// Names of the studies that must be run for the gallery, with the figure of the run and its name in the book.
pub fn runs() -> Vec<(&'static str, &'static str, String)> {
    let own = exhibits().filter(|exhibit| !exhibit.figure.contains('/'));
    own.map(|exhibit| (exhibit.study, exhibit.figure, exhibit.picture())).collect()
}

/// Files of all pictures.
pub(super) fn figures() -> Vec<String> {
    exhibits().map(Exhibit::picture).collect()
}

/// The page.
pub(super) fn page() -> String {
    let mut page =
        "# Gallery\n\nEvery picture on this page is a result of a study in `studies/cases`. Run a study with \
                    `voussoir run studies/cases/NAME.toml`.\n"
            .to_string();
    for (heading, all) in EXHIBITS {
        page += &format!("\n## {heading}\n");
        for exhibit in all {
            let Exhibit { study, alternative, .. } = exhibit;
            page += &format!("\n### {study}\n\n{}\n\n", exhibit.text());
            page += &format!("![{alternative}]({})\n\nFile: `studies/cases/{study}.toml`\n", exhibit.picture());
        }
    }
    page
}
