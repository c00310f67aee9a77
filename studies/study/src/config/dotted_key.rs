//! Dotted keys such as `scene.profile.rise`: splits and joins them.

/// Returns the segments of a dotted key; a segment in double quotes may contain dots.
pub fn segments(path: &str) -> Vec<String> {
    let (mut out, mut segment, mut quoted) = (Vec::new(), String::new(), false);
    for character in path.chars() {
        match character {
            '"' => quoted = !quoted,
            '.' if !quoted => out.push(std::mem::take(&mut segment)),
            _ => segment.push(character),
        }
    }
    if !path.is_empty() {
        out.push(segment);
    }
    out.iter_mut().for_each(|segment| *segment = segment.trim().to_string());
    out
}

/// Returns a dotted key with one more segment.
pub fn join(path: &str, segment: &str) -> String {
    let quote = if segment.is_empty() || segment.contains(['.', ' ']) { "\"" } else { "" };
    let dot = if path.is_empty() { "" } else { "." };
    [path, dot, quote, segment, quote].concat()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn quoted_segments_may_hold_dots() {
        assert_eq!(segments("sweep.\"a.b\".list"), ["sweep", "a.b", "list"]);
        assert_eq!(join("sweep", "a.b"), "sweep.\"a.b\"");
    }
}
