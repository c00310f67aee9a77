//! The law of one contact point: an elastic spring with friction, integrated over a step.

use super::dual::Dual;

/// Parameters of a contact point.
#[derive(Debug, Clone, Copy)]
pub struct PointLaw {
    /// k_n and k_t times the tributary area \[N/m\].
    pub stiffness: [f64; 2],
    /// Coefficient of friction μ.
    pub friction: f64,
    /// Dilatancy: 0 for `coulomb`, μ for `coulomb_associated`.
    pub dilatancy: f64,
}

/// The history of a contact point.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Memory {
    /// s: the irreversible gap (dilation, slip) \[m\].
    pub slip: [f64; 2],
    /// g at the end of the last step \[m\].
    pub gap: [f64; 2],
}

/// The mode of a contact point in a step.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Mode {
    /// The point has no force.
    Open,
    /// The point is elastic.
    Stuck,
    /// The point slides, with the sign of its shear force.
    Slides {
        /// True if r_t > 0.
        positive: bool,
    },
}

/// A contact point at the end of a step.
#[derive(Debug, Clone, Copy)]
pub struct Response {
    /// (r_n, r_t) \[N\].
    pub force: [f64; 2],
    /// ∂r/∂g \[N/m\], by rows.
    pub tangent: [[f64; 2]; 2],
    /// Its history.
    pub memory: Memory,
    /// Its mode.
    pub mode: Mode,
}

type Number = Dual<2>;

impl PointLaw {
    /// The response to a step from the gap in `before` to `gap`.
    pub fn respond(&self, before: &Memory, gap: [f64; 2]) -> Response {
        let g = [Number::variable(gap[0], 0), Number::variable(gap[1], 1)];
        let slip_t = self.slip_at_closing(before, g);
        let trial_n = (g[0] - Number::constant(before.slip[0])) * -self.stiffness[0];
        let trial_t = (g[1] - slip_t) * -self.stiffness[1];
        let excess = trial_t.abs() - trial_n * self.friction;
        if trial_n.value >= 0.0 && excess.value <= 0.0 {
            let memory = Memory { slip: [before.slip[0], slip_t.value], gap };
            return response([trial_n, trial_t], memory, Mode::Stuck);
        }
        // Sliding by γ: r_n = r_n* + d k_n γ, |r_t| = |r_t*| − k_t γ = μ r_n.
        let gamma = excess * (1.0 / (self.stiffness[1] + self.friction * self.dilatancy * self.stiffness[0]));
        let normal = trial_n + gamma * (self.dilatancy * self.stiffness[0]);
        let left = trial_t.abs() - gamma * self.stiffness[1];
        let sense = if trial_t.value < 0.0 { -1.0 } else { 1.0 };
        if normal.value <= 0.0 || left.value < 0.0 {
            return self.opened(before, gap, slip_t.value);
        }
        let slip = [before.slip[0] + self.dilatancy * gamma.value, slip_t.value - sense * gamma.value];
        response([normal, left * sense], Memory { slip, gap }, Mode::Slides { positive: sense > 0.0 })
    }

    /// The tangential gap at which the shear spring is free. If the point was open, this is the tangential gap at the
    /// instant at which it closes (gaps are linear in the step).
    fn slip_at_closing(&self, before: &Memory, g: [Number; 2]) -> Number {
        let opening = before.gap[0] - before.slip[0];
        if opening <= 0.0 || g[0].value >= before.slip[0] {
            return Number::constant(before.slip[1]);
        }
        let share = (Number::constant(before.gap[0]) - g[0]).recip() * opening;
        Number::constant(before.gap[1]) + (g[1] - Number::constant(before.gap[1])) * share
    }

    /// A point that is open at the end of the step. It dilates with its whole slip, also while it is open.
    fn opened(&self, before: &Memory, gap: [f64; 2], slip_t: f64) -> Response {
        let dilation = before.slip[0] + self.dilatancy * (gap[1] - slip_t).abs();
        let memory = Memory { slip: [dilation, gap[1]], gap };
        response([Number::constant(0.0); 2], memory, Mode::Open)
    }

    /// ∂r/∂g if the point has this mode.
    pub fn tangent(&self, mode: Mode) -> [[f64; 2]; 2] {
        let [kn, kt] = self.stiffness;
        match mode {
            Mode::Open => [[0.0; 2]; 2],
            Mode::Stuck => [[-kn, 0.0], [0.0, -kt]],
            Mode::Slides { positive } => {
                let sense = if positive { 1.0 } else { -1.0 };
                let across = kt + self.friction * self.dilatancy * kn;
                // γ = (|r_t*| − μ r_n*) / (k_t + μ d k_n).
                let gamma = [self.friction * kn / across, -sense * kt / across];
                let normal = [-kn + self.dilatancy * kn * gamma[0], self.dilatancy * kn * gamma[1]];
                [normal, normal.map(|x| x * sense * self.friction)]
            }
        }
    }
}

fn response(force: [Number; 2], memory: Memory, mode: Mode) -> Response {
    Response { force: force.map(|f| f.value), tangent: force.map(|f| f.slope), memory, mode }
}
