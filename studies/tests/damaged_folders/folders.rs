//! Results folders of small studies of every kind.

use crate::program::voussoir;
use std::path::{Path, PathBuf};

/// An arch; `joint` contains the joint law, `rest` everything after it.
fn arch(name: &str, head: &str, material: &str, joint: &str, rest: &str) -> String {
    format!(
        "name = \"{name}\"\n{head}\n[scene]\nscene = \"arch\"\nprofile = {{ shape = \"segmental\", span = 4.0, rise = 1.0 }}\n\
         thickness = 0.3\nwidth = 1.0\nvoussoirs = 7\nends = \"jointed\"\nmaterial = \"stone\"\njoint = \"dry\"\n\
         [materials.stone]\n{material}\ndensity = 2200.0\n[joints.dry]\n{joint}\n[[stages]]\nname = \"dead\"\ngravity = 9.81\n\
         [[stages]]\nname = \"live\"\nuntil = \"collapse\"\n\
         loads = [{{ kind = \"point\", span_fraction = 0.3, force = [0.0, -1000.0] }}]\n{rest}"
    )
}

const RIGID: &str = "law = \"rigid\"";
const ELASTIC: &str = "law = \"elastic\"\nyoung_modulus = 5e9\npoisson_ratio = 0.2";
const ASSOCIATED: &str = "law = \"coulomb_associated\"\nfriction = 0.6";
const MESH: &str = "[scene.mesh]\nelements = [1, 2]\n";

/// Name and text of each study; the last one is a report.
pub fn studies() -> Vec<(&'static str, String)> {
    let path = |name: &str, solver: &str| {
        let rest = format!("{MESH}[solver]\n{solver}\n[output]\ncurve = true\nstates = 4\n");
        arch(name, "", ELASTIC, "law = \"coulomb\"\nfriction = 0.7", &rest)
    };
    let variants =
        "[[variants]]\nname = \"dry\"\n[[variants]]\nname = \"slippery\"\nset = { \"joints.dry.friction\" = 0.35 }\n";
    let axes =
        "[sweep]\n\"scene.thickness\" = { list = [0.28, 0.32] }\n\"scene.profile.rise\" = { list = [0.9, 1.1] }\n";
    let envelope = "[envelope]\nparameter = \"stages.1.loads.0.span_fraction\"\nfrom = 0.2\nto = 0.4\nscan = 3\n";
    let optimise = "[optimise]\nparameter = \"scene.profile.rise\"\nfrom = 0.8\nto = 1.2\nscan = 3\ntolerance = 0.2\n";
    let point = "name = \"point\"\nkind = \"point\"\n[joints.mortar]\nlaw = \"cohesive\"\nfriction = 0.75\n\
                 tensile_strength = \"0.25 MPa\"\ncohesion = \"0.35 MPa\"\nnormal_stiffness = \"82 GPa/m\"\n\
                 shear_stiffness = \"36 GPa/m\"\ntensile_fracture_energy = 18.0\nshear_fracture_energy = 125.0\n[point]\n\
                 joint = \"mortar\"\nplot = [\"gap_t\", \"traction_t\"]\n[[point.path]]\nsteps = 1\ntraction = { n = 0.0 }\n\
                 [[point.path]]\nsteps = 9\ngap = { t = -0.0008 }\n";
    let report = "name = \"report\"\nkind = \"report\"\n[report]\nstudies = [\"limit.toml\"]\n";
    vec![
        ("limit", arch("limit", "", RIGID, ASSOCIATED, "[sweep]\n\"scene.thickness\" = { list = [0.28, 0.32] }\n")),
        (
            "own_flow",
            arch("own_flow", "", RIGID, "law = \"coulomb\"\nfriction = 0.4", "[solver]\nsolver = \"limit_least\"\n"),
        ),
        ("event", path("event", "solver = \"event_path\"")),
        ("newton", path("newton", "solver = \"newton_path\"")),
        ("finite", path("finite", "solver = \"newton_path\"\nkinematics = \"finite\"")),
        ("compare", arch("compare", "kind = \"compare\"", RIGID, ASSOCIATED, variants)),
        ("map", arch("map", "kind = \"map\"", RIGID, ASSOCIATED, &format!("{axes}{variants}"))),
        ("envelope", arch("envelope", "kind = \"envelope\"", RIGID, ASSOCIATED, envelope)),
        ("optimise", arch("optimise", "kind = \"optimise\"", RIGID, ASSOCIATED, optimise)),
        ("point", point.into()),
        ("report", report.into()),
    ]
}

/// Runs all studies. The folders have the names of the studies.
pub fn written_folders(at: &Path) -> Vec<PathBuf> {
    let studies = studies();
    for (name, text) in &studies {
        std::fs::write(at.join(format!("{name}.toml")), text).expect("written");
    }
    let run = |name: &str| {
        let end = voussoir(&["run", &format!("{name}.toml"), "--out", name, "--quiet"], at);
        assert!(matches!(end.code, Some(0 | 1)), "{name}: {}", end.text);
        at.join(name)
    };
    studies.iter().map(|(name, _)| run(name)).collect()
}

/// Copies a folder over another one.
pub fn copy_folder(from: &Path, to: &Path) {
    drop(std::fs::remove_dir_all(to));
    std::fs::create_dir_all(to).expect("a folder");
    for entry in std::fs::read_dir(from).expect("a folder").flatten() {
        let place = to.join(entry.file_name());
        if entry.path().is_dir() {
            copy_folder(&entry.path(), &place);
        } else {
            std::fs::copy(entry.path(), place).expect("copied");
        }
    }
}
