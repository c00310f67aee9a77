//! How results.json is laid out: indented for readers where cases are few, else each case on a line of its own, which is half
//! as long.

use serde::Serialize;
use serde_json::ser::{CompactFormatter, Formatter, PrettyFormatter, Serializer};
use std::io::{self, Write};

/// Cases up to which all of them are indented.
const FEW: usize = 50;

/// Depth up to which the other layout is indented: the results and their list of cases.
const INDENTED: usize = 2;

/// Indents what is around the cases, and nothing in them.
#[derive(Default)]
struct CasePerLine {
    outside: PrettyFormatter<'static>,
    depth: usize,
}

/// Passes a call on to the formatter of the present depth.
macro_rules! by_depth {
    ($($name:ident($($argument:ident: $kind:ty),*)),*) => {
        $(fn $name<W: ?Sized + Write>(&mut self, writer: &mut W $(, $argument: $kind)*) -> io::Result<()> {
            if self.depth > INDENTED {
                CompactFormatter.$name(writer $(, $argument)*)
            } else {
                self.outside.$name(writer $(, $argument)*)
            }
        })*
    };
}

/// The same where a level begins or ends with it.
macro_rules! level {
    ($($begin:ident, $end:ident),*) => {
        $(fn $begin<W: ?Sized + Write>(&mut self, writer: &mut W) -> io::Result<()> {
            self.depth += 1;
            if self.depth > INDENTED { CompactFormatter.$begin(writer) } else { self.outside.$begin(writer) }
        }
        fn $end<W: ?Sized + Write>(&mut self, writer: &mut W) -> io::Result<()> {
            self.depth -= 1;
            if self.depth >= INDENTED { CompactFormatter.$end(writer) } else { self.outside.$end(writer) }
        })*
    };
}

impl Formatter for CasePerLine {
    level!(begin_array, end_array, begin_object, end_object);
    by_depth!(
        begin_array_value(first: bool),
        end_array_value(),
        begin_object_key(first: bool),
        begin_object_value(),
        end_object_value()
    );
}

/// Writes results of so many cases.
pub fn write_results(out: &mut dyn Write, results: &impl Serialize, cases: usize) -> io::Result<()> {
    if cases <= FEW {
        serde_json::to_writer_pretty(&mut *out, results)?;
    } else {
        results.serialize(&mut Serializer::with_formatter(&mut *out, CasePerLine::default()))?;
    }
    out.write_all(b"\n")
}

#[cfg(test)]
mod tests {
    use super::*;
    use serde_json::{Value, json};

    #[test]
    fn many_cases_take_a_line_each_and_read_back() {
        let of = |cases: usize| {
            let case = json!({ "id": 1, "bounds": [1.5, null], "field": [{ "force": [] }] });
            let results = json!({ "study": "s", "cases": vec![case; cases], "only_cases": [0, 1] });
            let mut bytes = Vec::new();
            write_results(&mut bytes, &results, cases).expect("memory");
            assert_eq!(serde_json::from_slice::<Value>(&bytes).expect("JSON"), results);
            String::from_utf8(bytes).expect("text")
        };
        assert_eq!(of(51).lines().filter(|line| line.starts_with("    {\"")).count(), 51);
        assert!(of(50).lines().count() > 50 * 8);
        assert!(of(51).lines().count() < 51 + 12);
    }
}
