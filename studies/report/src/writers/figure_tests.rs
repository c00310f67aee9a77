//! Figures of hand-made scenes: well-formed, finite, escaped, labels apart.

use crate::figures::displaced::Placement;
use crate::figures::mechanism::MovingBlock;
use crate::figures::sample::*;
use crate::figures::sweep::study_chart;
use crate::figures::sweep_chart;
use crate::figures::*;
use crate::output::{SceneOutput, StudyOutput};
use crate::writers::writers;
use serde_json::Value as Json;
use voussoir_core::limit::Status;
use voussoir_core::model::geometry::Vec2;
use voussoir_core::model::{Assembly, PointForce, Stage};
use voussoir_plot::chart::chart_svg;
use voussoir_plot::series::Series;
use voussoir_plot::text::Area;
use voussoir_study::results::{CaseResult, StudyResults, Totals};
use voussoir_study::study::{Drawn, Output, Resolved, SweptKeys};

struct Scene {
    name: &'static str,
    assembly: Assembly,
    stages: Vec<Stage>,
    answer: CaseResult,
}

fn scenes() -> Vec<Scene> {
    let mut scenes = Vec::new();
    for (name, span, rise, voussoirs) in
        [("strathmashie", 9.42, 2.99, 15), ("flat", 9.42, 1.8, 40), ("ring", 9.42, 4.71, 10_000)]
    {
        let assembly = arch(span, rise, voussoirs);
        let stages = arch_stages(&assembly);
        let answer = arch_answer(&assembly, &stages);
        scenes.push(Scene { name, assembly, stages, answer });
    }
    let assembly = arch(9.42, 2.0, 15);
    let stages = arch_stages(&assembly);
    let answer = arch_unbounded(&assembly, &stages);
    scenes.push(Scene { name: "unbounded", assembly, stages, answer });
    let assembly = arch(9.42, 2.99, 15);
    let mut stages = arch_stages(&assembly);
    let mut failed = arch_answer(&assembly, &stages);
    (failed.status, failed.load_factor) = (Status::NoEquilibrium, None);
    (failed.proof.field, failed.proof.thrust_line) = (None, None);
    let strip = assembly.joints[1..9].iter().enumerate().map(|(k, joint)| PointForce {
        body: k + 1,
        point: joint.ends[1],
        force: Vec2::new(0.0, -250.0),
    });
    stages[1].forces = strip.collect();
    stages[1].accelerations = vec![Vec2::new(1.0, 0.0)];
    scenes.push(Scene { name: "no equilibrium", assembly, stages, answer: failed });
    for (name, courses, bricks) in [("small wall", 6, 4), ("wall of 400", 20, 20)] {
        let (assembly, stages, answer) = wall(courses, bricks);
        scenes.push(Scene { name, assembly, stages, answer });
    }
    scenes
}

/// Tags open and close in order.
fn assert_balanced(text: &str, what: &str) {
    let mut open: Vec<&str> = Vec::new();
    for piece in text.split('<').skip(1) {
        let (tag, _) = piece.split_once('>').unwrap_or_else(|| panic!("{what}: a tag without end: {piece}"));
        if tag.starts_with(['?', '!']) {
            continue;
        }
        if let Some(closed) = tag.strip_prefix('/') {
            assert_eq!(open.pop(), Some(closed.trim()), "{what}");
        } else if !tag.trim_end().ends_with('/') && !tag.starts_with("meta") {
            open.push(tag.split_whitespace().next().unwrap_or(""));
        }
    }
    assert!(open.is_empty(), "{what}: never closed: {open:?}");
}

fn attribute<'a>(tag: &'a str, name: &str) -> &'a str {
    tag.split_once(&format!(" {name}=\"")).and_then(|(_, rest)| rest.split_once('"')).map_or("", |(value, _)| value)
}

fn drawings() -> Vec<(String, String)> {
    let mut all = Vec::new();
    for scene in scenes() {
        all.push((
            format!("{} scene", scene.name),
            scene_svg(scene.name, &scene.assembly, &scene.stages, &scene.answer),
        ));
        let mechanism = mechanism_svg(scene.name, &scene.assembly, &scene.answer);
        all.extend(mechanism.map(|svg| (format!("{} mechanism", scene.name), svg)));
    }
    all
}

