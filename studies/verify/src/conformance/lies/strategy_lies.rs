//! Dishonest continuation strategies: each changes an honest one.

use serde::{Deserialize, Serialize};
use std::sync::Arc;
use std::sync::atomic::{AtomicUsize, Ordering};
use voussoir_core::path::{Constraint, Continuation, Increment, Monitor};

/// A dishonest strategy.
#[derive(Debug, Clone, Copy)]
pub struct StrategyLie {
    /// Its name.
    pub name: &'static str,
    /// Changes the constraint of a step, given the increment and the number of constraints so far.
    pub constraint: fn(Constraint, &Increment, usize) -> Constraint,
    /// Changes the length of the first step.
    pub first_step: fn(f64) -> f64,
    /// Changes the greatest length of a step.
    pub largest_step: fn(f64) -> f64,
    /// Changes the claim that limit points are passed.
    pub passes_limit_points: fn(bool) -> bool,
    /// Changes the requested monitors.
    pub monitors: fn(Vec<Monitor>) -> Vec<Monitor>,
}

impl StrategyLie {
    const HONEST: StrategyLie = StrategyLie {
        name: "",
        constraint: |constraint, _, _| constraint,
        first_step: |length| length,
        largest_step: |length| length,
        passes_limit_points: |passes| passes,
        monitors: |monitors| monitors,
    };
}

/// Returns a constraint on the load factor, with a sign.
fn of_factor(sign: f64, increment: &Increment) -> Constraint {
    let derivative = Increment { factor: sign, ..Increment::default() };
    Constraint { value: sign * increment.factor, derivative }
}

/// Multiplies a constraint by a number, with its derivatives or without.
fn times(constraint: Constraint, value: f64, derivative: f64) -> Constraint {
    let d = constraint.derivative;
    Constraint {
        value: value * constraint.value,
        derivative: Increment {
            factor: derivative * d.factor,
            displacement: derivative * d.displacement,
            motion: derivative * d.motion,
            dissipation: derivative * d.dissipation,
            monitored: d.monitored.map(|m| derivative * m),
        },
    }
}

