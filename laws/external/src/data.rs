//! Data of the interface: plain C structures in the order that MFront's generic interface documents.

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

/// A step to integrate.
#[repr(C)]
pub(crate) struct BehaviourData {
    /// Buffer of at least [`MESSAGE`] characters.
    pub error_message: *mut c_char,
    pub time_step: f64,
    /// The request in its first entry, then the tangent.
    pub tangent: *mut f64,
    pub time_step_factor: *mut f64,
    pub speed_of_sound: *mut f64,
    pub start: State,
    pub end: State,
}

/// Integrates a step. Returns 1 on success, 0 if the result is not reliable, −1 on failure.
pub(crate) type Integrate = unsafe extern "C" fn(*mut BehaviourData) -> c_int;

/// Size of an error message.
pub(crate) const MESSAGE: usize = 512;
/// The first entry of the tangent on entry: integrate, with the consistent tangent.
pub(crate) const CONSISTENT_TANGENT: f64 = 4.0;
/// Version of the interface with these structures.
pub(crate) const API_VERSION: u16 = 1;