#[test]
fn drawings_are_well_formed_and_finite() {
    for (name, svg) in drawings() {
        assert_balanced(&svg, &name);
        assert!(!svg.contains("NaN") && !svg.contains("inf"), "{name}: a coordinate is not finite");
    }
}

/// Every figure is named and described, keeps to the width of a page with text of 9 pt or more, and its colours have
/// counterparts on a dark page.
fn assert_readable(svg: &str, name: &str) {
    let start = svg.split('>').next().expect("a tag");
    assert!(start.contains("role=\"img\""), "{name}: {start}");
    for element in ["title", "desc"] {
        let words = svg.split(&format!("<{element}>")).nth(1).and_then(|rest| rest.split("</").next());
        assert!(words.is_some_and(|words| words.len() > 2), "{name}: no {element}");
    }
    // 18 cm are 510 pt.
    let points = 510.0 / attribute(start, "width").parse::<f64>().expect("a width");
    let mut smallest = f64::INFINITY;
    for tag in svg.split('<').skip(1).map(|rest| rest.split('>').next().expect("a tag ends")) {
        if tag.starts_with("text ") {
            smallest = smallest.min(attribute(tag, "font-size").parse().expect("a size"));
        }
        for property in ["fill", "stroke"] {
            let colour = attribute(tag, property);
            let known = ["", "none"].contains(&colour) || colour.starts_with("url(#");
            assert!(
                known || voussoir_plot::colours::DARK.iter().any(|(light, _)| *light == colour),
                "{name}: {colour}"
            );
        }
    }
    assert!(smallest * points >= 9.0, "{name}: {} pt", smallest * points);
}

#[test]
fn figures_are_readable_in_the_dark_in_print_and_aloud() {
    for (name, svg) in drawings() {
        assert_readable(&svg, &name);
    }
    with_output(true, |study| assert_readable(&study_chart(study).expect("a chart"), "chart"));
    let svg = voussoir_plot::svg::as_file(&drawings()[0].1);
    assert!(svg.contains("prefers-color-scheme:dark") && svg.contains("[fill='#e9dfcb']{fill:#5b5443}"));
    assert_balanced(&svg, "file");
}

#[test]
fn labels_do_not_overlap_and_stay_on_the_canvas() {
    for (name, svg) in drawings() {
        let size: Vec<f64> = attribute(&svg, "viewBox").split(' ').map(|x| x.parse().expect("a number")).collect();
        let texts = text_boxes(&svg);
        assert!(texts.len() > 3, "{name}");
        for (i, (words, area)) in texts.iter().enumerate() {
            assert!(
                area.low[0] >= 0.0 && area.low[1] >= 0.0 && area.high[0] <= size[2] && area.high[1] <= size[3],
                "{name}: \"{words}\" leaves the canvas"
            );
            for (other, covered) in &texts[i + 1..] {
                assert!(area.shared(covered) < 1.0, "{name}: \"{words}\" overlaps \"{other}\"");
            }
        }
    }
}

#[test]
fn displaced_blocks_keep_their_size_and_meet_at_hinges() {
    for scene in scenes() {
        let (Some(mechanism), Some(motion)) = (&scene.answer.mechanism, &scene.answer.proof.motion) else { continue };
        let (placements, _) = displaced::displaced(&scene.assembly, motion).expect("it moves");
        let placements = hinge_closure::close_hinges(&scene.assembly, mechanism, placements);
        let size = scene.assembly.size();
        for (body, placement) in scene.assembly.bodies.iter().zip(&placements).filter(|(b, _)| !b.vertices.is_empty()) {
            let (a, b) = (body.vertices[0], body.vertices[2]);
            let change = (placement.of(a) - placement.of(b)).norm() - (a - b).norm();
            assert!(change.abs() < 1e-12 * size, "{}: {} grows", scene.name, body.name);
        }
        for hinge in &mechanism.hinges {
            let joint = &scene.assembly.joints[hinge.joint];
            let at = |body: usize| placements[body].of(Vec2::from(hinge.point));
            let gap = (at(joint.minus) - at(joint.plus)).norm();
            assert!(gap < 1e-6 * size, "{}: hinge {} gapes by {gap}", scene.name, hinge.joint);
        }
    }
}

