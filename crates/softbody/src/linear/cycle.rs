//! The two-level cycle that preconditions the system: a sweep of Gauss–Seidel for what varies from node to node, the factors of the
//! system on the coarse mesh for what does not, and the sweep the other way round, so that the whole stays symmetric.

use super::block::Vector;
use super::coarse::{CoarseSystem, Factors};
use super::matrix::{Matrix, Pattern};

/// Memory of the cycle.
pub(crate) struct Cycle {
    defect: Vec<Vector>,
    coarse: Vec<Vector>,
}

/// The system and what preconditions it.
pub(crate) struct TwoLevel<'a> {
    pub(crate) pattern: &'a Pattern,
    pub(crate) matrix: &'a Matrix,
    pub(crate) coarse: &'a CoarseSystem,
    pub(crate) factors: &'a mut Factors,
    /// The coarse nodes that each fine node lies midway between.
    pub(crate) ends: &'a [[u32; 2]],
    pub(crate) cycle: &'a mut Cycle,
}

impl Cycle {
    pub(crate) fn new(pattern: &Pattern) -> Self {
        Self {
            defect: vec![Vector::ZERO; pattern.halves.free],
            coarse: vec![Vector::ZERO; pattern.n_coarse()],
        }
    }
}

impl TwoLevel<'_> {
    /// `x ← M⁻¹ f`, and `D Bᵀ x`.
    pub(crate) fn precondition(&mut self, forces: &[Vector], x: &mut [Vector], pressures: &mut [f32]) {
        let Cycle { defect, coarse } = &mut *self.cycle;
        let (matrix, pattern) = (self.matrix, self.pattern);
        matrix.sweep_forward(pattern, forces, x, pressures, defect);
        matrix.complete_defect(pattern, pressures, defect);
        coarse.fill(Vector::ZERO);
        for (defect, ends) in defect.iter().zip(self.ends) {
            for end in ends {
                let coarse = &mut coarse[*end as usize];
                *coarse = coarse.plus_scaled(*defect, 0.5);
            }
        }
        self.coarse.solve(self.factors, coarse);
        for (x, ends) in x.iter_mut().zip(self.ends) {
            for end in ends {
                *x = x.plus_scaled(coarse[*end as usize], 0.5);
            }
        }
        matrix.pressures(pattern, x, pressures);
        matrix.sweep_backward(pattern, forces, x, pressures, defect);
    }
}
