//! Inputs of a traction update besides the gap and the state.

/// Values of named fields at a time, in SI units.
///
/// A study file sets fields in its stages, such as `fields = { water_level = "3 m" }`.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Fields<'a>(&'a [(&'a str, f64)]);

impl<'a> Fields<'a> {
    /// Creates fields from pairs of name and value.
    pub const fn new(values: &'a [(&'a str, f64)]) -> Self {
        Fields(values)
    }

    /// Returns the value of a field, or `None` if no stage has set it.
    pub fn get(&self, name: &str) -> Option<f64> {
        self.0.iter().find(|(own, _)| *own == name).map(|(_, value)| *value)
    }
}

/// Inputs of a traction update besides the gap and the state. A law reads the ones that it needs.
///
/// The type is `#[non_exhaustive]`, so that later versions can add inputs. Outside this crate, start from
/// [`default`](PointContext::default) or [`at`](PointContext::at) and set fields.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub struct PointContext<'a> {
    /// Gap (g_n, g_t) at the start of the step \[m\].
    pub previous_gap: [f64; 2],
    /// Position of the point in the undeformed scene \[m\].
    pub position: [f64; 2],
    /// Length of the joint that the point represents \[m\].
    pub length: f64,
    /// Width of the joint, perpendicular to the plane \[m\].
    pub width: f64,
    /// Duration of the step \[s\]; 0 if the load step has no duration.
    pub time_step: f64,
    /// Values of named fields at the end of the step.
    pub fields: Fields<'a>,
    /// Values of named fields at the start of the step.
    pub previous_fields: Fields<'a>,
}

impl<'a> PointContext<'a> {
    /// Creates the context of a point at a position \[m\] with a tributary length \[m\] and a width \[m\]: without
    /// duration, without fields, and with a closed previous gap.
    pub const fn at(position: [f64; 2], length: f64, width: f64) -> Self {
        let none = Fields::new(&[]);
        let previous_gap = [0.0; 2];
        PointContext { previous_gap, position, length, width, time_step: 0.0, fields: none, previous_fields: none }
    }

    /// Returns this context for a step from a previous gap \[m\] with a duration \[s\] and fields at its start and end.
    pub const fn during(self, previous_gap: [f64; 2], time_step: f64, fields: [Fields<'a>; 2]) -> Self {
        let [previous_fields, fields] = fields;
        PointContext { previous_gap, time_step, fields, previous_fields, ..self }
    }
}

impl Default for PointContext<'_> {
    /// A point at the origin that represents 1 m × 1 m, without duration and without fields.
    fn default() -> Self {
        PointContext::at([0.0; 2], 1.0, 1.0)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_field_is_found_by_its_name() {
        let values = [("temperature", 293.15), ("water_level", 3.0)];
        let fields = Fields::new(&values);
        assert_eq!(fields.get("water_level"), Some(3.0));
        assert_eq!(fields.get("level"), None);
        assert_eq!(Fields::default().get("water_level"), None);
    }

    #[test]
    fn a_step_keeps_the_place_of_its_point() {
        let context = PointContext::at([1.0, 2.0], 0.25, 3.0).during([1e-3, 0.0], 60.0, [Fields::default(); 2]);
        assert_eq!((context.position, context.length, context.width), ([1.0, 2.0], 0.25, 3.0));
        assert_eq!((context.previous_gap, context.time_step), ([1e-3, 0.0], 60.0));
    }
}
