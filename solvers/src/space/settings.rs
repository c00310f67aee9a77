//! The tolerances of limit analysis in space.

/// Tolerances. Forces are in units of the loads, factors in the unit in which both loads have the same size.
#[derive(Debug, Clone, Copy)]
pub struct SpaceSettings {
    /// Distance of the bounds, relative to the factor, at which the search ends.
    pub aim: f64,
    /// Factor below which the aim is absolute: tiny collapse factors are differences of great moments.
    pub least_factor: f64,
    /// Error of equilibrium, relative to the greatest force, of a field that counts as balanced.
    pub balanced: f64,
    /// Error of equilibrium, relative to the greatest force, below which a correction of least norm gains nothing.
    pub exact: f64,
    /// Ratio of the mean products of two states above which only the first is kept for mixtures.
    pub apart: f64,
    /// Mean product, relative to the scale of the optimum, below which residuals are removed by full steps.
    pub solvable: f64,
    /// Residual of equilibrium of a direction, relative to the one that it removes, that needs no correction.
    pub refined: f64,
    /// Increase of each pivot, relative to it.
    pub pivot: f64,
    /// Increase of each pivot. It bounds motions of bodies without contact.
    pub shift: f64,
    /// Share of the way to the boundary of the cones that a step takes.
    pub boundary: f64,
    /// Least share of centring until rates are compatible with the motion.
    pub centring: f64,
    /// Step below which the search ends.
    pub least_step: f64,
    /// Error of equilibrium, relative to the loads, below which a field is worth repair.
    pub repairable: f64,
    /// Force, relative to the greatest one, of a point that cannot be loaded.
    pub negligible: f64,
    /// Relative distance of the bounds of a collapse. A certificate allows 1e-8.
    pub closed: f64,
    /// Work of the loads on a motion, relative to loads times the greatest rate, that refutes equilibrium.
    pub worked: f64,
    /// Stiffness of the softest other motion, divided by the stiffness of the mechanism, above which the mechanism is the
    /// only one.
    pub stiffer: f64,
    /// The same ratio below which there is another mechanism.
    pub as_soft: f64,
    /// Excess of the shares of a mixture over the least one: rounding of margins.
    pub mixed: f64,
    /// Greatest number of steps of a program.
    pub steps: u64,
    /// Inverse iterations that find the softest other motion.
    pub iterations: usize,
    /// Greatest number of corrections of a direction.
    pub corrections: usize,
    /// Greatest number of corrections of the equilibrium of a field.
    pub repairs: usize,
}

/// The numbers in use.
pub const SETTINGS: SpaceSettings = SpaceSettings {
    aim: 1e-10,
    least_factor: 1e-2,
    balanced: 1e-12,
    exact: 1e-15,
    apart: 0.1,
    solvable: 1e-2,
    refined: 1e-2,
    pivot: 1e-15,
    shift: 1e-18,
    boundary: 0.99,
    centring: 0.3,
    least_step: 1e-5,
    repairable: 10.0,
    negligible: 1e-6,
    closed: 9e-9,
    worked: 1e-11,
    stiffer: 1e6,
    as_soft: 1e3,
    mixed: 1e-9,
    steps: 100,
    iterations: 4,
    corrections: 6,
    repairs: 12,
};
