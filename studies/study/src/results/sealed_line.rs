//! Finished cases as lines of a journal or a part: `{"checksum":"0123456789abcdef","case":{…}}`. The checksum is FNV-1a
//! with 64 bits (Fowler, Noll and Vo) of the case's text. It detects damage; forgery is detected by the proof of the
//! case.

use crate::fnv::Fnv64;
use serde::Serialize;
use std::ops::Range;

const BEFORE: &[u8] = b"{\"checksum\":\"";
const BETWEEN: &[u8] = b"\",\"case\":";
/// Number of digits of a checksum.
const DIGITS: usize = 16;
/// Index of the first byte of a case in its line.
const CASE: usize = BEFORE.len() + DIGITS + BETWEEN.len();

/// Returns 64 bits of FNV-1a in hexadecimal.
pub fn checksum(bytes: &[u8]) -> String {
    let mut hash = Fnv64::new();
    hash.add(bytes);
    hash.text()
}

/// Returns the line of a case, with a line end before and after it, so that it is complete even after a truncated line.
pub fn sealed(case: &impl Serialize) -> serde_json::Result<Vec<u8>> {
    // Large enough for an arch of a dozen voussoirs. A case of a million blocks has half a gigabyte and is not copied.
    let mut line = Vec::with_capacity(1 << 13);
    line.push(b'\n');
    line.extend_from_slice(BEFORE);
    line.extend_from_slice(&[b'0'; DIGITS]);
    line.extend_from_slice(BETWEEN);
    serde_json::to_writer(&mut line, case)?;
    let sum = checksum(&line[1 + CASE..]);
    line[1 + BEFORE.len()..1 + BEFORE.len() + DIGITS].copy_from_slice(sum.as_bytes());
    line.extend_from_slice(b"}\n");
    Ok(line)
}

/// Returns the line of a case that is already text.
pub fn sealed_text(case: &[u8]) -> Vec<u8> {
    [BEFORE, checksum(case).as_bytes(), BETWEEN, case, b"}\n"].concat()
}

/// Returns the range of the case in a line; `None` if its checksum is wrong.
pub fn case_in(line: &[u8]) -> Option<Range<usize>> {
    let end = line.trim_ascii_end().len().checked_sub(1)?;
    let (head, case) = (line.get(..CASE)?, line.get(CASE..end)?);
    let sum = head.strip_prefix(BEFORE)?.strip_suffix(BETWEEN)?;
    (line[end] == b'}' && sum == checksum(case).as_bytes()).then_some(CASE..end)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_changed_line_is_no_case() {
        let line = sealed(&serde_json::json!({ "id": 1, "load_factor": 0.1 })).expect("a line");
        let line = &line[1..];
        let case = case_in(line).expect("a case");
        assert_eq!(&line[case.clone()], br#"{"id":1,"load_factor":0.1}"#);
        assert_eq!(sealed_text(&line[case]), line);
        for at in 0..line.len() - 1 {
            let mut changed = line.to_vec();
            changed[at] ^= 1;
            assert_eq!(case_in(&changed), None, "{at}");
            assert_eq!(case_in(&line[..at]), None, "{at}");
        }
    }
}