/// On the whole way of a drawing that moves, joints that do not open stay closed and hinges stay together; at its end
/// blocks are where the figure has them.
#[test]
fn moving_blocks_tear_no_joint() {
    let mut tested = 0;
    for scene in scenes() {
        let (assembly, size) = (&scene.assembly, scene.assembly.size());
        let Some(blocks) = moving_blocks(assembly, &scene.answer) else { continue };
        let mechanism = scene.answer.mechanism.as_ref().expect("a mechanism");
        let velocity = |body: usize, point: Vec2| {
            let ([x, y, spin], from) = (blocks[body].velocity, point - assembly.inertia(body).centroid);
            Vec2::new(x - spin * from.y, y + spin * from.x)
        };
        for share in [0.0, 0.1, 0.25, 0.5, 0.75, 0.9, 1.0] {
            let place = |body: usize, point: Vec2| {
                let MovingBlock { velocity, closing: [second, third] } = blocks[body];
                let twist = [0, 1, 2].map(|i| share * (velocity[i] + share * (second[i] + share * third[i])));
                Placement::of_velocity(assembly.inertia(body).centroid, twist, 1.0).of(point)
            };
            for (index, joint) in assembly.joints.iter().enumerate() {
                let (minus, plus) = (joint.minus, joint.plus);
                let hinge = mechanism.hinges.iter().find(|hinge| hinge.joint == index);
                let keeps = |point: &Vec2| (velocity(minus, *point) - velocity(plus, *point)).norm() < 1e-9 * size;
                let (points, tolerance) = match hinge {
                    Some(hinge) if share == 1.0 || share == 0.5 => (vec![Vec2::from(hinge.point)], 1e-6),
                    Some(hinge) => (vec![Vec2::from(hinge.point)], 5e-4),
                    None if joint.ends.iter().all(keeps) => (joint.ends.to_vec(), 1e-6),
                    None => continue,
                };
                tested += points.len();
                for point in points {
                    let gap = (place(minus, point) - place(plus, point)).norm();
                    assert!(gap < tolerance * size, "{}: joint {index} opens by {gap} at {share}", scene.name);
                }
            }
        }
    }
    assert!(tested > 1000, "{tested}");
}

#[test]
fn a_thrust_line_has_its_corner_where_the_load_meets_it() {
    let scene = scenes().swap_remove(0);
    let load = scene.stages[1].forces[0];
    let field = scene.answer.proof.field.as_deref().expect("a field");
    let forces = thrust::resultants(&scene.assembly, field);
    let points: Vec<_> = scene.answer.proof.thrust_line.iter().flatten().map(|p| p.map(Vec2::from)).collect();
    let pieces = thrust::thrust_pieces(&scene.assembly, &points, &forces);
    assert_eq!(pieces.len(), 1);
    for (resultant, point) in forces.iter().zip(&points) {
        let resultant = resultant.expect("every joint carries something");
        assert!((resultant.point - point.expect("every joint carries something")).norm() < 1e-9);
        assert!(resultant.force.x > 0.0, "compression pushes the right part to the right");
    }
    let jump = forces[load.body].expect("a force").force - forces[load.body - 1].expect("a force").force;
    let weight = 9.81 * scene.assembly.inertia(load.body).mass;
    assert!((jump.y + 1000.0 * scene.answer.load_factor.expect("a factor") + weight).abs() < 1e-6 * weight);
}

#[test]
fn numbers_and_units_in_words() {
    use voussoir_study::results::format::*;
    assert_eq!(format_number(698.0, 4), "698.0");
    assert_eq!(format_number(-0.012_345_678, 7), "-0.01234568");
    assert_eq!(format_number(1.5e9, 4), "1.500e9");
    assert_eq!(format_number(9999.96, 4), "10000");
    assert_eq!(format_short(0.5, 4), "0.5");
    assert_eq!(
        [format_force(698e3), format_force(999_990.0), format_force(12.0), format_force(0.0)],
        ["698.0 kN", "1.000 MN", "12.00 N", "0 N"]
    );
    assert_eq!([format_length(2.0), format_length(0.05)], ["2 m", "50 mm"]);
}

#[test]
fn a_ring_of_ten_thousand_stays_a_small_file() {
    let scene = scenes().swap_remove(2);
    let svg = scene_svg("ring", &scene.assembly, &scene.stages, &scene.answer);
    assert!(svg.len() < 2_000_000 && svg.matches("<text").count() < 30);
}

