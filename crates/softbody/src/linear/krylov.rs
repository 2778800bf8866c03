//! Newton's linear system by conjugate gradients.

use super::block::Vector;
use super::cycle::TwoLevel;

/// Vectors of the iteration. `[n_free]`
pub(crate) struct ConjugateGradients {
    /// What is left of the right-hand side.
    pub(crate) residual: Vec<Vector>,
    /// The solution so far.
    pub(crate) solution: Vec<Vector>,
    direction: Vec<Vector>,
    preconditioned: Vec<Vector>,
    product: Vec<Vector>,
    /// `D Bᵀ` times the solution: how much it takes off the pressures. `[n_coarse]`
    pub(crate) solution_mpa: Vec<f32>,
    direction_mpa: Vec<f32>,
    preconditioned_mpa: Vec<f32>,
}

/// How an iteration ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Outcome {
    Converged,
    /// Not within the iterations allowed.
    Slow,
    /// The energy curves down along a direction; the solution found before it still leads downhill.
    NotConvex,
}

impl ConjugateGradients {
    pub(crate) fn new(n_free: usize, n_coarse: usize) -> Self {
        let zeros = || vec![Vector::ZERO; n_free];
        let no_pressures = || vec![0.0; n_coarse];
        Self {
            residual: zeros(),
            solution: zeros(),
            direction: zeros(),
            preconditioned: zeros(),
            product: zeros(),
            solution_mpa: no_pressures(),
            direction_mpa: no_pressures(),
            preconditioned_mpa: no_pressures(),
        }
    }

    /// Solves until a further iteration adds less than the square of `tolerance` to the energy won so far. Returns the iterations, too.
    pub(crate) fn solve(
        &mut self,
        system: &mut TwoLevel,
        tolerance: f64,
        max_iterations: u32,
    ) -> (Outcome, u32) {
        self.solution.fill(Vector::ZERO);
        self.solution_mpa.fill(0.0);
        let mut old_square = f64::INFINITY;
        let mut won = 0.0;
        for iteration in 0..max_iterations {
            system.precondition(
                &self.residual,
                &mut self.preconditioned,
                &mut self.preconditioned_mpa,
            );
            let square = dot(&self.residual, &self.preconditioned);
            if square == 0.0 {
                return (Outcome::Converged, iteration);
            }
            if square.is_nan() || square < 0.0 {
                return (Outcome::NotConvex, iteration);
            }
            let ratio = (square / old_square) as f32;
            for (d, z) in self.direction.iter_mut().zip(&self.preconditioned) {
                *d = if iteration == 0 {
                    *z
                } else {
                    z.plus_scaled(*d, ratio)
                };
            }
            for (d, z) in self.direction_mpa.iter_mut().zip(&self.preconditioned_mpa) {
                *d = if iteration == 0 { *z } else { *z + *d * ratio };
            }
            system.matrix.multiply(
                system.pattern,
                &self.direction,
                &self.direction_mpa,
                &mut self.product,
            );
            let curvature = dot(&self.direction, &self.product);
            if curvature.is_nan() || curvature <= 0.0 {
                if iteration == 0 {
                    self.solution.copy_from_slice(&self.direction);
                    self.solution_mpa.copy_from_slice(&self.direction_mpa);
                }
                return (Outcome::NotConvex, iteration);
            }
            let length = square / curvature;
            for (x, d) in self.solution.iter_mut().zip(&self.direction) {
                *x = x.plus_scaled(*d, length as f32);
            }
            for (x, d) in self.solution_mpa.iter_mut().zip(&self.direction_mpa) {
                *x += d * length as f32;
            }
            for (r, p) in self.residual.iter_mut().zip(&self.product) {
                *r = r.plus_scaled(*p, -length as f32);
            }
            won += length * square;
            if length * square <= tolerance * tolerance * won {
                return (Outcome::Converged, iteration + 1);
            }
            old_square = square;
        }
        (Outcome::Slow, max_iterations)
    }
}

fn dot(a: &[Vector], b: &[Vector]) -> f64 {
    a.iter().zip(b).map(|(a, b)| f64::from(a.dot(b))).sum()
}
