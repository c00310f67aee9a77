//! Greatest differences of a result from the same case solved again by another program or on another processor.
//!
//! Processors round differently, and libraries choose their code by the features of a processor. A case solved again there
//! agrees in its claims, not in its bits. All tolerances of this comparison are here, with their reasons.

/// The kind of solver of a case: it decides the tolerances.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Route {
    /// Limit analysis.
    Limit,
    /// A path from event to event.
    Events,
    /// A path by steps.
    Steps,
}

/// A row of the table of tolerances.
#[derive(Debug, Clone, Copy)]
pub struct Tolerance {
    /// Entries of a case, in words.
    pub entries: &'static str,
    /// Greatest difference for limit analysis; `None` if it has no such entry or the stored fields prove the number.
    pub limit: Option<f64>,
    /// For paths from event to event.
    pub events: Option<f64>,
    /// For paths by steps.
    pub steps: Option<f64>,
    /// The number that it is relative to.
    pub relative_to: &'static str,
    /// Why it is so large.
    pub reason: &'static str,
}

impl Tolerance {
    /// The tolerance of a route; 0 without a tolerance.
    pub fn of(&self, route: Route) -> f64 {
        let own = match route {
            Route::Limit => self.limit,
            Route::Events => self.events,
            Route::Steps => self.steps,
        };
        own.unwrap_or(0.0)
    }

    /// Returns true if two tables agree column by column, relative to the greatest number of the column.
    pub fn same_rows(&self, stored: &[Vec<f64>], expected: &[Vec<f64>]) -> bool {
        let greatest = |column: usize| {
            let numbers = stored.iter().chain(expected).filter_map(|row| row.get(column));
            numbers.map(|x| x.abs()).filter(|x| x.is_finite()).fold(0.0, f64::max)
        };
        let columns: Vec<f64> = (0..expected.first().map_or(0, Vec::len)).map(greatest).collect();
        let same = |(a, b): (&Vec<f64>, &Vec<f64>)| {
            let near = |((a, b), most): ((&f64, &f64), &f64)| a == b || (a - b).abs() <= self.of(Route::Limit) * most;
            a.len() == b.len() && a.iter().zip(b).zip(&columns).all(near)
        };
        stored.len() == expected.len() && stored.iter().zip(expected).all(same)
    }
}

const fn row(
    entries: &'static str,
    [limit, events, steps]: [Option<f64>; 3],
    relative_to: &'static str,
    reason: &'static str,
) -> Tolerance {
    Tolerance { entries, limit, events, steps, relative_to, reason }
}

const GREATEST: &str = "greatest number of the same key";

/// Places and loads that follow from the study.
pub const GEOMETRY: Tolerance = row(
    "`point`, `loads`, directions and bounds of the fill",
    [Some(1e-12), Some(1e-12), Some(1e-12)],
    GREATEST,
    "sums, sines and square roots of the numbers of the study",
);
/// Load factors and their bounds.
pub const FACTOR: Tolerance = row(
    "`load_factor`, `bounds`, `field_factor`, `associated_load_factor`, `feasible_interval`, `bracket`; factors of stages, limit points and events",
    [Some(1e-9), Some(1e-9), Some(1e-8)],
    GREATEST,
    "the tolerance of certificates; a limit point by steps is located to rounding of the equilibrium, 1e-9 of the forces",
);
/// Forces and displacements of the stored state.
pub const STATE: Tolerance = row(
    "`field`, `displacements`, `thrust_line`, `states`, `yielded`, `joint_states`, `joint_time_step`, `joint_gaps`, `fill`, `outputs`",
    [None, Some(1e-8), Some(1e-7)],
    GREATEST,
    "gates of kinematics and laws; limit analysis: the certificate proves the stored numbers, and a second field may differ",
);
/// Velocities and hinges.
pub const RATE: Tolerance = row(
    "`motion`, `mechanism`, hinges of stages, `branches`",
    [None, Some(1e-6), Some(1e-5)],
    GREATEST,
    "the gate of flow; a rate after a peak of finite displacements is the difference of two states",
);
/// Displacement at a limit point, and the fall after it.
pub const PEAK: Tolerance = row(
    "`displacement`, `fall`, `released_energy` and `next_state` of `limit_points`, `followed_to`",
    [None, Some(1e-7), Some(1e-5)],
    GREATEST,
    "the load is flat at a peak: an error e of the factor means an error √e of the displacement",
);
/// Load-displacement curves.
pub const CURVE: Tolerance = row(
    "`curve`, as a function: each vertex of either curve lies on the other",
    [None, Some(1e-7), Some(1e-3)],
    "range of each axis",
    "steps may end at other points; between two vertices the curve is a chord",
);
/// Events beyond the greatest load, if the number of steps differs.
pub const BEYOND: Tolerance = row(
    "beyond the greatest factor: factors of events; if the second run has another number of steps, `followed_to`, `fall`, `released_energy` and `next_state` (the last two relative to themselves), and the share of events that may be missing",
    [None, None, Some(0.05)],
    "greatest factor",
    "steps that end at other points find other short events; up to the greatest factor all events must agree",
);
/// Estimates of errors.
pub const ESTIMATE: Tolerance = row(
    "`load_factor_error`",
    [Some(2e-8), Some(2e-8), Some(2e-7)],
    "load factor",
    "ten times the difference of two factors, each with its own tolerance",
);
/// Derivatives of the load factor.
pub const DERIVATIVE: Tolerance = row(
    "`left` and `right` of `sensitivities`",
    [Some(1e-6), Some(1e-6), Some(1e-6)],
    "the number itself",
    "differences of data over a relative step of 1e-5",
);
/// Zones of thrust.
pub const ZONE: Tolerance = row(
    "`zone` of `joints`",
    [Some(1e-8), Some(1e-8), Some(1e-8)],
    GREATEST,
    "the optimum of a linear program has the tolerance of certificates; a ratio of two forces loses one digit",
);
/// Values that a search has chosen.
pub const SEARCHED: Tolerance = row(
    "`parameters` of cases that `optimise` and `envelope` make; the case is then solved again at the stored values",
    [Some(1e-6), Some(1e-6), Some(1e-6)],
    "the number itself",
    "a search depends on the factors of earlier cases",
);

/// All tolerances, in the order of docs/theory/verifying.md.
pub const TOLERANCES: [&Tolerance; 11] =
    [&GEOMETRY, &FACTOR, &STATE, &RATE, &PEAK, &CURVE, &BEYOND, &ESTIMATE, &DERIVATIVE, &ZONE, &SEARCHED];

/// Keys of a case that are not compared with a second run: they measure effort, are free words, or depend on rounding.
pub const FREE: [&str; 6] = ["counters", "seconds", "notes", "certificate.failures", "end_is_checked", "end_proof"];

/// The table in Markdown, as docs/theory/verifying.md shows it.
pub fn tolerance_table() -> String {
    let mut text = String::from(
        "| entries | limit analysis | events | steps | relative to | reason |\n|---|---|---|---|---|---|\n",
    );
    for own in TOLERANCES {
        let number = |value: Option<f64>| value.map_or("–".to_string(), |value| format!("{value:e}"));
        let numbers = [own.limit, own.events, own.steps].map(number).join(" | ");
        text += &format!("| {} | {numbers} | {} | {} |\n", own.entries, own.relative_to, own.reason);
    }
    text
}
