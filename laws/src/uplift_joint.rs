//! `uplift_joint`: dry friction with the pressure of water in open points.
#![doc = include_str!("uplift_joint.md")]

use crate::shared::*;
use std::sync::Arc;
use voussoir_core::law::{
    Effect, Fields, InterfaceLaw, InterfaceResponse, PointContext, TractionPoint, UpdateBranch, UpdateFailure,
};
use voussoir_core::plugin::{Capability, Card, Keys, KnownPath, Output, PluginKind, Property, Sample};

/// A dry joint with water in its open part.
#[derive(Debug, Clone, Keys)]
#[keys(check = UpliftJoint::validate)]
pub struct UpliftJoint {
    /// μ.
    #[key(like = JointKeys)]
    pub friction: Option<f64>,
    /// atan μ \[deg\].
    #[key(like = JointKeys)]
    pub friction_angle: Option<f64>,
    /// k_n \[Pa/m\].
    #[key(like = JointKeys)]
    pub normal_stiffness: f64,
    /// k_t \[Pa/m\].
    #[key(like = JointKeys)]
    pub shear_stiffness: f64,
    /// specific weight γ_w of water: the pressure per depth below the field `water_level`
    #[key(unit = "Pa/m", range = ">= 0", default = 9810.0)]
    pub water_weight: f64,
}

impl UpliftJoint {
    fn validate(&self) -> Vec<(String, String)> {
        validate_friction(self.friction, self.friction_angle, None)
    }
}

#[typetag::serde(name = "uplift_joint")]
impl InterfaceLaw for UpliftJoint {
    fn response(&self) -> Option<Arc<dyn InterfaceResponse>> {
        Some(Arc::new(UpliftResponse {
            friction: friction(self.friction, self.friction_angle),
            stiffness: [self.normal_stiffness, self.shear_stiffness],
            water_weight: self.water_weight,
        }))
    }

    fn stiffness(&self) -> Option<[f64; 2]> {
        stiffness(Some(self.normal_stiffness), Some(self.shear_stiffness))
    }
}

/// The joint slides.
const SLIDING: UpdateBranch = UpdateBranch::new("sliding", Effect::Sliding);

/// The law at a point. State: slip s.
#[derive(Debug, Clone)]
pub struct UpliftResponse {
    friction: f64,
    stiffness: [f64; 2],
    water_weight: f64,
}

impl UpliftResponse {
    /// Returns the pressure of the water that enters at a height \[m\] \[Pa\].
    fn pressure(&self, fields: Fields, height: f64) -> f64 {
        fields.get("water_level").map_or(0.0, |level| self.water_weight * (level - height).max(0.0))
    }

    /// Returns the gap beyond the one at which water enters \[m\].
    fn opened(&self, gap: f64, pressure: f64) -> f64 {
        (gap + pressure / self.stiffness[0]).max(0.0)
    }
}

impl InterfaceResponse for UpliftResponse {
    fn state_size(&self) -> usize {
        1
    }

    fn initial_state(&self, state: &mut [f64]) {
        state.fill(0.0);
    }

    fn state_names(&self) -> &'static [&'static str] {
        &["slip [m]"]
    }

    #[inline]
    fn respond_point(
        &self,
        gap: [f64; 2],
        context: &PointContext,
        old: &[f64],
        new: &mut [f64],
    ) -> Result<TractionPoint, UpdateFailure> {
        let height = context.position[1];
        let pressure = self.pressure(context.fields, height);
        let before = self.pressure(context.previous_fields, height);
        if !gap.iter().chain(&context.previous_gap).chain(old).chain([&pressure, &before]).all(|x| x.is_finite()) {
            return Err(UpdateFailure::NotFinite);
        }
        let [k_n, k_t] = self.stiffness;
        let opened = [self.opened(context.previous_gap[0], before), self.opened(gap[0], pressure)];
        let supplied = -0.5 * (opened[0] + opened[1]) * (pressure - before);
        if opened[1] > 0.0 {
            new[0] = gap[1];
            return Ok(TractionPoint {
                traction: [pressure, 0.0],
                branch: UpdateBranch::OPEN,
                stored: 0.5 * pressure * pressure / k_n - pressure * opened[1],
                supplied,
                ..TractionPoint::ZERO
            });
        }
        let normal = -k_n * gap[0];
        let trial = -k_t * (gap[1] - old[0]);
        let limit = self.friction * (normal - pressure);
        let slides = trial.abs() > limit;
        let (mut traction, mut tangent) = ([normal, trial], [[-k_n, 0.0], [0.0, -k_t]]);
        let mut slipped = 0.0;
        if slides {
            let sense = trial.signum();
            slipped = -sense * (trial.abs() - limit) / k_t;
            traction[1] = sense * limit;
            tangent[1] = [-sense * self.friction * k_n, 0.0];
        }
        new[0] = old[0] + slipped;
        let stored = 0.5 * (normal * normal / k_n + traction[1] * traction[1] / k_t);
        let branch = if slides { SLIDING } else { UpdateBranch::ELASTIC };
        Ok(TractionPoint { traction, tangent, branch, stored, dissipated: limit * slipped.abs(), supplied })
    }

    fn outputs(&self, _: [f64; 2], _: &PointContext, _: &[f64], point: &TractionPoint, values: &mut [f64]) {
        let open = point.branch == UpdateBranch::OPEN;
        values[0] = if open { 1.0 } else { 0.0 };
        values[1] = if open { point.traction[0] } else { 0.0 };
    }
}

