//! Checks whole files of the Parquet writer byte by byte. polars and DuckDB read both files with all values.

use super::parquet::Parquet;
use crate::output::columns::{Cell, CellKind};

fn file(columns: Vec<(String, CellKind)>, rows: Vec<Vec<Cell>>) -> Vec<u8> {
    let (mut table, mut bytes) = (Parquet::new(columns.into_iter()), Vec::new());
    table.begin(&mut bytes).expect("a table");
    rows.into_iter().for_each(|row| table.add(row, &mut bytes).expect("a row"));
    table.end(&mut bytes).expect("a file");
    bytes
}

/// Hexadecimal digits, without the version of the program.
fn hex(bytes: &[u8]) -> String {
    let digits = |bytes: &[u8]| bytes.iter().map(|byte| format!("{byte:02x}")).collect::<String>();
    digits(bytes).replace(&digits(env!("CARGO_PKG_VERSION").as_bytes()), "")
}

/// A column of each type, with missing values.
#[test]
fn a_small_table() {
    let columns = [("t", CellKind::Text), ("n", CellKind::Number), ("w", CellKind::Whole), ("b", CellKind::Truth)];
    let row = |text: Option<&str>, number, whole, truth| {
        vec![Cell::Text(text.map(Into::into)), Cell::Number(number), Cell::Whole(whole), Cell::Truth(truth)]
    };
    let rows = vec![
        row(Some("arch"), Some(-1.5), Some(7), Some(true)),
        row(None, None, None, None),
        row(Some("°"), Some(0.1), Some(-300), Some(false)),
    ];
    let bytes = file(columns.map(|(name, kind)| (name.to_string(), kind)).into(), rows);
    let expected = concat!(
        "504152311500153015302c1506150015061506000006000000020102000201040000006172636802000000c2b01500153415342c1506",
        "150015061506000006000000020102000201000000000000f8bf9a9999999999b93f1500153415342c15061500150615060000060000",
        "000201020002010700000000000000d4feffffffffffff1500151615162c150615001506150600000600000002010200020101150219",
        "5c4804726f7773150800150c2502180174250000150a250218016e00150425021801770015002502180162001606191c194c26081c15",
        "0c1925000619180174150016061652165226080000265a1c150a192500061918016e1500160616561656265a000026b0011c15041925",
        "000619180177150016061656165626b00100002686021c150019250006191801621500160616381638268602000016b6021606002816",
        "766f7573736f69722076657273696f6e2000bc00000050415231",
    );
    assert_eq!(hex(&bytes), expected);
}

/// Two groups of rows, and more columns than a short list can have. The test compares the length of the file and a sum
/// of its bytes weighted by position.
#[test]
fn a_large_table() {
    let columns = (0..15).map(|place| (format!("c{place}"), CellKind::Whole)).collect();
    let rows = (0..4100).map(|row| (0..15).map(|place| Cell::Whole((row % 5 > 0).then_some(row * place))).collect());
    let bytes = file(columns, rows.collect());
    let digits = hex(&bytes);
    let sum = digits.bytes().fold(0_u64, |sum, digit| sum.wrapping_mul(31).wrapping_add(u64::from(digit)));
    assert_eq!((bytes.len(), sum), (444_702, 18_308_854_698_036_804_348));
}