#[test]
fn special_characters_are_escaped() {
    let scene = scenes().swap_remove(0);
    let svg = scene_svg("a<b>&c, μ < 0.6 & \"dry\"", &scene.assembly, &scene.stages, &scene.answer);
    assert!(svg.contains("a&lt;b&gt;&amp;c") && svg.contains("μ &lt; 0.6 &amp;"));
    let series = Series { name: "<&>".into(), points: vec![(1.0, 2.0), (2.0, 3.0)], ..Series::default() };
    let chart = chart_svg("a<b&c", "x", "y", &[series], &["<note>".into()]);
    assert_balanced(&chart, "chart");
    assert!(!chart.contains("<note>") && !chart.contains("a<b&c"));
}

/// A sweep over the rise with two variants, the flattest cases unbounded.
fn sweep() -> (Vec<Assembly>, Vec<Vec<Stage>>, StudyResults) {
    let (mut assemblies, mut stages, mut cases) = (Vec::new(), Vec::new(), Vec::new());
    for variant in ["coulomb", "associated"] {
        for step in 0..12 {
            let rise = 4.71 - 0.35 * f64::from(step);
            let assembly = arch(9.42, rise, 15);
            let steps = arch_stages(&assembly);
            let mut case = if rise < 1.5 { arch_unbounded(&assembly, &steps) } else { arch_answer(&assembly, &steps) };
            case.label.id = cases.len();
            case.label.variant = Some(variant.into());
            case.label.parameters.insert("scene.profile.rise".into(), serde_json::json!((rise * 1e6).round() / 1e6));
            case.load_factor = case.load_factor.map(|f| f * if variant == "coulomb" { 1.0 } else { 1.12 });
            if step == 3 {
                case.notes.push("flow read as associated".into());
            }
            assemblies.push(assembly);
            stages.push(steps);
            cases.push(case);
        }
    }
    let own = Default::default();
    let results = StudyResults { study: "rise".into(), version: "0.1.0".into(), cases, own, ..StudyResults::default() };
    (assemblies, stages, results)
}

fn with_output<T>(figures: bool, then: impl FnOnce(&StudyOutput) -> T) -> T {
    let (assemblies, stages, results) = sweep();
    let pairs = assemblies.iter().zip(&stages);
    let resolved = Resolved::default();
    let scenes = pairs
        .map(|(assembly, stages)| SceneOutput { assembly, space: None, stages, finite: false, resolved: &resolved })
        .collect();
    then(&StudyOutput {
        name: "rise & <fall>",
        results: &results,
        totals: &Totals::of(&results.cases),
        scenes,
        sweep_keys: vec!["scene.profile.rise".into()],
        keys: SweptKeys::default(),
        output: Output { figures: if figures { Drawn::All } else { Drawn::Nothing }, ..Output::default() },
        drawn: None,
        inputs: None,
    })
}

#[test]
fn a_sweep_is_drawn_over_its_key() {
    with_output(true, |study| {
        let chart = study_chart(study).expect("one axis of numbers");
        assert_balanced(&chart, "chart");
        assert!(chart.contains("scene.profile.rise") && chart.contains("unbounded") && chart.contains("[kN]"));
        let two = vec!["a".to_string(), "b".to_string()];
        assert!(study_chart(&StudyOutput { sweep_keys: two, ..study.clone() }).is_none());
    });
}

#[test]
fn a_chart_of_one_point_or_none() {
    let case = blank(0, Status::Stalled);
    assert!(sweep_chart("s", &[(&case, 1.0)], "x", None).is_none());
    let one = Series { name: "a".into(), points: vec![(1.0, 5.0)], ..Series::default() };
    assert_balanced(&chart_svg("t", "x", "y", &[one], &[]), "one point");
    assert_balanced(&chart_svg("t", "x", "y", &[], &[]), "no point");
}

