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

/// Numbers of the steps of elastic joints. Forces are relative to the sum of the loads; the power of a step is divided by the power per
/// unit of the load factor before joints slip.
#[derive(Debug, Clone, Copy)]
pub struct JointSettings {
    /// Tangential over normal stiffness of the courses.
    pub ratios: [f64; 3],
    /// The same of a further course, which only searches a state.
    pub soft: f64,
    /// Numbers of steps, in place of each one, of the courses that decide if the structure stands.
    pub parts: [f64; 2],
    /// Greatest difference of a force after a step of these courses and after two half steps, relative to the greatest force.
    pub accuracy: f64,
    /// Factor that these courses reach if the stage has no end: the live load over the dead load.
    pub end: f64,
    /// Least stiffness of a point, relative to the mean.
    pub softest: f64,
    /// Relative distance of the factors of two states that differ.
    pub differ: f64,
    /// Greatest number of courses that start at a lower state.
    pub rounds: usize,
    /// Jump, relative to the greatest, of a point that neither slips nor opens.
    pub at_rest: f64,
    /// Unbalanced force of a step with the law's own friction.
    pub balanced: f64,
    /// The same if iterations reduce it no further.
    pub nearly: f64,
    /// The same with fictitious cohesion: such steps lead to a state but prove nothing.
    pub lagged: f64,
    /// Error of the flow, relative to the greatest jump, and power left, also relative to the loads. The certificate allows 1e-12.
    pub settled: f64,
    /// Increase of pivots under dead load: a body may have no contact yet.
    pub shift: f64,
    /// Increase of pivots with fictitious cohesion, where sliding joints leave no stiffness.
    pub regular: f64,
    /// Slope at the end of a line search, relative to that at its start.
    pub slope: f64,
    /// Fictitious normal force, relative to the loads, with which joints hardly slip.
    pub endless: f64,
    /// Share of the new normal force in the next fictitious cohesion.
    pub relaxed: f64,
    /// Power, relative to the norm of the live load, of the step that measures the compliance.
    pub probe: f64,
    /// Power of the first step.
    pub first: f64,
    /// Power of the greatest step: beyond, rounding of the jumps shows in the forces.
    pub greatest: f64,
    /// Power below which no step is tried.
    pub least: f64,
    /// Ratio of a step to the one before.
    pub growth: f64,
    /// Share of a step that is tried after a failure.
    pub shorter: f64,
    /// Iterations of a step with the law's own friction.
    pub newton: usize,
    /// Iterations of a step with fictitious cohesion.
    pub convex: usize,
    /// Trials of a line search.
    pub search: usize,
    /// Steps under dead load with fictitious cohesion.
    pub passes: usize,
    /// Greatest number of steps with fictitious cohesion before the law's own friction is tried again.
    pub longest: usize,
    /// Steps whose factors are reported if the course does not settle.
    pub reported: usize,
    /// Greatest number of iterations of a course, and of its steps.
    pub iterations: u64,
    /// Number of rigid programs of a sequence.
    pub programs: usize,
    /// Normal forces of all points of the first program of two sequences, relative to their mean under the dead load.
    pub sticky: [f64; 2],
    /// Cohesion and tensile strength of each point of these programs, relative to the mean normal force. Few joints then move.
    pub few: f64,
    /// Power of the first step from a rigid program.
    pub guessed: f64,
    /// Jumps, relative to the greatest, of points of a guess that neither slip nor open.
    pub resting: [f64; 3],
    /// Power of a contact, relative to loads and motion, that counts as zero at the end of a course in standard position.
    pub nearly_settled: f64,
    /// Distance of the numbers of a scene in standard position.
    pub grid: f64,
    /// Relative size of a vector or a mean that gives no axis of the standard position.
    pub none: f64,
    /// Greatest number of bodies of a scene with refined guesses: they decompose dense matrices.
    pub bodies: usize,
}

