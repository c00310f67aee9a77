//! What goes through the interface: plain C structures in the order that the generic interface of MFront documents.

use std::ffi::{c_char, c_int};

/// State at one end of a step. The library writes `forces`, `internal_variables` and the energies at the end of the step only.
#[repr(C)]
pub(crate) struct State {
    pub gradients: *const f64,
    pub forces: *mut f64,
    pub mass_density: *const f64,
    pub material_properties: *const f64,
    pub internal_variables: *mut f64,
    pub stored_energy: *mut f64,
    pub dissipated_energy: *mut f64,
    pub external_variables: *const f64,
}

/// A step to be integrated.
#[repr(C)]
pub(crate) struct BehaviourData {
    /// At least [`MESSAGE`] characters.
    pub error_message: *mut c_char,
    pub time_step: f64,
    /// What is asked for in its first entry, then the tangent.
    pub tangent: *mut f64,
    pub time_step_factor: *mut f64,
    pub speed_of_sound: *mut f64,
    pub start: State,
    pub end: State,
}

/// Integrates a step: 1 where it could, 0 where the result is not reliable, −1 where it could not.
pub(crate) type Integrate = unsafe extern "C" fn(*mut BehaviourData) -> c_int;

/// Room for an error message.
pub(crate) const MESSAGE: usize = 512;
/// The first entry of the tangent on entry: integrate, with the consistent tangent.
pub(crate) const CONSISTENT_TANGENT: f64 = 4.0;
/// The version of the interface that these structures are.
pub(crate) const API_VERSION: u16 = 1;
