//! Factors of the whole system in double precision, computed again for every direction: the usual
//! method, for comparison.
//!
//! `[A B√D; √D Bᵀ -1]`, for displacements and scaled pressures, as `L D Lᵀ` in a minimum-degree
//! order.

use faer::dyn_stack::{MemBuffer, MemStack};
use faer::linalg::cholesky::ldlt::factor::LdltRegularization;
use faer::sparse::linalg::cholesky::{
    CholeskySymbolicParams, LdltRef, SymbolicCholesky, SymmetricOrdering, factorize_symbolic_cholesky,
};
use faer::sparse::{SparseColMatRef, SymbolicSparseColMat};
use faer::{Conj, MatMut, Par, Side, Spec};

use super::block::Vector;
use super::matrix::{Matrix, Pattern};
use crate::SoftBodyError;

/// Numbering and sparsity of the whole system.
pub(crate) struct DirectSystem {
    lower: SymbolicSparseColMat<u32>,
    symbolic: SymbolicCholesky<u32>,
    /// Where each entry of the lower triangle comes from.
    sources: Vec<Source>,
}

/// Where an entry comes from: index of a block or derivative, and the column and row in it.
#[derive(Clone, Copy)]
enum Source {
    Own { node: u32, entry: [u8; 2] },
    Block { index: u32, entry: [u8; 2] },
    Slope { index: u32, row: u8 },
    Pressure,
}

impl DirectSystem {
    pub(crate) fn new(pattern: &Pattern) -> Result<Self, SoftBodyError> {
        let n_free = pattern.halves.free;
        let mut blocks_below = vec![Vec::new(); n_free];
        let mut slopes_below = vec![Vec::new(); n_free];
        for row in 0..n_free {
            for index in pattern.blocks_of(row) {
                blocks_below[pattern.columns[index] as usize].push((row, index));
            }
            for index in pattern.slopes_of(row) {
                slopes_below[row].push((pattern.slope_columns[index] as usize, index));
            }
        }
        let n_unknowns = 3 * n_free + pattern.n_coarse();
        let (mut columns, mut rows, mut sources) = (vec![0], Vec::new(), Vec::new());
        for node in 0..n_free {
            for column in 0..3_u8 {
                let mut push = |row: usize, source: Source| {
                    rows.push(row as u32);
                    sources.push(source);
                };
                for row in column..3 {
                    let (node, entry) = (node as u32, [column, row]);
                    push(3 * node as usize + usize::from(row), Source::Own { node, entry });
                }
                for &(below, index) in &blocks_below[node] {
                    for row in 0..3_u8 {
                        let (index, entry) = (index as u32, [column, row]);
                        push(3 * below + usize::from(row), Source::Block { index, entry });
                    }
                }
                for &(coarse, index) in &slopes_below[node] {
                    let (index, row) = (index as u32, column);
                    push(3 * n_free + coarse, Source::Slope { index, row });
                }
                columns.push(rows.len() as u32);
            }
        }
        for pressure in 3 * n_free..n_unknowns {
            rows.push(pressure as u32);
            sources.push(Source::Pressure);
            columns.push(rows.len() as u32);
        }
        let lower = SymbolicSparseColMat::new_checked(n_unknowns, n_unknowns, columns, None, rows);
        let symbolic = factorize_symbolic_cholesky(
            lower.as_ref(),
            Side::Lower,
            SymmetricOrdering::Amd,
            CholeskySymbolicParams::default(),
        )
        .map_err(|error| SoftBodyError::Analysis {
            n_unknowns,
            reason: error.to_string(),
        })?;
        Ok(Self {
            lower,
            symbolic,
            sources,
        })
    }

    /// Solves for displacements, and `√D Bᵀ` times them; returns false if the factors do not exist.
    pub(crate) fn solve(
        &self,
        matrix: &Matrix,
        forces: &[Vector],
        displacements: &mut [Vector],
        volumes: &mut [f32],
    ) -> bool {
        let values: Vec<f64> = self.sources.iter().map(|source| source.value(matrix)).collect();
        let (symbolic, par) = (&self.symbolic, Par::Seq);
        let mut factors = vec![0.0; symbolic.len_val()];
        let scratch = symbolic.factorize_numeric_ldlt_scratch::<f64>(par, Spec::default());
        let scratch = scratch.or(symbolic.solve_in_place_scratch::<f64>(1, par));
        let mut memory = MemBuffer::new(scratch);
        let factorised = symbolic.factorize_numeric_ldlt(
            &mut factors,
            SparseColMatRef::new(self.lower.as_ref(), &values),
            Side::Lower,
            LdltRegularization::default(),
            par,
            MemStack::new(&mut memory),
            Spec::default(),
        );
        if factorised.is_err() {
            return false;
        }
        let mut unknowns = vec![0.0; self.lower.ncols()];
        for (unknowns, force) in unknowns.chunks_exact_mut(3).zip(forces) {
            for (unknown, force) in unknowns.iter_mut().zip(force.0) {
                *unknown = f64::from(force);
            }
        }
        LdltRef::new(symbolic, &factors).solve_in_place_with_conj(
            Conj::No,
            MatMut::from_column_major_slice_mut(&mut unknowns, self.lower.ncols(), 1),
            par,
            MemStack::new(&mut memory),
        );
        let (of_nodes, of_volumes) = unknowns.split_at(3 * forces.len());
        for (displacement, unknowns) in displacements.iter_mut().zip(of_nodes.chunks_exact(3)) {
            for (value, unknown) in displacement.0.iter_mut().zip(unknowns) {
                *value = *unknown as f32;
            }
        }
        for (volume, unknown) in volumes.iter_mut().zip(of_volumes) {
            *volume = *unknown as f32;
        }
        unknowns.iter().all(|unknown| unknown.is_finite())
    }
}

impl Source {
    fn value(self, matrix: &Matrix) -> f64 {
        let of = |values: &[[f32; 4]; 3], [column, row]: [u8; 2]| values[column as usize][row as usize];
        f64::from(match self {
            Self::Own { node, entry } => of(&matrix.own[node as usize].0, entry),
            Self::Block { index, entry } => of(&matrix.blocks[index as usize].0, entry),
            Self::Slope { index, row } => matrix.slopes[index as usize].0[row as usize],
            Self::Pressure => -1.0,
        })
    }
}