const OUTPUTS: &[Output] = &[
    Output::point("open", "-", "1 if water can enter the point, otherwise 0"),
    Output::point("water_pressure", "Pa", "pressure of the water in an open point; 0 if it is closed"),
    Output::joint("crack_length", "m", "length of the open part of the joint").integral("open"),
    Output::joint("water_force", "N/m", "force of the water on the open part, per width").integral("water_pressure"),
    Output::case("total_crack_length", "m", "length of the open parts of all joints").integral("open"),
];

/// Without water the joint is dry friction.
const KNOWN_PATHS: &[KnownPath] = &[KnownPath {
    table: "friction = 0.5\nnormal_stiffness = 1e10\nshear_stiffness = 5e9",
    source: "by hand: without water it is dry friction, slip at μ t_n",
    steps: DRY_FRICTION,
    tolerance: 1e-12,
}];

voussoir_core::inventory::submit! {
    Card {
        kind: PluginKind::InterfaceLaw,
        tag: "uplift_joint",
        summary: "no tension, friction, and the pressure of water in the open part of the joint",
        provides: &[Capability::RESPONSE],
        claims: &[Property::DISSIPATIVE],
        samples: &[
            Sample::new("friction = 0.6\nnormal_stiffness = 1e10\nshear_stiffness = 5e9", 1e-4, &["elastic", "sliding"]),
        ],
        known_paths: KNOWN_PATHS,
        outputs: OUTPUTS,
        sources: &[
            "ICOLD 1993, Bulletin 88, Rock Foundations for Dams (full pressure in a crack)",
            "Terzaghi 1943, Theoretical Soil Mechanics, Wiley (effective pressure)",
        ],
        file: file!(),
        package: voussoir_core::package!(),
        page: include_str!("uplift_joint.md"),
        ..Card::of::<UpliftJoint>()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const LAW: UpliftResponse = UpliftResponse { friction: 0.5, stiffness: [1e9, 4e8], water_weight: 1e4 };

    /// Returns the response at a height of 1 m from a gap and a level to others.
    fn at([before, gap]: [[f64; 2]; 2], [from, to]: [f64; 2]) -> TractionPoint {
        let (from, to) = ([("water_level", from)], [("water_level", to)]);
        let context = PointContext::at([0.0, 1.0], 1.0, 1.0);
        let context = context.during(before, 0.0, [Fields::new(&from), Fields::new(&to)]);
        LAW.respond_point(gap, &context, &[0.0], &mut [0.0]).unwrap()
    }

    /// Water presses with its depth in an open point; a closed point keeps its traction, and its friction decreases.
    #[test]
    fn water_presses_in_open_points_only() {
        assert_eq!(at([[0.0; 2]; 2], [3.0, 3.0]).traction, [2e4, 0.0]);
        assert_eq!(at([[0.0; 2], [1e-3, 0.0]], [3.0, 3.0]).traction, [2e4, 0.0]);
        assert_eq!(at([[0.0; 2], [1e-3, 0.0]], [0.5, 0.5]).traction, [0.0, 0.0]);
        assert_eq!(at([[0.0; 2], [-5e-5, 1.0]], [3.0, 3.0]).traction, [5e4, -1.5e4]);
    }

    /// Work of the gap + supplied energy = change of stored energy, also if the level changes in an open joint.
    #[test]
    fn a_rising_level_supplies_energy() {
        let (mut left, mut last, mut gap, mut level) = (0.0, at([[0.0; 2]; 2], [1.0, 1.0]), [0.0; 2], 1.0);
        let first = last.stored;
        let steps = 4000;
        for step in 1..=steps {
            let share = f64::from(step) / f64::from(steps);
            let next = [1e-4 * (share - 0.5), 0.0];
            let higher = 1.0 + 3.0 * share;
            let point = at([gap, next], [level, higher]);
            left -= 0.5 * (last.traction[0] + point.traction[0]) * (next[0] - gap[0]) - point.supplied;
            (last, gap, level) = (point, next, higher);
        }
        assert!((left - (last.stored - first)).abs() < 1e-3 * left.abs(), "{left} {}", last.stored - first);
    }
}
