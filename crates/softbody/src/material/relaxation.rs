//! Finite viscoelasticity of the change of shape (Simo, Comput. Methods Appl. Mech. Eng. 60, 1987).
//!
//! The instantaneous deviatoric stress `S̃ = DEV S̄ = S̄ - (S̄:C̄)/3 C̄⁻¹` fades by a Prony series of convolutions,
//! `H_i(t) = w_i ∫ exp(-(t - s)/τ_i) dS̃/ds ds`, and the material answers with
//! `DEV[(1 - Σ w_i) S̃ + Σ H_i]`. With `S̃` linear in time within a step, the recurrence
//! `H_i ← exp(-Δt/τ_i) H_i + w_i g_i (S̃_new - S̃_old)`, `g = (1 - exp(-x))/x`, `x = Δt/τ_i`, is exact
//! (Taylor, Pister and Goudreau, 1970). What a step adds is `factor S̄_new + offset` with a constant `offset`: the derivative
//! of the potential `factor W̄(C̄) + offset:C̄/2`, so that every step stays a minimisation with a symmetric tangent.

use glam::DMat3;

use super::{Isochoric, PronyTerm, Response};
use crate::element::Deformation;

/// What a step of time does to each term of the series.
#[derive(Clone, Debug)]
pub(crate) struct Relaxation {
    /// Part of the instantaneous answer that acts over this step.
    factor: f64,
    /// For each term: what is kept of `H`, and the weight of the new stress.
    terms: Vec<(f64, f64)>,
}

/// What each tetrahedron remembers. Empty for an elastic material.
#[derive(Clone, Debug, Default)]
pub(crate) struct Memory {
    /// Instantaneous deviatoric stress `S̃` at the end of the last step, MPa. `[n_tets]`
    stress: Vec<DMat3>,
    /// Fading stresses `H`, MPa. `[n_tets][n_terms]`, flat.
    fading: Vec<DMat3>,
}

impl Relaxation {
    pub(crate) fn new(prony: &[PronyTerm], time_step_s: f64) -> Self {
        let terms: Vec<(f64, f64)> = prony
            .iter()
            .map(|term| {
                let x = time_step_s / term.time_s;
                // The limit at 0 is 1; expm1 keeps the quotient exact for small steps.
                let mean = if x > 0.0 { -(-x).exp_m1() / x } else { 1.0 };
                ((-x).exp(), term.weight * mean)
            })
            .collect();
        let long_term = 1.0 - prony.iter().map(|term| term.weight).sum::<f64>();
        Self {
            factor: long_term + terms.iter().map(|(_, weight)| weight).sum::<f64>(),
            terms,
        }
    }

    /// The constant part of this step's stress in a tetrahedron, MPa.
    #[inline]
    pub(crate) fn offset(&self, memory: &Memory, tet: usize) -> DMat3 {
        let mut offset = DMat3::ZERO;
        if !self.terms.is_empty() {
            let fading = &memory.fading[tet * self.terms.len()..][..self.terms.len()];
            for ((kept, weight), fading) in self.terms.iter().zip(fading) {
                offset += *fading * *kept - memory.stress[tet] * *weight;
            }
        }
        offset
    }

    /// The step's answer at `C̄`.
    #[inline]
    pub(crate) fn response_mpa(
        &self,
        law: &Isochoric,
        offset: &DMat3,
        right_cauchy_green: &DMat3,
    ) -> Response {
        let now = law.response_mpa(right_cauchy_green);
        Response {
            energy: self.factor * now.energy + 0.5 * contract(offset, right_cauchy_green),
            stress: now.stress * self.factor + *offset,
            trace_stiffness: self.factor * now.trace_stiffness,
            full_stiffness: self.factor * now.full_stiffness,
        }
    }
}

impl Memory {
    /// The memory of a body that has been at rest for ever.
    pub(crate) fn new(n_tets: usize, prony: &[PronyTerm]) -> Self {
        if prony.is_empty() {
            return Self::default();
        }
        Self {
            stress: vec![DMat3::ZERO; n_tets],
            fading: vec![DMat3::ZERO; n_tets * prony.len()],
        }
    }

    /// Takes a tetrahedron to the end of a step.
    pub(crate) fn remember(
        &mut self,
        step: &Relaxation,
        law: &Isochoric,
        tet: usize,
        deformation: &Deformation,
    ) {
        if step.terms.is_empty() {
            return;
        }
        let right_cauchy_green = deformation.isochoric_right_cauchy_green();
        let total = law.response_mpa(&right_cauchy_green).stress;
        let stress = total - right_cauchy_green.inverse() * (contract(&total, &right_cauchy_green) / 3.0);
        let fading = &mut self.fading[tet * step.terms.len()..][..step.terms.len()];
        for ((kept, weight), fading) in step.terms.iter().zip(fading) {
            *fading = *fading * *kept + (stress - self.stress[tet]) * *weight;
        }
        self.stress[tet] = stress;
    }
}

/// `a : b`
#[inline]
pub(crate) fn contract(a: &DMat3, b: &DMat3) -> f64 {
    a.x_axis.dot(b.x_axis) + a.y_axis.dot(b.y_axis) + a.z_axis.dot(b.z_axis)
}
