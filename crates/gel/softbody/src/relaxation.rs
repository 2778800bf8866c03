//! Finite viscoelasticity of the change of shape (Simo, Comput. Methods Appl. Mech. Eng. 60, 1987).
//!
//! The instantaneous deviatoric stress `S̃ = DEV S̄ = S̄ - (S̄:C̄)/3 C̄⁻¹` relaxes by a Prony
//! series of convolutions, `H_i(t) = w_i ∫ exp(-(t - s)/τ_i) dS̃/ds ds`, and the stress of the
//! material is `DEV[(1 - Σ w_i) S̃ + Σ H_i]`. If `S̃` is linear in time within a step, the
//! recurrence `H_i ← exp(-Δt/τ_i) H_i + w_i g_i (S̃_new - S̃_old)` with `g = (1 - exp(-x))/x` and
//! `x = Δt/τ_i` is exact (Taylor, Pister and Goudreau, 1970).
//!
//! The stress at the end of a step is `factor S̄_new + offset` with a constant `offset`. It is the
//! derivative of the potential `factor W̄(C̄) + offset:C̄/2`, so that every step remains a
//! minimization with a symmetric tangent.

use twintac_material::PronyTerm;

use crate::wide::Wide;

/// A symmetric matrix: xx, yy, zz, yz, xz, xy.
pub(crate) type Symmetric<T> = [Wide<T>; 6];

/// The effect of a time step on each term of the series.
#[derive(Clone, Debug)]
pub(crate) struct Relaxation {
    /// Fraction of the instantaneous stress that acts in this step.
    pub(crate) factor: f64,
    /// For each term, the factor of `H` and the weight of the change of stress.
    terms: Vec<(f64, f64)>,
    pub(crate) time_step_s: f64,
}

/// The history variables of a body's material. Empty for an elastic material.
#[derive(Clone, Debug, Default)]
pub(crate) struct History {
    /// Instantaneous deviatoric stress `S̃` at the end of the last step, followed by the relaxing
    /// stresses `H`, MPa; `[n_points][1 + n_terms]`, flat.
    stresses: Vec<Symmetric<f64>>,
    stride: usize,
}

impl Relaxation {
    pub(crate) fn new(prony: &[PronyTerm], time_step_s: f64) -> Self {
        let terms: Vec<(f64, f64)> = prony
            .iter()
            .map(|term| {
                let x = time_step_s / term.time_s;
                // The limit at 0 is 1; `exp_m1` keeps the quotient exact for small steps.
                let mean = if x > 0.0 { -(-x).exp_m1() / x } else { 1.0 };
                ((-x).exp(), term.weight * mean)
            })
            .collect();
        let long_term = 1.0 - prony.iter().map(|term| term.weight).sum::<f64>();
        Self {
            factor: long_term + terms.iter().map(|(_, weight)| weight).sum::<f64>(),
            terms,
            time_step_s,
        }
    }

    /// The constant part of this step's stress at each point, MPa; empty for an elastic material;
    /// `[n_points]`.
    pub(crate) fn offsets(&self, history: &History) -> Vec<Symmetric<f64>> {
        let points = history.stresses.chunks_exact(history.stride.max(1));
        points.map(|point| self.offset(&point[0], &point[1..])).collect()
    }

    /// The constant part at one point, from its last instantaneous stress and its relaxing
    /// stresses.
    fn offset(&self, last: &Symmetric<f64>, fading: &[Symmetric<f64>]) -> Symmetric<f64> {
        let mut offset = [Wide::zero(); 6];
        for ((kept, weight), fading) in self.terms.iter().zip(fading) {
            for i in 0..6 {
                offset[i] += fading[i] * Wide::splat(*kept) - last[i] * Wide::splat(*weight);
            }
        }
        offset
    }
}

impl History {
    /// The history variables of a body that has always been at rest.
    pub(crate) fn new(n_points: usize, prony: &[PronyTerm]) -> Self {
        if prony.is_empty() {
            return Self::default();
        }
        let stride = 1 + prony.len();
        Self {
            stresses: vec![[Wide::zero(); 6]; n_points * stride],
            stride,
        }
    }

    pub(crate) fn is_empty(&self) -> bool {
        self.stresses.is_empty()
    }

    /// `own` times these history variables plus `times` times others.
    pub(crate) fn combined(&self, own: f64, other: &Self, times: f64) -> Self {
        let mut sum = self.clone();
        let entries = sum.stresses.as_flattened_mut().iter_mut();
        for (entry, other) in entries.zip(other.stresses.as_flattened()) {
            *entry = *entry * Wide::splat(own) + *other * Wide::splat(times);
        }
        sum
    }

    /// Updates eight points to the end of a step, where their instantaneous deviatoric stress is
    /// `S̃`, MPa.
    pub(crate) fn update(&mut self, step: &Relaxation, point: usize, stress: &Symmetric<f64>) {
        let stresses = &mut self.stresses[point * self.stride..][..self.stride];
        if let Some((last, fading)) = stresses.split_first_mut() {
            for ((kept, weight), fading) in step.terms.iter().zip(fading) {
                for i in 0..6 {
                    let added = (stress[i] - last[i]) * Wide::splat(*weight);
                    fading[i] = fading[i] * Wide::splat(*kept) + added;
                }
            }
            *last = *stress;
        }
    }
}