/// All dishonest strategies.
pub const STRATEGY_LIES: &[StrategyLie] = &[
    StrategyLie { name: "value_nan", constraint: |c, _, _| times(c, f64::NAN, 1.0), ..StrategyLie::HONEST },
    StrategyLie { name: "derivative_nan", constraint: |c, _, _| times(c, 1.0, f64::NAN), ..StrategyLie::HONEST },
    StrategyLie { name: "derivative_zero", constraint: |c, _, _| times(c, 1.0, 0.0), ..StrategyLie::HONEST },
    StrategyLie { name: "derivative_reversed", constraint: |c, _, _| times(c, 1.0, -1.0), ..StrategyLie::HONEST },
    StrategyLie { name: "value_zero", constraint: |c, _, _| times(c, 0.0, 0.0), ..StrategyLie::HONEST },
    StrategyLie { name: "value_infinite", constraint: |c, _, _| times(c, f64::INFINITY, 1.0), ..StrategyLie::HONEST },
    StrategyLie { name: "steps_far_too_long", constraint: |c, _, _| times(c, 1e-6, 1e-6), ..StrategyLie::HONEST },
    StrategyLie { name: "steps_far_too_short", constraint: |c, _, _| times(c, 1e9, 1e9), ..StrategyLie::HONEST },
    StrategyLie {
        name: "backwards_after_a_while",
        constraint: |c, increment, asked| if asked > 40 { of_factor(-1.0, increment) } else { c },
        ..StrategyLie::HONEST
    },
    StrategyLie { name: "backwards", constraint: |_, increment, _| of_factor(-1.0, increment), ..StrategyLie::HONEST },
    StrategyLie {
        name: "forwards_and_backwards",
        constraint: |_, increment, asked| of_factor(if asked % 7 < 4 { 1.0 } else { -1.0 }, increment),
        ..StrategyLie::HONEST
    },
    StrategyLie {
        name: "falls_after_a_while",
        constraint: |c, increment, asked| {
            if asked < 60 {
                return c;
            }
            // Accepts any step on which the factor falls.
            let derivative = Increment { factor: -1.0, motion: 1e-6, ..Increment::default() };
            Constraint { value: 1e-6 * increment.motion - increment.factor, derivative }
        },
        ..StrategyLie::HONEST
    },
    StrategyLie {
        name: "other_at_every_call",
        constraint: |c, _, asked| times(c, 1.0 + (asked % 5) as f64, 1.0),
        ..StrategyLie::HONEST
    },
    StrategyLie { name: "first_step_nan", first_step: |_| f64::NAN, ..StrategyLie::HONEST },
    StrategyLie { name: "first_step_zero", first_step: |_| 0.0, ..StrategyLie::HONEST },
    StrategyLie { name: "first_step_negative", first_step: |length| -length, ..StrategyLie::HONEST },
    StrategyLie { name: "first_step_infinite", first_step: |_| f64::INFINITY, ..StrategyLie::HONEST },
    StrategyLie { name: "first_step_of_a_thousand", first_step: |_| 1e3, ..StrategyLie::HONEST },
    StrategyLie { name: "largest_step_nan", largest_step: |_| f64::NAN, ..StrategyLie::HONEST },
    StrategyLie { name: "largest_step_zero", largest_step: |_| 0.0, ..StrategyLie::HONEST },
    StrategyLie { name: "passes_no_limit_point", passes_limit_points: |_| false, ..StrategyLie::HONEST },
    StrategyLie {
        name: "load_control_that_passes_limit_points",
        constraint: |_, increment, _| of_factor(1.0, increment),
        passes_limit_points: |_| true,
        ..StrategyLie::HONEST
    },
    StrategyLie {
        name: "monitors_that_are_not_there",
        monitors: |_| vec![Monitor::Opening { joint: usize::MAX, at: Some(f64::NAN) }; 9],
        ..StrategyLie::HONEST
    },
    StrategyLie {
        name: "panic",
        constraint: |c, _, asked| if asked > 20 { panic!("a dishonest strategy panics") } else { c },
        ..StrategyLie::HONEST
    },
];

/// A strategy that tells one lie.
#[derive(Debug, Default, Serialize, Deserialize)]
pub struct DishonestStrategy {
    /// The honest strategy; without it the constraint is always zero.
    #[serde(skip)]
    pub honest: Option<Arc<dyn Continuation>>,
    /// The lie.
    #[serde(skip)]
    pub lie: Option<&'static StrategyLie>,
    /// The number of constraints so far.
    #[serde(skip)]
    pub asked: Arc<AtomicUsize>,
}

impl DishonestStrategy {
    fn lie(&self) -> &StrategyLie {
        self.lie.unwrap_or(&StrategyLie::HONEST)
    }
}

#[typetag::serde(name = "dishonest_strategy")]
impl Continuation for DishonestStrategy {
    fn monitors(&self) -> Vec<Monitor> {
        (self.lie().monitors)(self.honest.as_ref().map_or_else(Vec::new, |honest| honest.monitors()))
    }

    fn constraint(&self, increment: &Increment, previous: Option<&Increment>) -> Constraint {
        let asked = self.asked.fetch_add(1, Ordering::Relaxed);
        let honest = self.honest.as_ref().map(|honest| honest.constraint(increment, previous));
        (self.lie().constraint)(honest.unwrap_or_default(), increment, asked)
    }

    fn passes_limit_points(&self) -> bool {
        let honest = self.honest.as_ref().is_none_or(|honest| honest.passes_limit_points());
        (self.lie().passes_limit_points)(honest)
    }

    fn first_step(&self) -> f64 {
        (self.lie().first_step)(self.honest.as_ref().map_or(0.1, |honest| honest.first_step()))
    }

    fn largest_step(&self) -> f64 {
        (self.lie().largest_step)(self.honest.as_ref().map_or(f64::INFINITY, |honest| honest.largest_step()))
    }
}