/// The numbers in use.
pub const JOINTS: JointSettings = JointSettings {
    ratios: [0.1, 0.3, 1.0],
    soft: 1e-4,
    parts: [1.0, 2.0],
    accuracy: 1e-3,
    end: 1e3,
    softest: 1e-2,
    differ: 1e-9,
    rounds: 8,
    at_rest: 1e-10,
    balanced: 1e-14,
    nearly: 1e-12,
    lagged: 1e-10,
    settled: 1e-13,
    shift: 1e-12,
    regular: 1e-9,
    slope: 0.3,
    endless: 1e3,
    relaxed: 0.5,
    probe: 1e-3,
    first: 0.01,
    greatest: 1e3,
    least: 1e-8,
    growth: 1.6,
    shorter: 0.25,
    newton: 15,
    convex: 60,
    search: 30,
    passes: 60,
    longest: 16,
    reported: 20,
    iterations: 1000,
    programs: 6,
    sticky: [100.0, 10.0],
    few: 1e-3,
    guessed: 30.0,
    resting: [1e-7, 1e-5, 1e-3],
    nearly_settled: 1e-9,
    grid: 1.0 / (1u64 << 33) as f64,
    none: 1e-3,
    bodies: 100,
};

/// Numbers of the descent over mechanisms.
#[derive(Debug, Clone, Copy)]
pub struct DescentSettings {
    /// Greatest number of mechanisms tried in the descent from a state.
    pub mechanisms: usize,
    /// Greatest number of bodies of a scene with descents: each step decomposes a dense matrix.
    pub bodies: usize,
    /// Slip, relative to the greatest jump, below which points and contacts are tried at rest first.
    pub slow: f64,
    /// Number of slow points and contacts that are tried at rest.
    pub slowest: usize,
    /// Greatest change of a direction of slip in a descent \[rad\].
    pub turn: f64,
    /// Share of this change that is tried after a failure.
    pub turn_again: f64,
    /// Greatest distance of the mechanisms whose dual motions count in a descent, relative to the change that is tried.
    pub near: f64,
    /// Iterations for the shortest vector of a convex hull.
    pub hull: usize,
    /// Change of a direction of slip below which no descent is tried \[rad\].
    pub least_turn: f64,
    /// Distance from the friction limit, relative to it, at which a point may slip.
    pub full: f64,
    /// Normal force, relative to the greatest, below which a point carries nothing. Power of the live load below which a motion
    /// is no mechanism; the known state has a power of one.
    pub idle: f64,
    /// Singular value, relative to the greatest, that counts as zero.
    pub null: f64,
    /// Error of the flow, relative to the greatest jump, and power left, also relative to the loads, of a state that is accepted. The
    /// certificate allows 1e-12.
    pub proved: f64,
}

/// The numbers in use.
pub const DESCENT: DescentSettings = DescentSettings {
    mechanisms: 200,
    bodies: 60,
    slow: 0.3,
    slowest: 8,
    turn: 0.3,
    turn_again: 0.5,
    near: 8.0,
    hull: 200,
    least_turn: 1e-6,
    full: 1e-7,
    idle: 1e-8,
    null: 1e-10,
    proved: 5e-13,
};

/// Numbers of the proof by branching.
#[derive(Debug, Clone, Copy)]
pub struct BranchingSettings {
    /// Greatest number of blocks.
    pub bodies: usize,
    /// Relative distance below the known state at which the proof ends.
    pub gap: f64,
    /// Greatest number of tangents of the friction of a point.
    pub tangents: usize,
    /// Relative excess of a shear force over friction that adds a tangent.
    pub exceeded: f64,
    /// Greatest number of programs with more tangents in a part.
    pub rounds: usize,
    /// Greatest number of pivots of a program.
    pub pivots: u64,
    /// Rounding by which bounds are relaxed.
    pub outward: f64,
    /// Width of a sector that is not divided \[rad\].
    pub narrow: f64,
    /// Power left, relative to greatest force times greatest jump, of forces and jumps that fit.
    pub fits: f64,
}

/// The numbers in use.
pub const BRANCHING: BranchingSettings = BranchingSettings {
    bodies: 12,
    gap: 1e-5,
    tangents: 48,
    exceeded: 1e-3,
    rounds: 4,
    pivots: 5000,
    outward: 1e-9,
    narrow: 1e-7,
    fits: 1e-9,
};
