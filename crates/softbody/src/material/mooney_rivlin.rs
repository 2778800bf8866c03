//! `W̄ = C10 (Ī1 - 3) + C01 (Ī2 - 3)` (Mooney, 1940; Rivlin, 1948).
//! `S̄ = 2 (C10 + C01 Ī1) 1 - 2 C01 C̄`, `∂S̄/∂C̄ = 2 C01 (1⊗1 - 𝕀)`.

use glam::{DMat3, DVec3};

use super::Response;
use super::neo_hookean::trace;

#[inline]
pub(super) fn response(c10: f64, c01: f64, right_cauchy_green: &DMat3) -> Response {
    let first = trace(right_cauchy_green);
    let second = 0.5 * (first * first - trace(&(*right_cauchy_green * *right_cauchy_green)));
    Response {
        energy: c10 * (first - 3.0) + c01 * (second - 3.0),
        stress: DMat3::from_diagonal(DVec3::splat(2.0 * (c10 + c01 * first)))
            - *right_cauchy_green * (2.0 * c01),
        trace_stiffness: 2.0 * c01,
        full_stiffness: -2.0 * c01,
    }
}
