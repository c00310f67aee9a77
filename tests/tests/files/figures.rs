//! The choice of cases that are drawn; figures do not depend on the number of parallel jobs.

use voussoir::kinds::{RunRequest, read_study};
use voussoir::solve::Unobserved;
use voussoir_tests::Arch;

/// Returns names and bytes of the figures of a study over `count` rises with two variants.
fn figures(count: usize, output: &str, jobs: usize) -> Vec<(String, Vec<u8>)> {
    let sweep = format!("[sweep]\n\"scene.profile.rise\" = {{ from = 2.0, to = 3.0, count = {count} }}\n");
    let variants = "[[variants]]\nname = \"a\"\n[[variants]]\nname = \"b\"\nset = { \"joints.dry.friction\" = 0.4 }\n";
    let text = format!("{}{sweep}{variants}[output]\nwriters = [\"figures\"]\n{output}", Arch::default().study());
    let study = read_study(&text, "a.toml", &[]).unwrap_or_else(|wrong| panic!("{wrong}"));
    let request = RunRequest { wanted: (0..study.count()).collect(), jobs, ..RunRequest::default() };
    let files = study.run(&request, &Unobserved).files;
    files.into_iter().filter(|(name, _)| name.starts_with("figures/")).collect()
}

fn drawn(files: &[(String, Vec<u8>)]) -> Vec<&str> {
    files.iter().filter_map(|(name, _)| name.strip_suffix("-scene.svg")?.strip_prefix("figures/case-")).collect()
}

/// Up to 50 cases are all drawn. Of more cases only the case with the least load factor of each variant is drawn; here
/// the load factor decreases with the rise from 2 to 3 m.
#[test]
fn all_cases_are_drawn_up_to_fifty_and_then_the_worst() {
    assert_eq!(drawn(&figures(3, "", 1)), ["0000", "0001", "0002", "0003", "0004", "0005"]);
    assert_eq!(drawn(&figures(26, "", 1)), ["0025", "0051"]);
    assert_eq!(drawn(&figures(26, "figures = \"all\"\n", 1)).len(), 52);
    assert_eq!(drawn(&figures(3, "figures = \"worst\"\n", 1)), ["0002", "0005"]);
    for none in ["figures = \"none\"\n", "figures = false\n"] {
        assert!(figures(3, none, 1).is_empty());
    }
}

#[test]
fn figures_do_not_depend_on_how_many_are_drawn_side_by_side() {
    assert_eq!(figures(4, "", 1), figures(4, "", 2));
}
