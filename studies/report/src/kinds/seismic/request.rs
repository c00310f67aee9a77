//! The table `[seismic]`.

use super::spectrum::Spectrum;
use voussoir_core::plugin::{Diagnostic, Keys};

/// The limit state, which fixes the ultimate displacement.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Keys)]
pub enum LimitState {
    /// d_u* = 0.4 d₀*
    LifeSafety,
    /// d_u* = 0.6 d₀*
    NearCollapse,
}

/// `above`: the place of the mechanism in a building.
#[derive(Debug, Clone, Copy, Keys)]
pub struct Above {
    /// height of the mechanism's support above the foundation
    #[key(unit = "m", range = ">= 0")]
    pub height: f64,
    /// height of the building above the foundation
    #[key(unit = "m", range = "> 0")]
    pub building: f64,
    /// first period of the building
    #[key(unit = "s", range = "> 0")]
    pub period: f64,
    /// number of storeys of the building
    #[key(range = ">= 1, <= 1000")]
    pub storeys: usize,
    /// period of the element before it rocks
    #[key(unit = "s", range = ">= 0", default = 0.0)]
    pub element_period: f64,
}

/// `[seismic]`.
#[derive(Debug, Clone, Keys)]
pub(super) struct Request {
    /// acceleration of rock or stiff ground, such as "0.25 g"
    #[key(unit = "m/s2", range = "> 0")]
    pub ground_acceleration: f64,
    /// soil factor, with the factor of the topography
    #[key(unit = "-", range = "> 0", default = 1.0)]
    pub soil: f64,
    /// corner periods of the elastic spectrum, ascending
    #[key(names = ["T_B", "T_C", "T_D"], unit = "s", range = "> 0")]
    pub periods: [f64; 3],
    /// amplification of the plateau of the spectrum
    #[key(unit = "-", range = ">= 1", default = 2.5)]
    pub amplification: f64,
    /// viscous damping, as a share of the critical damping
    #[key(unit = "-", range = ">= 0, <= 1", default = 0.05)]
    pub damping: f64,
    /// confidence factor, which divides the accelerations of the capacity
    #[key(unit = "-", range = ">= 1", default = 1.35)]
    pub confidence_factor: f64,
    /// behaviour factor of the check of accelerations
    #[key(unit = "-", range = ">= 1", default = 2.0)]
    pub behaviour_factor: f64,
    /// limit state of the check of displacements
    #[key(default = "life_safety")]
    pub limit_state: LimitState,
    /// place of the mechanism in a building
    #[key(optional = "the mechanism stands on the ground")]
    pub above: Option<Above>,
}

impl Request {
    /// Returns the elastic spectrum of the ground.
    pub fn spectrum(&self) -> Spectrum {
        Spectrum {
            ground: self.ground_acceleration * self.soil,
            amplification: self.amplification,
            damping_factor: Spectrum::damping_factor(self.damping),
            periods: self.periods,
        }
    }

    /// Returns d_u*/d₀* of the limit state.
    pub fn ultimate_share(&self) -> f64 {
        match self.limit_state {
            LimitState::LifeSafety => 0.4,
            LimitState::NearCollapse => 0.6,
        }
    }

    /// Returns the mistakes in the table as a whole.
    pub fn mistakes(&self) -> Vec<Diagnostic> {
        let mut found = Vec::new();
        if self.periods[0] > self.periods[1] || self.periods[1] > self.periods[2] {
            found.push(Diagnostic::new("seismic.periods", "must ascend").help("write [T_B, T_C, T_D]"));
        }
        if let Some(above) = &self.above
            && above.height > above.building
        {
            let message = format!("{} m is more than the height of the building, {} m", above.height, above.building);
            found.push(Diagnostic::new("seismic.above.height", message));
        }
        found
    }
}
