//! Solves Newton's linear system by conjugate gradients.

use super::block::Vector;
use super::cycle::TwoLevel;
use super::matrix::Pattern;
use super::sweep::{Step, Vectors};

/// Scratch memory of the iteration.
pub(crate) struct ConjugateGradients {
    pub(crate) vectors: Vectors,
    /// `D Bᵀ` times the solution, which is the decrease of the pressures, MPa; `[n_coarse]`.
    pub(crate) solution_mpa: Vec<f32>,
    /// `√D Bᵀ` times the direction, and times the preconditioned residual.
    direction_volumes: Vec<f32>,
    volumes: Vec<f32>,
}

/// How an iteration ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Outcome {
    Converged,
    /// It did not converge within the allowed iterations.
    Slow,
    /// The energy is concave along a direction. Along the solution that was found before it, the
    /// energy still falls.
    NotConvex,
}

impl ConjugateGradients {
    pub(crate) fn new(pattern: &Pattern) -> Self {
        let zeros = || vec![0.0; pattern.n_coarse()];
        Self {
            vectors: Vectors::new(pattern.halves.free),
            solution_mpa: zeros(),
            direction_volumes: zeros(),
            volumes: zeros(),
        }
    }

    /// Solves until an iteration adds less than the square of `tolerance` to the decrease of energy
    /// so far. Also returns the number of iterations.
    pub(crate) fn solve(
        &mut self,
        system: &mut TwoLevel,
        tolerance: f64,
        max_iterations: u32,
    ) -> (Outcome, u32) {
        self.vectors.restart();
        self.solution_mpa.fill(0.0);
        let mut step = Step::default();
        let (mut old_square, mut old_curvature) = (f64::INFINITY, 0.0);
        let mut won = 0.0;
        for iteration in 0..max_iterations {
            let products = system.run(step, &mut self.vectors, &mut self.volumes);
            let square = products.square;
            if square == 0.0 {
                return (Outcome::Converged, iteration);
            }
            if square.is_nan() || square < 0.0 {
                return (Outcome::NotConvex, iteration);
            }
            let ratio = square / old_square;
            // Directions are conjugate.
            let curvature = products.curvature - ratio * ratio * old_curvature;
            if curvature.is_nan() || curvature <= 0.0 {
                if iteration == 0 {
                    let length = 1.0;
                    self.move_along(system.pattern, Step { length, ratio: 0.0 });
                }
                return (Outcome::NotConvex, iteration);
            }
            let length = square / curvature;
            step = Step {
                length: length as f32,
                ratio: ratio as f32,
            };
            self.move_volumes(system.pattern, step);
            won += length * square;
            if length * square <= tolerance * tolerance * won {
                self.vectors.finish(step);
                return (Outcome::Converged, iteration + 1);
            }
            (old_square, old_curvature) = (square, curvature);
        }
        self.vectors.finish(step);
        (Outcome::Slow, max_iterations)
    }

    /// Takes a solution and its `√D Bᵀ` from another method; returns false if that method finds
    /// none along which the energy falls.
    pub(crate) fn take(
        &mut self,
        pattern: &Pattern,
        find: impl FnOnce(&[Vector], &mut [Vector], &mut [f32]) -> bool,
    ) -> bool {
        let Vectors {
            residual, solution, ..
        } = &mut self.vectors;
        if !find(residual, solution, &mut self.volumes) {
            return false;
        }
        let values = self.solution_mpa.iter_mut().zip(&self.volumes);
        for ((mpa, volume), root) in values.zip(&pattern.root_stiffness) {
            *mpa = root * volume;
        }
        let rows = residual.iter().zip(&*solution);
        rows.map(|(force, way)| f64::from(force.dot(way))).sum::<f64>() > 0.0
    }

    fn move_along(&mut self, pattern: &Pattern, step: Step) {
        self.move_volumes(pattern, step);
        self.vectors.finish(step);
    }

    fn move_volumes(&mut self, pattern: &Pattern, step: Step) {
        let directions = self.direction_volumes.iter_mut().zip(&self.volumes);
        let solutions = self.solution_mpa.iter_mut().zip(&pattern.root_stiffness);
        for ((direction, volume), (solution, root)) in directions.zip(solutions) {
            *direction = volume + *direction * step.ratio;
            *solution += root * *direction * step.length;
        }
    }
}