#[test]
fn every_writer_gives_its_files_and_they_need_nothing_else() {
    with_output(true, |study| {
        let tags: Vec<_> = writers().iter().map(|entry| entry.tag).collect();
        assert_eq!(
            tags,
            [
                "assembly_json",
                "comparison",
                "curve_csv",
                "figures",
                "joints_csv",
                "optima_csv",
                "outputs_csv",
                "report",
                "results_csv",
                "results_json",
                "results_parquet",
                "sensitivities_csv",
                "vtu"
            ]
        );
        for entry in writers() {
            for (name, bytes) in entry.writer.files(study, &Json::Null) {
                let text = String::from_utf8(bytes).expect("every file is text");
                if name.ends_with("html") || name.ends_with("svg") {
                    let markup: Vec<&str> =
                        text.split("<script").map(|part| part.rsplit("</script>").next().unwrap_or(part)).collect();
                    assert_balanced(&markup.concat(), &name);
                    assert!(!text.contains("src=") && !text.contains("href="), "{name}");
                }
            }
        }
        let csv = crate::writers::csv::results_csv(study);
        assert_eq!(csv.lines().count(), 25);
        assert!(csv.starts_with("id,variant,scene.profile.rise"));
        let report = crate::writers::report::report_html(study, 40);
        assert!(report.contains("rise &amp; &lt;fall&gt;") && report.matches("<details").count() == 23);
        let table = crate::writers::table::results_table(study);
        assert!(table.contains("[1] flow read as associated (cases 3, 15)") && table.contains("unbounded"));
    });
    with_output(false, |study| {
        assert!(crate::writers::figures::Figures.files(study, &Json::Null).is_empty());
        assert!(!crate::writers::report::report_html(study, 40).contains("<svg"));
    });
}

use crate::writers::Writer;

/// Writes the hand-made scenes for looking at: `cargo test -p voussoir -- --ignored pictures`.
#[test]
#[ignore = "writes pictures to the folder of temporary files, for looking at them"]
fn pictures() {
    let folder = std::env::temp_dir().join("voussoir-pictures");
    std::fs::create_dir_all(&folder).expect("a folder");
    for (name, svg) in drawings() {
        std::fs::write(folder.join(format!("{}.svg", name.replace(' ', "-"))), svg).expect("a file");
    }
    with_output(true, |study| {
        std::fs::write(folder.join("chart.svg"), study_chart(study).expect("a chart")).expect("a file");
        std::fs::write(folder.join("report.html"), crate::writers::report::report_html(study, 40)).expect("a file");
        std::fs::write(folder.join("table.txt"), crate::writers::table::results_table(study)).expect("a file");
        std::fs::write(folder.join("results.csv"), crate::writers::csv::results_csv(study)).expect("a file");
    });
}

/// Peaks of several lines at one abscissa: no label covers another, and each stands near its peak.
#[test]
fn labels_of_near_peaks_stand_apart() {
    let peak = |y: f64| voussoir_plot::series::Spot {
        at: (16.0, y),
        kind: "greatest",
        marker: voussoir_plot::series::Marker::Ring,
        label: format!("{y}"),
    };
    let line = |y: f64| voussoir_plot::series::Series {
        name: format!("line {y}"),
        points: vec![(10.0, 0.5 * y), (16.0, y), (30.0, 0.8 * y)],
        spots: Some(vec![peak(y)]),
        ..Default::default()
    };
    let lines = [7165.0, 7100.0, 7050.0, 5888.0].map(line);
    let svg = chart_svg("loads", "x", "y", &lines, &[]);
    let of_peak = |words: &str| [7165.0, 7100.0, 7050.0, 5888.0].iter().any(|peak| words == peak.to_string());
    let labels: Vec<Area> =
        text_boxes(&svg).into_iter().filter(|(words, _)| of_peak(words)).map(|(_, area)| area).collect();
    assert_eq!(labels.len(), 4);
    for (i, one) in labels.iter().enumerate() {
        assert!(labels[..i].iter().all(|other| one.shared(other) == 0.0), "{labels:?}");
    }
}

/// The boxes of all texts that are not turned, with their words.
fn text_boxes(svg: &str) -> Vec<(String, Area)> {
    let attribute = |tag: &str, name: &str| -> String {
        tag.split_once(&format!(" {name}=\""))
            .and_then(|(_, rest)| rest.split_once('"'))
            .map_or("", |found| found.0)
            .into()
    };
    let boxed = |piece: &str| {
        let (tag, rest) = piece.split_once('>').expect("a tag ends");
        let tag = format!(" {tag}");
        let number = |name: &str| attribute(&tag, name).parse::<f64>().expect("a number");
        let words = rest.split('<').next().unwrap_or("").trim().to_string();
        let spot = [number("x"), number("y")];
        let area = Area::of_text(spot, &attribute(&tag, "text-anchor"), number("font-size"), &words);
        (!tag.contains("rotate(")).then_some((words, area))
    };
    svg.split("<text ").skip(1).filter_map(boxed).collect()
}
