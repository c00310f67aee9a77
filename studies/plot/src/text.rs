//! Room that text takes on a canvas, estimated without any font at hand.

/// A place on the canvas \[px\], y down.
pub type Spot = [f64; 2];

/// Estimated width of a text \[px\]; on the safe side for the usual sans-serif fonts.
pub fn text_width(text: &str, size: f64) -> f64 {
    0.6 * size * text.chars().count() as f64
}

/// Breaks a text into lines that fit into `width` \[px\].
pub fn wrapped(text: &str, size: f64, width: f64) -> Vec<String> {
    let mut lines: Vec<String> = vec![String::new()];
    for word in text.split_whitespace() {
        let line = lines.last_mut().expect("there is always a line");
        if line.is_empty() {
            line.push_str(word);
        } else if text_width(line, size) + text_width(word, size) + size <= width {
            line.push(' ');
            line.push_str(word);
        } else {
            lines.push(word.to_string());
        }
    }
    lines
}

/// An axis-parallel box on the canvas \[px\].
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Area {
    /// Upper left corner.
    pub low: Spot,
    /// Lower right corner.
    pub high: Spot,
}

impl Area {
    /// The box of a text whose anchor is at `spot` on its base line.
    pub fn of_text(spot: Spot, anchor: &str, size: f64, text: &str) -> Self {
        let width = text_width(text, size);
        let left = spot[0]
            - match anchor {
                "middle" => width / 2.0,
                "end" => width,
                _ => 0.0,
            };
        Area { low: [left, spot[1] - 0.8 * size], high: [left + width, spot[1] + 0.25 * size] }
    }

    /// The box with this middle and half width and height.
    pub fn around(middle: Spot, half: Spot) -> Self {
        Area { low: [middle[0] - half[0], middle[1] - half[1]], high: [middle[0] + half[0], middle[1] + half[1]] }
    }

    /// Area shared with another box \[px²\].
    pub fn shared(&self, other: &Area) -> f64 {
        let side = |i: usize| (self.high[i].min(other.high[i]) - self.low[i].max(other.low[i])).max(0.0);
        side(0) * side(1)
    }
}
