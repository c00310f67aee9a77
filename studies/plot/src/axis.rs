//! Axes: values to pixels, ranges and ticks, straight or logarithmic.

use super::number::{decimal, round_values, tick_label};

/// An axis is logarithmic if its greatest value is this many times its least.
pub const WIDE: f64 = 50.0;

/// A straight axis.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Axis {
    /// Values at its two ends.
    pub values: [f64; 2],
    /// Places of the two ends \[px\].
    pub places: [f64; 2],
}

impl Axis {
    /// Place of a value \[px\].
    pub fn at(&self, value: f64) -> f64 {
        let share = (value - self.values[0]) / (self.values[1] - self.values[0]);
        self.places[0] + share * (self.places[1] - self.places[0])
    }

    /// Round values on the axis, about `count` of them.
    pub fn ticks(&self, count: usize) -> Vec<f64> {
        let (low, high) = (self.values[0].min(self.values[1]), self.values[0].max(self.values[1]));
        round_values(low, high, count)
    }
}

/// An axis of a chart, straight or logarithmic.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Scale {
    /// Values, or their decimal logarithms, to pixels.
    axis: Axis,
    /// Whether it is logarithmic.
    log: bool,
}

impl Scale {
    /// An axis between two values that run to two places \[px\].
    pub fn new(values: [f64; 2], places: [f64; 2], log: bool) -> Self {
        let values = if log { values.map(f64::log10) } else { values };
        Scale { axis: Axis { values, places }, log }
    }

    /// Place of a value \[px\].
    pub fn at(&self, value: f64) -> f64 {
        self.axis.at(if self.log { value.log10() } else { value })
    }

    /// Distance of a place from the nearer end of the axis \[px\].
    pub fn from_ends(&self, place: f64) -> f64 {
        let [from, to] = self.axis.places;
        (place - from).abs().min((place - to).abs())
    }

    /// Values with a line and a number.
    pub fn ticks(&self, count: usize) -> Vec<f64> {
        if !self.log {
            return self.axis.ticks(count);
        }
        let [low, high] = self.axis.values;
        let (first, last) = (low.floor() as i32, high.ceil() as i32);
        let steps: &[i64] = if high - low > 3.0 { &[1] } else { &[1, 2, 5] };
        // No more than a dozen decades have a line.
        let every = 1 + (last - first) / 13;
        let decades = (first..=last).filter(|power| power.rem_euclid(every) == 0);
        let all = decades.flat_map(|power| steps.iter().map(move |step| decimal(*step, power)));
        let within: Vec<f64> = all.filter(|tick| (low - 1e-9..=high + 1e-9).contains(&tick.log10())).collect();
        // Less than a decade has hardly any of these.
        if within.len() < 3 { round_values(10f64.powf(low), 10f64.powf(high), count) } else { within }
    }

    /// A tick in figures; powers of ten far from 1 are written as such.
    pub fn label(&self, tick: f64) -> String {
        if self.log && !(1e-4..1e7).contains(&tick) { format!("{tick:e}") } else { tick_label(tick) }
    }

    /// Its two ends in words.
    pub fn ends(&self) -> String {
        let [low, high] = self.values();
        format!("from {} to {}", self.label(low), self.label(high))
    }

    fn values(&self) -> [f64; 2] {
        if self.log { self.axis.values.map(|x| 10f64.powf(x)) } else { self.axis.values }
    }

    /// `low high from to log` for scripts that read values off the drawing.
    pub fn describe(&self) -> String {
        let [low, high] = self.values();
        let [from, to] = self.axis.places;
        format!("{low:e} {high:e} {from:.2} {to:.2} {}", u8::from(self.log))
    }
}

/// Least and greatest value with a margin of 4 %; a single value gets one of 10 %. `None` where there is none.
pub fn range(values: impl Iterator<Item = f64>, log: bool) -> Option<[f64; 2]> {
    let usable = values.filter(|x| x.is_finite() && (!log || *x > 0.0));
    let (low, high) = usable.fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), x| (l.min(x), h.max(x)));
    if low > high {
        return None;
    }
    if log {
        let margin = if high > low { (high / low).powf(0.04) } else { 1.5 };
        return Some([low / margin, high * margin]);
    }
    let margin = if high > low { 0.04 * (high - low) } else { 0.1 * high.abs().max(1e-9) };
    Some([low - margin, high + margin])
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn logarithmic_axes_have_decades() {
        let scale = Scale::new([0.5, 2000.0], [0.0, 100.0], true);
        assert_eq!(scale.ticks(5), [1.0, 10.0, 100.0, 1000.0]);
        assert!((Scale::new([1.0, 100.0], [0.0, 100.0], true).at(10.0) - 50.0).abs() < 1e-12);
        assert_eq!(Scale::new([1.0, 20.0], [0.0, 100.0], true).ticks(5), [1.0, 2.0, 5.0, 10.0, 20.0]);
        let wide = Scale::new([1e-16, 1.0], [0.0, 100.0], true);
        assert_eq!(wide.ticks(5).into_iter().map(|tick| wide.label(tick)).collect::<Vec<_>>()[..2], ["1e-16", "1e-14"]);
        assert_eq!((wide.label(1e-2), scale.label(1000.0)), ("0.01".into(), "1000".into()));
        assert_eq!(range([0.0, 1.0, 10.0].into_iter(), true).map(|[low, _]| low > 0.8), Some(true));
    }
}
