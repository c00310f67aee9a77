//! Vectors and wrenches in space.

/// Point or vector \[m\].
pub type Vec3 = nalgebra::Vector3<f64>;

/// Force and moment about a pole: \[f_x, f_y, f_z, m_x, m_y, m_z\] \[N, N m\].
pub type Wrench = [f64; 6];

/// Returns the velocity of a point at an arm from the pole of a motion \[v_x, v_y, v_z, ω_x, ω_y, ω_z\]: v + ω × arm.
pub fn velocity_at([x, y, z, a, b, c]: &[f64; 6], arm: &Vec3) -> Vec3 {
    Vec3::new(*x, *y, *z) + Vec3::new(*a, *b, *c).cross(arm)
}
