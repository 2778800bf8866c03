//! Newton's linear system by conjugate gradients, with the factors of an earlier tangent as preconditioner.
//!
//! With the pressures eliminated, the system is `H x = b` with `H = A + B S⁻¹ Bᵀ`, symmetric and, where the energy is convex, positive
//! definite. The factors, in single precision, of any system `[A₀ -B₀; -B₀ᵀ -S]` apply `(A₀ + B₀ S⁻¹ B₀ᵀ)⁻¹` to the forces, so that they
//! stay a good preconditioner as long as tangent and contact have changed little: factors are worth keeping for several steps.

use faer::dyn_stack::MemBuffer;

use crate::body::SoftBody;
use crate::system::{Factors, System};

/// Vectors of the iteration, in the numbering of the system; the places of pressures hold zero. `[n_unknowns]`
pub(crate) struct ConjugateGradients {
    /// What is left of the right-hand side.
    pub(crate) residual: Vec<f64>,
    /// The solution so far.
    pub(crate) solution: Vec<f64>,
    direction: Vec<f64>,
    preconditioned: Vec<f64>,
    product: Vec<f64>,
    pressure_part: Vec<f64>,
    pressures: Vec<f64>,
}

/// How an iteration ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Outcome {
    Converged,
    /// Not within the iterations allowed.
    Slow,
    /// The energy curves down along a direction: the matrix is not positive definite, or the preconditioner is not.
    NotConvex,
}

impl ConjugateGradients {
    pub(crate) fn new(system: &System) -> Self {
        let zeros = || vec![0.0; system.n_unknowns()];
        Self {
            residual: zeros(),
            solution: zeros(),
            direction: zeros(),
            preconditioned: zeros(),
            product: zeros(),
            pressure_part: zeros(),
            pressures: vec![0.0; system.n_nodes()],
        }
    }

    /// Improves the solution until the norm of the preconditioned residual is below this part of `target`, the norm of the whole
    /// right-hand side; `target` is set where it is none.
    pub(crate) fn iterate(
        &mut self,
        body: &SoftBody,
        factors: &mut Factors,
        scratch: &mut MemBuffer,
        tolerance: f64,
        target: &mut Option<f64>,
        max_iterations: u32,
    ) -> Outcome {
        let mut old_square = f64::INFINITY;
        for iteration in 0..=max_iterations {
            body.system
                .precondition(factors, &self.residual, &mut self.preconditioned);
            let square = dot(&self.residual, &self.preconditioned);
            let whole = *target.get_or_insert(square);
            if square <= tolerance * tolerance * whole {
                return if square >= 0.0 {
                    Outcome::Converged
                } else {
                    Outcome::NotConvex
                };
            }
            if iteration == max_iterations || !square.is_finite() {
                break;
            }
            let ratio = square / old_square;
            for (d, z) in self.direction.iter_mut().zip(&self.preconditioned) {
                *d = *z + if iteration == 0 { 0.0 } else { ratio * *d };
            }
            self.multiply(body, factors, scratch);
            let curvature = dot(&self.direction, &self.product);
            if curvature.is_nan() || curvature <= 0.0 {
                return Outcome::NotConvex;
            }
            let length = square / curvature;
            for (x, d) in self.solution.iter_mut().zip(&self.direction) {
                *x += length * d;
            }
            for (r, p) in self.residual.iter_mut().zip(&self.product) {
                *r -= length * p;
            }
            old_square = square;
        }
        Outcome::Slow
    }

    /// `product ← H direction`
    fn multiply(&mut self, body: &SoftBody, factors: &Factors, scratch: &mut MemBuffer) {
        // [A d; -Bᵀd], and then less [-B q; ...] with q = S⁻¹Bᵀd in the pressures' places.
        self.product.fill(0.0);
        body.system
            .multiply_add(factors, &self.direction, &mut self.product);
        body.system.take_pressures(&mut self.product, &mut self.pressures);
        body.compressibility.solve(&mut self.pressures, scratch);
        self.pressure_part.fill(0.0);
        body.system
            .put_pressures(&self.pressures, &mut self.pressure_part);
        body.system
            .multiply_add(factors, &self.pressure_part, &mut self.product);
        body.system.take_pressures(&mut self.product, &mut self.pressures);
    }
}

fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}
