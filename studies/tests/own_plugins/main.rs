//! The plug-ins of docs/adding_plug_ins.md: the page shows the file that is compiled here, and the plug-ins work
//! together.

mod tower;

use std::path::Path;
use voussoir::conformance::{Options, conform};
use voussoir::core::limit::Status;
use voussoir::core::plugin::{PluginKind, card, nearest};
use voussoir::kinds::json_schema;
use voussoir::solve_case;
use voussoir::study::load;

/// Blocks of 0.6 × 0.3 m, each 5 cm further to the right.
fn study(blocks: usize, joint: &str, solver: &str) -> String {
    format!(
        "name = \"tower\"\n[scene]\nscene = \"tower\"\nblocks = {blocks}\nblock = [0.6, 0.3]\nlean = 0.05\n[materials.stone]\n\
         law = \"rigid\"\ndensity = 2000.0\n[joints.dry]\nlaw = \"coulomb_associated\"\nfriction = 0.8\n{joint}[solver]\n{solver}\
         [[stages]]\nname = \"dead\"\ngravity = 9.80665\n[[stages]]\nname = \"live\"\nuntil = \"collapse\"\n\
         loads = [{{ kind = \"quake\", share = 1.0 }}]\n"
    )
}

/// The tower tips about the right edge of its lowest block: λ n h/2 = b/2 − s (n − 1)/2. Solved with `auto`, which
/// chooses the solver with the lowest cost, and along a path with the steps of the strategy.
#[test]
fn a_tower_tips_where_statics_says() {
    for blocks in [4, 6] {
        let n = blocks as f64;
        let by_hand = (0.6 - 0.05 * (n - 1.0)) / (n * 0.3);
        let mut case = load(&study(blocks, "", "solver = \"auto\"\n"), "a.toml", &[]).expect("a study").cases.remove(0);
        let result = solve_case(&case);
        assert_eq!((result.status, result.solver.as_str()), (Status::Collapse, "counted_conic"), "{:?}", result.notes);
        let factor = result.load_factor.expect("a factor");
        assert!((factor - by_hand).abs() < 1e-9 && result.certificate.passed, "{factor} {by_hand}");
        assert!(result.counters["asked"] >= 1);
        let compliant = "normal_stiffness = 1e10\nshear_stiffness = 4e9\n";
        let steps = "solver = \"newton_path\"\ncontinuation = { strategy = \"taxicab\", first_step = 0.2 }\n";
        case = load(&study(blocks, compliant, steps), "a.toml", &[]).expect("a study").cases.remove(0);
        let result = solve_case(&case);
        // States and witnesses prove the end of a path whose strategy is not part of the project.
        assert_eq!((result.status, result.path.end_is_checked), (Status::Collapse, Some(true)), "{:?}", result.notes);
        let factor = result.load_factor.expect("a factor");
        assert!((factor - by_hand).abs() < 1e-9 && result.certificate.passed, "{factor} {by_hand}");
    }
}

/// Their keys are checked by their cards and are in the schema, and refusals are reported at the key.
#[test]
fn their_keys_are_keys_of_study_files() {
    let text = study(2, "", "solver = \"auto\"\n");
    let wrong = |text: String| load(&text, "a.toml", &[]).expect_err("a mistake").to_string();
    assert!(wrong(text.replace("lean =", "laen =")).contains("did you mean \"lean\"?"));
    assert!(wrong(text.replace("lean = 0.05", "lean = 0.7")).contains("scene.lean"));
    assert!(wrong(text.replace("share =", "shrae =")).contains("did you mean \"share\"?"));
    assert_eq!(nearest("twoer", ["tower", "wall"].into_iter()), Some("tower"));
    let schema = json_schema().to_string();
    ["\"tower\"", "\"quake\"", "\"counted_conic\"", "\"taxicab\""]
        .iter()
        .for_each(|tag| assert!(schema.contains(tag), "{tag}"));
}

/// The page shows the file; `UPDATE_EXPECTED=1` copies it there.
#[test]
fn the_page_shows_the_plug_ins_that_are_compiled() {
    let file = include_str!("tower.rs");
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../docs/adding_plug_ins.md");
    let page = std::fs::read_to_string(&path).expect("the page");
    let start = page.find("```rust\n").expect("its example") + "```rust\n".len();
    let end = start + page[start..].find("```").expect("the end of it");
    if std::env::var_os("UPDATE_EXPECTED").is_some() {
        std::fs::write(&path, format!("{}{file}{}", &page[..start], &page[end..])).expect("written");
    } else {
        assert_eq!(&page[start..end], file, "UPDATE_EXPECTED=1 copies the file to the page");
    }
}

/// The scene and the load pass the checks of conformance.
#[test]
fn they_conform() {
    for (kind, tag) in [(PluginKind::Scene, "tower"), (PluginKind::LoadKind, "quake")] {
        let report = conform(card(kind, tag).expect("a card"), &Options::default());
        assert!(report.passed() && report.done["units"] > 1, "{report}");
    }
}
