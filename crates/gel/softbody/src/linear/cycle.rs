//! The two-level cycle that preconditions the system: a Gauss–Seidel sweep for errors that vary
//! from node to node, the factors of the system on the coarse mesh for smooth errors, and a
//! backward sweep, which makes the cycle symmetric.

use super::block::Vector;
use super::coarse::{CoarseSystem, Factors};
use super::matrix::{Matrix, Pattern};
use super::sweep::{Step, Vectors};
use crate::parallel::join_halves;

/// Scratch memory of the cycle.
pub(crate) struct Cycle {
    coarse: Vec<Vector>,
    moved_volumes: Vec<f32>,
}

/// The system and its preconditioner.
pub(crate) struct TwoLevel<'a> {
    pub(crate) pattern: &'a Pattern,
    pub(crate) matrix: &'a Matrix,
    pub(crate) coarse: &'a CoarseSystem,
    pub(crate) factors: &'a mut Factors,
    /// The two coarse nodes that each fine node is midway between.
    pub(crate) ends: &'a [[u32; 2]],
    pub(crate) cycle: &'a mut Cycle,
}

/// Scalar products of a residual `r` and the result `z` of the cycle.
#[derive(Clone, Copy)]
pub(crate) struct Products {
    /// `zᵀ r`
    pub(crate) square: f64,
    /// `zᵀ H z`
    pub(crate) curvature: f64,
}

impl Cycle {
    pub(crate) fn new(pattern: &Pattern) -> Self {
        Self {
            coarse: vec![Vector::ZERO; pattern.n_coarse()],
            moved_volumes: vec![0.0; pattern.n_coarse()],
        }
    }
}

impl TwoLevel<'_> {
    /// Does a step of conjugate gradients, and preconditions the residual after it. Also computes
    /// `√D Bᵀ z`.
    pub(crate) fn run(&mut self, step: Step, vectors: &mut Vectors, volumes: &mut [f32]) -> Products {
        let Cycle {
            coarse,
            moved_volumes,
        } = &mut *self.cycle;
        let (matrix, pattern) = (self.matrix, self.pattern);
        matrix.sweep_forward(pattern, step, vectors, volumes, moved_volumes);
        matrix.take_volumes(pattern, volumes, &mut vectors.defect);
        coarse.fill(Vector::ZERO);
        for (defect, ends) in vectors.defect.iter().zip(self.ends) {
            for end in ends {
                let coarse = &mut coarse[*end as usize];
                *coarse = coarse.plus_scaled(*defect, 0.5);
            }
        }
        self.coarse.solve(self.factors, coarse);
        let coarse = &*coarse;
        let (first, second) = vectors.preconditioned.split_at_mut(pattern.halves.first);
        let interpolate = |x: &mut [Vector], ends: &[[u32; 2]]| {
            for (x, ends) in x.iter_mut().zip(ends) {
                for end in ends {
                    *x = x.plus_scaled(coarse[*end as usize], 0.5);
                }
            }
        };
        let (first_ends, second_ends) = self.ends.split_at(pattern.halves.first);
        join_halves(
            || interpolate(first, first_ends),
            || interpolate(second, second_ends),
        );
        matrix.volumes(pattern, &vectors.preconditioned, volumes);
        let squares = matrix.sweep_backward(pattern, vectors, volumes);
        let volumes: f64 = volumes.iter().map(|&volume| f64::from(volume).powi(2)).sum();
        Products {
            square: squares.residual,
            curvature: squares.residual + squares.above + volumes - squares.volumes,
        }
    }
}
