//! The direction of Newton's method.

use super::step::{Failure, Step, Unknowns};
use super::workspace::Buffers;
use crate::body::SoftBody;
use crate::clock::Instant;
use crate::linear::block::Vector;
use crate::linear::cycle::TwoLevel;
use crate::linear::direct::DirectSystem;
use crate::linear::krylov::Outcome;

/// Number of conjugate gradient iterations that still cost less than new factors.
const MAX_STALE_ITERATIONS: u32 = 12;

/// Largest number of conjugate gradient iterations with new factors: a few make up for single
/// precision.
const MAX_FRESH_ITERATIONS: u32 = 50;

impl Buffers {
    /// Newton's direction at the unknowns. Where the energy is not convex, it is that of a
    /// stiffened, convex energy.
    pub(crate) fn find_direction(
        &mut self,
        body: &SoftBody,
        step: &Step,
        x: &Unknowns,
        forcing: f64,
    ) -> Result<(), Failure> {
        match self.try_direction(body, step, x, forcing) {
            // Far from equilibrium, the predicted pressures can make the tangent so indefinite that
            // stiffening does not correct it.
            Err(Failure::Singular) if self.foreseen_mpa.iter().any(|mpa| *mpa != 0.0) => {
                self.foreseen_mpa.fill(0.0);
                self.has_matrix = false;
                self.try_direction(body, step, x, forcing)
            }
            result => result,
        }
    }

    fn try_direction(
        &mut self,
        body: &SoftBody,
        step: &Step,
        x: &Unknowns,
        forcing: f64,
    ) -> Result<(), Failure> {
        let started = Instant::now();
        if !self.has_matrix {
            self.assemble(body, step, x);
        }
        self.add_contact(body, step, x);
        self.cost.assembly_s += started.elapsed().as_secs_f64();
        if let Some(direct) = &body.direct {
            self.has_matrix = false;
            if self.find_direction_directly(body, direct) {
                return Ok(());
            }
        }
        let mut is_fresh = false;
        if self.factors.is_none() {
            self.factorise(body, step, x)?;
        }
        loop {
            self.take_residual();
            let Some(factors) = &mut self.factors else {
                break;
            };
            let mut system = TwoLevel {
                pattern: &body.pattern,
                matrix: &self.matrix,
                coarse: &body.coarse,
                factors,
                ends: &body.ends,
                cycle: &mut self.cycle,
            };
            let max_iterations = if is_fresh {
                MAX_FRESH_ITERATIONS
            } else {
                MAX_STALE_ITERATIONS
            };
            let started = Instant::now();
            let (outcome, n_iterations) = self.gradients.solve(&mut system, forcing, max_iterations);
            self.cost.linear_solve_s += started.elapsed().as_secs_f64();
            self.cost.linear_iterations += n_iterations;
            if outcome == Outcome::Converged || is_fresh {
                break;
            }
            self.factorise(body, step, x)?;
            is_fresh = true;
        }
        self.take_direction();
        Ok(())
    }

    /// Like [`Self::try_direction`], by factors of the whole system; returns false where the energy
    /// is not convex.
    fn find_direction_directly(&mut self, body: &SoftBody, direct: &DirectSystem) -> bool {
        let started = Instant::now();
        self.take_residual();
        let matrix = &self.matrix;
        let is_found = self
            .gradients
            .take(&body.pattern, |forces, displacements, volumes| {
                direct.solve(matrix, forces, displacements, volumes)
            });
        self.take_direction();
        self.cost.factorisation_s += started.elapsed().as_secs_f64();
        self.cost.factorisations += 1;
        is_found
    }

    fn take_residual(&mut self) {
        for (residual, gradient) in self.gradients.vectors.residual.iter_mut().zip(&self.gradient_n) {
            *residual = Vector::from_dvec3(-*gradient);
        }
    }

    fn take_direction(&mut self) {
        for (direction, solution) in self.direction_mm.iter_mut().zip(&self.gradients.vectors.solution) {
            *direction = solution.to_dvec3();
        }
    }
}
