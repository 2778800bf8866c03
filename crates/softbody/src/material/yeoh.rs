//! `W̄ = Σ Ci0 (Ī1 - 3)^i`, i = 1, 2, 3 (Yeoh, Rubber Chem. Technol. 66, 1993): stiffens at large strain.
//! `S̄ = 2 W̄' 1`, `∂S̄/∂C̄ = 2 W̄'' 1⊗1`.

use glam::{DMat3, DVec3};

use super::Response;
use super::neo_hookean::trace;

#[inline]
pub(super) fn response([c10, c20, c30]: [f64; 3], right_cauchy_green: &DMat3) -> Response {
    let x = trace(right_cauchy_green) - 3.0;
    let slope = c10 + x * (2.0 * c20 + x * 3.0 * c30);
    Response {
        energy: x * (c10 + x * (c20 + x * c30)),
        stress: DMat3::from_diagonal(DVec3::splat(2.0 * slope)),
        trace_stiffness: 2.0 * (2.0 * c20 + 6.0 * c30 * x),
        full_stiffness: 0.0,
    }
}
