//! Vectors and wrenches in space.

/// Point or vector \[m\].
pub type Vec3 = nalgebra::Vector3<f64>;

/// Force and moment about a pole: \[f_x, f_y, f_z, m_x, m_y, m_z\] \[N, N m\].
pub type Wrench = [f64; 6];
