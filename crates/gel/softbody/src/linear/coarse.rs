//! The system on the coarse mesh: unknown displacements and pressures, four for each node.
//!
//! `[A -B; -Bᵀ -1/D]` is factorized as `L D Lᵀ` without pivoting, in an order that is chosen once.
//! The diagonal factor has exactly one negative entry for each pressure if and only if the energy
//! is convex at this state (Sylvester's law of inertia).

use faer::dyn_stack::{MemBuffer, MemStack};
use faer::linalg::cholesky::ldlt::factor::LdltRegularization;
use faer::sparse::linalg::SupernodalThreshold;
use faer::sparse::linalg::cholesky::{
    CholeskySymbolicParams, SymbolicCholesky, SymbolicCholeskyRaw, SymmetricOrdering,
    factorize_symbolic_cholesky,
};
use faer::sparse::{SparseColMatRef, SymbolicSparseColMat};
use faer::{Par, Side, Spec};
use glam::{DVec3, Mat3};

use super::block::Vector;
use super::elimination_order::elimination_order;
use super::factors::{Layout, TriangularFactors};
use super::sparsity::{Numbering, Sparsity, TetBlocks, neighbours, tet_blocks, unknowns};
use crate::SoftBodyError;
use crate::element::CoarseTangent;

/// Numbering and sparsity of the system.
pub(crate) struct CoarseSystem {
    free: Vec<bool>,
    /// Index of the first unknown of each node: its displacement if the node is free, followed by
    /// its pressure.
    first: Vec<u32>,
    /// The lower triangle, column by column.
    lower: SymbolicSparseColMat<u32>,
    symbolic: SymbolicCholesky<u32>,
    layout: Layout,
    /// Where each entry of each tetrahedron's tangent is added.
    blocks: Vec<TetBlocks>,
    /// Indices of the diagonal entries of each node; `[n_nodes]`.
    diagonals: Vec<[u32; 3]>,
    /// The matrix with `-1/D` alone.
    base: Vec<f32>,
    corners: Vec<[u32; 4]>,
    /// For each node, its later neighbours, and where their rows begin below its own.
    later: Vec<Vec<(u32, u32)>>,
}

/// Factors of the matrix. Clones share the numbers.
#[derive(Clone)]
pub(crate) struct Factors {
    triangular: TriangularFactors,
    unknowns: Vec<f32>,
}

/// A matrix to be factorized, and scratch memory.
pub(crate) struct Tangent {
    matrix: Vec<f32>,
    factors: Vec<f32>,
    scratch: MemBuffer,
}

/// The factors of the matrix do not exist.
#[derive(Debug)]
pub(crate) struct Singular;

impl CoarseSystem {
    /// Analyses the system of a mesh. `volume_stiffness` is `D`.
    pub(crate) fn new(
        nodes_mm: &[DVec3],
        corners: &[[u32; 4]],
        bonded: &[bool],
        volume_stiffness: &[f64],
    ) -> Result<Self, SoftBodyError> {
        let n_nodes = nodes_mm.len();
        let free: Vec<bool> = bonded.iter().map(|bonded| !bonded).collect();
        let neighbours = neighbours(n_nodes, corners);
        let (order, halves) = elimination_order(nodes_mm, &neighbours);
        let Numbering {
            rank,
            first,
            n_unknowns,
        } = Numbering::new(&order, &free);
        let Sparsity { columns, rows, later } = Sparsity::new(&order, &neighbours, &free, &rank, &first);
        let size = n_unknowns as usize;
        let lower = SymbolicSparseColMat::new_checked(size, size, columns, None, rows);
        let symbolic = analyse(&lower).map_err(|error| SoftBodyError::Analysis {
            n_unknowns: size,
            reason: error.to_string(),
        })?;
        let SymbolicCholeskyRaw::Supernodal(supernodes) = symbolic.raw() else {
            return Err(SoftBodyError::Analysis {
                n_unknowns: size,
                reason: "the factors have no supernodes".into(),
            });
        };
        let (low, others) = order.split_at(halves[0]);
        let n_columns = [low, &others[..halves[1]]].map(|half| {
            let columns = half.iter().map(|&node| unknowns(&free, node) as usize);
            columns.sum()
        });
        let layout = Layout::new(supernodes, n_columns);
        let blocks = corners
            .iter()
            .map(|corners| tet_blocks(corners, &rank, &later))
            .collect();
        let mut system = Self {
            base: vec![0.0; lower.row_idx().len()],
            free,
            first,
            lower,
            symbolic,
            layout,
            blocks,
            diagonals: Vec::new(),
            corners: corners.to_vec(),
            later,
        };
        for (node, stiffness) in volume_stiffness.iter().enumerate() {
            let column = system.n_displacements(node as u32);
            let start = system.start(node as u32, column, 0);
            system.base[start + column] = -(1.0 / stiffness) as f32;
        }
        system.diagonals = (0..n_nodes as u32)
            .map(|node| {
                let n = system.n_displacements(node);
                std::array::from_fn(|j| if j < n { system.start(node, j, 0) as u32 } else { 0 })
            })
            .collect();
        Ok(system)
    }

