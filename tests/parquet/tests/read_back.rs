//! What the program writes into results.parquet is read back by the crate `parquet`: the columns, the types and every bit of
//! results.csv, in several groups of rows.
//!
//! `VOUSSOIR` is the program, by default that of the main workspace (`cargo build --release -p voussoir`).

use parquet::file::reader::{FileReader, SerializedFileReader};
use parquet::record::Field;
use std::collections::BTreeMap;
use std::fs::File;
use std::path::{Path, PathBuf};
use std::process::Command;

/// Rows of a group.
const GROUP: usize = 4096;

fn program() -> PathBuf {
    let built = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../target/release/voussoir");
    std::env::var_os("VOUSSOIR").map_or(built, PathBuf::from)
}

/// A block that is pushed sideways, and one that is pressed down and carries any load, over some frictions and a swept text.
fn study(frictions: usize) -> String {
    format!(
        "name = \"tilted\"\n[scene]\nscene = \"wall\"\nwidth = 1.0\nbrick = [0.4, 0.2]\ncourses = 1\nbricks = 1\n\
         material = \"stone\"\njoint = \"dry\"\n[materials.stone]\nlaw = \"rigid\"\ndensity = 2000.0\n\
         [joints.dry]\nlaw = \"coulomb\"\nfriction = 0.4\n[[stages]]\nname = \"dead\"\ngravity = 9.81\n\
         [[stages]]\nname = \"push\"\nuntil = \"collapse\"\nloads = [{{ kind = \"body\", acceleration = [9.81, 0.0] }}]\n\
         [sweep]\n\"joints.dry.law\" = {{ list = [\"coulomb\", \"coulomb_associated\"] }}\n\
         \"joints.dry.friction\" = {{ from = 0.0, to = 3.0, count = {frictions} }}\n\
         [[variants]]\nname = \"one, \\\"quoted\\\"\"\n[[variants]]\nname = \"λ\"\nset = {{ \"stages.1.loads.0.acceleration\" = [0.0, -9.81] }}\n\
         [output]\nwriters = [\"results_csv\", \"results_parquet\"]\nfields = false\nfigures = false\n"
    )
}

/// The name of the kind of a value.
fn kind(value: &Field) -> Option<&'static str> {
    match value {
        Field::Null => None,
        Field::Bool(_) => Some("truth"),
        Field::Long(_) => Some("count"),
        Field::Double(_) => Some("number"),
        Field::Str(_) => Some("text"),
        other => panic!("no column has values like {other:?}"),
    }
}

/// Returns true if a value is the text of the same cell in a CSV file, numbers to the last bit.
fn fits(value: &Field, text: &str) -> bool {
    match value {
        Field::Null => text.is_empty(),
        Field::Str(own) => own == text,
        Field::Double(number) => text.parse::<f64>().is_ok_and(|x| x.to_bits() == number.to_bits()),
        Field::Long(count) => text.parse() == Ok(*count),
        Field::Bool(truth) => text.parse() == Ok(*truth),
        _ => false,
    }
}

/// Every cell, in one group of rows, at its border and in several; all kinds of columns are there, each with and without values.
#[test]
fn every_cell_is_that_of_the_csv_file() {
    let at = Path::new(env!("CARGO_TARGET_TMPDIR")).join("read_back");
    drop(std::fs::remove_dir_all(&at));
    std::fs::create_dir_all(&at).expect("a folder");
    for frictions in [1, GROUP / 4, GROUP / 4 + 1, 2100] {
        std::fs::write(at.join("a.toml"), study(frictions)).expect("written");
        let out = at.join(frictions.to_string());
        let run =
            Command::new(program()).args(["run", "a.toml", "--quiet", "--out"]).arg(&out).current_dir(&at).output();
        let run = run.expect("the program: build it, or give its place as VOUSSOIR");
        assert!(matches!(run.status.code(), Some(0 | 1)), "{}", String::from_utf8_lossy(&run.stderr));
        let mut csv = csv::Reader::from_path(out.join("results.csv")).expect("a table");
        let header: Vec<String> = csv.headers().expect("a header").iter().map(String::from).collect();
        let file = File::open(out.join("results.parquet")).expect("a file");
        let reader = SerializedFileReader::new(file).expect("a Parquet file");
        assert_eq!(reader.metadata().num_row_groups(), (4 * frictions).div_ceil(GROUP));
        assert_eq!(reader.metadata().file_metadata().num_rows(), 4 * frictions as i64);
        let mut kinds: BTreeMap<String, (Option<&str>, bool)> = BTreeMap::new();
        let (mut rows, mut records) = (0, csv.records());
        for row in reader.get_row_iter(None).expect("rows") {
            let (row, record) = (row.expect("a row"), records.next().expect("a row").expect("cells"));
            rows += 1;
            let mut names = header.iter();
            for ((name, value), text) in row.get_column_iter().zip(record.iter()) {
                assert_eq!(Some(name), names.next());
                assert!(fits(value, text), "row {rows}, {name}: {value:?}, {text:?}");
                let (own, missing) = kinds.entry(name.clone()).or_default();
                *missing |= kind(value).is_none();
                assert!(own.is_none() || kind(value).is_none() || *own == kind(value), "{name}: {own:?}, {value:?}");
                *own = own.or(kind(value));
            }
            assert_eq!(names.next(), None);
        }
        assert_eq!((rows, records.next().is_none()), (4 * frictions, true));
        if frictions > 1 {
            assert_eq!(kinds["joints.dry.friction"].0, Some("number"));
            for kind in ["text", "number", "count", "truth"] {
                for missing in [false, true] {
                    let there = |(own, some): &(Option<&str>, bool)| *own == Some(kind) && *some == missing;
                    assert!(kinds.values().any(there), "no {kind} column with missing values: {missing}; {kinds:?}");
                }
            }
        }
    }
}
