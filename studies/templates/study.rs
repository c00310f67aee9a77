//! A block of 10 kN on a keyed joint of 0.1 m² is pushed by λ kN. It slides at c A + μ W = 5 + 5 kN with every solver.

use my_law as _;
use voussoir::prelude::*;

#[test]
fn the_block_slides_where_it_should() -> Result<(), StudyError> {
    let study = Study::from_file(concat!(env!("CARGO_MANIFEST_DIR"), "/keyed.toml"))?;
    let results = study.run();
    assert_eq!(results.cases.len(), 3);
    for case in &results.cases {
        let factor = case.load_factor.expect("a factor");
        assert!((factor - 10.0).abs() < 1e-6 && case.certificate.passed, "{}: {factor} {:?}", case.solver, case.notes);
    }
    Ok(())
}
