//! The depth of a TOML document. It is measured before the tree is built, because building and dropping a tree are
//! recursive.

use crate::config::limits::MAX_DEPTH;
use toml_parser::parser::{EventReceiver, parse_document};
use toml_parser::{ErrorSink, Source, Span, decoder::Encoding};

/// Returns the byte at which a document is nested deeper than [`MAX_DEPTH`]; `None` if it is not.
pub fn too_deep(text: &str) -> Option<usize> {
    let tokens = Source::new(text).lex().into_vec();
    let mut depth = Depth::default();
    parse_document(&tokens, &mut depth, &mut ());
    depth.too_deep
}

/// The depth at the current place of a document.
#[derive(Default)]
struct Depth {
    /// Segments of the header above.
    header: usize,
    in_header: bool,
    /// Depth of the entries of each inline table and list that is open.
    open: Vec<usize>,
    /// Segments of the key that is being read.
    segments: usize,
    /// Depth of the value that is being read.
    value: usize,
    too_deep: Option<usize>,
}

impl Depth {
    fn inside(&self) -> usize {
        self.open.last().copied().unwrap_or(self.header)
    }

    fn check(&mut self, depth: usize, span: Span) {
        if depth > MAX_DEPTH {
            self.too_deep.get_or_insert(span.start());
        }
    }

    fn close(&mut self) {
        self.open.pop();
        self.segments = 0;
        self.value = self.inside();
    }
}

impl EventReceiver for Depth {
    fn std_table_open(&mut self, _: Span, _: &mut dyn ErrorSink) {
        *self = Depth { in_header: true, too_deep: self.too_deep, ..Depth::default() };
    }

    fn std_table_close(&mut self, _: Span, _: &mut dyn ErrorSink) {
        self.in_header = false;
    }

    fn array_table_open(&mut self, span: Span, error: &mut dyn ErrorSink) {
        self.std_table_open(span, error);
    }

    fn array_table_close(&mut self, _: Span, _: &mut dyn ErrorSink) {
        self.in_header = false;
        self.header += 1;
    }

    /// Returns true if the parser may recurse into the table.
    fn inline_table_open(&mut self, _: Span, _: &mut dyn ErrorSink) -> bool {
        self.open.push(self.value);
        self.segments = 0;
        self.too_deep.is_none()
    }

    fn inline_table_close(&mut self, _: Span, _: &mut dyn ErrorSink) {
        self.close();
    }

    fn array_open(&mut self, span: Span, _: &mut dyn ErrorSink) -> bool {
        self.value += 1;
        self.open.push(self.value);
        self.check(self.value, span);
        self.too_deep.is_none()
    }

    fn array_close(&mut self, _: Span, _: &mut dyn ErrorSink) {
        self.close();
    }

    fn simple_key(&mut self, span: Span, _: Option<Encoding>, _: &mut dyn ErrorSink) {
        if self.in_header {
            self.header += 1;
            self.check(self.header, span);
        } else {
            self.segments += 1;
            self.check(self.inside() + self.segments, span);
        }
    }

    fn key_val_sep(&mut self, _: Span, _: &mut dyn ErrorSink) {
        self.value = self.inside() + self.segments;
        self.segments = 0;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_way_to_nest_is_counted() {
        let dotted = |count: usize| vec!["a"; count].join(".");
        let nested = |count: usize| format!("{}1{}", "{ a = ".repeat(count), " }".repeat(count));
        for (at_most, deeper) in [
            (format!("{} = 1", dotted(64)), format!("{} = 1", dotted(65))),
            (format!("[{}]", dotted(64)), format!("[{}]", dotted(65))),
            (format!("[{}]\na.a.a.a = 1", dotted(60)), format!("[{}]\na.a.a.a.a = 1", dotted(60))),
            (format!("[[{}]]\na = 1", dotted(62)), format!("[[{}]]\na = 1", dotted(64))),
            (format!("a = {}", nested(63)), format!("a = {}", nested(64))),
            (format!("a = {}{}", "[".repeat(63), "]".repeat(63)), format!("a = {}", "[".repeat(64))),
            (format!("a = [[1], {}]", nested(60)), format!("a = [{{ b = [1], a = {} }}]", nested(62))),
        ] {
            assert_eq!(too_deep(&at_most), None, "{at_most}");
            assert!(too_deep(&deeper).is_some(), "{deeper}");
        }
        assert_eq!(
            too_deep(&"a.a = 1.5\n[b]\nc = [{ d = 1 }, { d = 2 }]\n".replace("[b]", &"b.c = 2\n".repeat(100))),
            None
        );
    }
}
