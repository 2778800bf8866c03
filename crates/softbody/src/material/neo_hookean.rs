//! `W̄ = μ/2 (Ī1 - 3)`: rubber as a network of Gaussian chains (Treloar, 1943). Good to some 50 % of strain.

use glam::DMat3;

use super::Response;

#[inline]
pub(super) fn response(shear_modulus: f64, right_cauchy_green: &DMat3) -> Response {
    Response {
        energy: 0.5 * shear_modulus * (trace(right_cauchy_green) - 3.0),
        stress: DMat3::from_diagonal(glam::DVec3::splat(shear_modulus)),
        trace_stiffness: 0.0,
        full_stiffness: 0.0,
    }
}

#[inline]
pub(super) fn trace(matrix: &DMat3) -> f64 {
    matrix.x_axis.x + matrix.y_axis.y + matrix.z_axis.z
}