    /// An empty matrix with its scratch memory.
    pub(crate) fn tangent(&self) -> Tangent {
        let scratch = self
            .symbolic
            .factorize_numeric_ldlt_scratch::<f32>(Par::Seq, Spec::default());
        Tangent {
            matrix: self.base.clone(),
            factors: vec![0.0; self.symbolic.len_val()],
            scratch: MemBuffer::new(scratch),
        }
    }

    fn n_displacements(&self, node: u32) -> usize {
        if self.free[node as usize] { 3 } else { 0 }
    }

    /// Index at which the block at `offset` starts in a column of a node, minus its first row: add
    /// the row within the block.
    #[inline]
    fn start(&self, node: u32, column: usize, offset: u32) -> usize {
        (self.lower.col_ptr()[self.first[node as usize] as usize + column] + offset) as usize - column
    }

    /// Fills the matrix with the tangents of the tetrahedra, in their order.
    pub(crate) fn fill<'a>(&self, tangent: &mut Tangent, tangents: impl Iterator<Item = &'a CoarseTangent>) {
        tangent.matrix.copy_from_slice(&self.base);
        let matrix = &mut tangent.matrix;
        for ((corners, blocks), tangent) in self.corners.iter().zip(&self.blocks).zip(tangents) {
            for a in 0..4 {
                for b in 0..=a {
                    let pair = a * (a + 1) / 2 + b;
                    let (a_is_later, offset) = blocks[pair];
                    let stiffness = tangent.stiffness[pair];
                    let (row, column, block) = if a_is_later {
                        (a, b, stiffness)
                    } else {
                        (b, a, stiffness.transpose())
                    };
                    self.add_block(
                        matrix,
                        [corners[row], corners[column]],
                        offset,
                        &block,
                        [tangent.slopes[row][column], tangent.slopes[column][row]].map(|slope| -slope),
                    );
                }
            }
        }
    }

    /// Adds the block of two nodes' displacements, and the derivatives: of the column's volume by
    /// the row's displacement, and of the row's volume by the column's displacement.
    #[inline]
    fn add_block(
        &self,
        matrix: &mut [f32],
        [row, column]: [u32; 2],
        offset: u32,
        block: &Mat3,
        [down, across]: [glam::Vec3; 2],
    ) {
        let (n_rows, n_columns) = (self.n_displacements(row), self.n_displacements(column));
        let is_diagonal = row == column;
        for j in 0..n_columns {
            let start = self.start(column, j, offset);
            let first = if is_diagonal { j } else { 0 };
            for i in first..n_rows {
                matrix[start + i] += block.col(j)[i];
            }
            matrix[start + n_rows] += across[j];
        }
        if !is_diagonal {
            let start = self.start(column, n_columns, offset);
            for i in 0..n_rows {
                matrix[start + i] += down[i];
            }
        }
    }

    /// Adds the stiffness of a point that depends on neighbouring nodes with these weights. A node
    /// may occur more than once.
    pub(crate) fn add_at(
        &self,
        tangent: &mut Tangent,
        parts: impl Iterator<Item = (u32, f32)> + Clone,
        stiffness: &Mat3,
    ) {
        for (a, part) in parts.clone() {
            for (b, other_part) in parts.clone() {
                let stiffness = *stiffness * (part * other_part);
                if a == b {
                    self.add_to_node(tangent, a, &stiffness);
                } else if let Some((_, offset)) = self.later[b as usize].iter().find(|(node, _)| *node == a) {
                    // Of both orders, only the one in the lower triangle.
                    for j in 0..self.n_displacements(b) {
                        let start = self.start(b, j, *offset);
                        for i in 0..self.n_displacements(a) {
                            tangent.matrix[start + i] += stiffness.col(j)[i];
                        }
                    }
                }
            }
        }
    }

    /// Adds stiffness to one node.
    pub(crate) fn add_to_node(&self, tangent: &mut Tangent, node: u32, stiffness: &Mat3) {
        for j in 0..self.n_displacements(node) {
            let start = self.diagonals[node as usize][j] as usize;
            for i in j..3 {
                tangent.matrix[start + i] += stiffness.col(j)[i];
            }
        }
    }

    /// Factorizes the matrix; `None` if the energy is not convex at this state.
    pub(crate) fn factorise(&self, tangent: &mut Tangent) -> Result<Option<Factors>, Singular> {
        let Tangent {
            matrix,
            factors,
            scratch,
        } = tangent;
        self.symbolic
            .factorize_numeric_ldlt(
                factors,
                SparseColMatRef::new(self.lower.as_ref(), matrix),
                Side::Lower,
                LdltRegularization::default(),
                Par::Seq,
                MemStack::new(scratch),
                Spec::default(),
            )
            .map_err(|_| Singular)?;
        let SymbolicCholeskyRaw::Supernodal(symbolic) = self.symbolic.raw() else {
            return Err(Singular);
        };
        let mut n_negative = 0;
        for supernode in 0..symbolic.n_supernodes() {
            let width =
                (symbolic.supernode_end()[supernode] - symbolic.supernode_begin()[supernode]) as usize;
            let start = symbolic.col_ptr_for_val()[supernode] as usize;
            let height = (symbolic.col_ptr_for_val()[supernode + 1] as usize - start) / width;
            for column in 0..width {
                let pivot = factors[start + column * (height + 1)];
                if !pivot.is_finite() {
                    return Err(Singular);
                }
                n_negative += usize::from(pivot < 0.0);
            }
        }
        let is_convex = n_negative == self.free.len();
        Ok(is_convex.then(|| Factors {
            triangular: self.layout.factors(factors),
            unknowns: vec![0.0; self.lower.ncols()],
        }))
    }

    /// Replaces forces on the nodes by the displacements that the factors give; these are zero at
    /// bonded nodes.
    pub(crate) fn solve(&self, factors: &mut Factors, forces: &mut [Vector]) {
        // Scaled, so that small forces do not underflow.
        let largest = forces
            .iter()
            .flat_map(|force| force.0)
            .fold(f32::MIN_POSITIVE, |largest, force| largest.max(force.abs()));
        factors.unknowns.fill(0.0);
        for (node, force) in forces.iter().enumerate() {
            if self.free[node] {
                let first = self.first[node] as usize;
                for (unknown, force) in factors.unknowns[first..first + 3].iter_mut().zip(force.0) {
                    *unknown = force / largest;
                }
            }
        }
        factors.triangular.solve(&self.layout, &mut factors.unknowns);
        for (node, force) in forces.iter_mut().enumerate() {
            let first = self.first[node] as usize;
            *force = Vector::ZERO;
            if self.free[node] {
                for (force, unknown) in force.0.iter_mut().zip(&factors.unknowns[first..first + 3]) {
                    *force = unknown * largest;
                }
            }
        }
    }
}

fn analyse(lower: &SymbolicSparseColMat<u32>) -> Result<SymbolicCholesky<u32>, faer::sparse::FaerError> {
    let upper = lower.to_row_major()?;
    factorize_symbolic_cholesky(
        upper.transpose(),
        Side::Upper,
        SymmetricOrdering::Identity,
        CholeskySymbolicParams {
            supernodal_flop_ratio_threshold: SupernodalThreshold::FORCE_SUPERNODAL,
            ..CholeskySymbolicParams::default()
        },
    )
}
