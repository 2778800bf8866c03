//! The sparse symmetric system of a Newton step: unknown displacements and pressures, four a node.
//!
//! `[A -B; -Bᵀ -S]`, `A` the second derivative of the energy at fixed pressure, `B` the slope of the nodal volume change, `S` the
//! compressibility. It is factorised as `L D Lᵀ` without pivoting, in an order chosen once. `D` has exactly one negative entry for
//! each pressure if and only if the energy is convex here (Sylvester's law of inertia).

use faer::dyn_stack::{MemBuffer, MemStack, StackReq};
use faer::linalg::cholesky::ldlt::factor::LdltRegularization;
use faer::sparse::linalg::SupernodalThreshold;
use faer::sparse::linalg::cholesky::{
    CholeskySymbolicParams, LdltRef, SymbolicCholesky, SymbolicCholeskyRaw, SymmetricOrdering,
    factorize_symbolic_cholesky,
};
use faer::sparse::{SparseColMatRef, SymbolicSparseColMat};
use faer::{Conj, MatMut, Par, Side, Spec};
use glam::{DMat3, DVec3};

use crate::SoftBodyError;
use crate::element::{Element, Tangent};

/// Numbering and sparsity of the system.
pub(crate) struct System {
    free: Vec<bool>,
    /// First unknown of each node: its displacement if it is free, then its pressure.
    first: Vec<u32>,
    /// Lower triangle by columns.
    lower: SymbolicSparseColMat<u32>,
    symbolic: SymbolicCholesky<u32>,
    /// Where the block of each pair of an element's corners (`a >= b` at `a (a + 1) / 2 + b`) starts within the columns of `b`.
    blocks: Vec<[u32; 10]>,
    /// The matrix with nothing but `-S`.
    base: Vec<f64>,
}

/// Numbers of one press: the matrix, and the factors of it or of an earlier one.
pub(crate) struct Factors {
    matrix: Vec<f64>,
    /// The matrix in single precision, in which it is factorised: twice as fast, and conjugate gradients make up for it.
    rounded: Vec<f32>,
    factors: Vec<f32>,
    unknowns: Vec<f32>,
    scratch: MemBuffer,
}

/// A matrix without factors.
#[derive(Debug)]
pub(crate) struct Singular;

impl System {
    /// Analyses the system. `elements` have their nodes in the order of elimination, `order` lists the nodes in that order, and
    /// `compressibility` gives `S` of an element for two corners that are the same, and two that are not.
    pub(crate) fn new(
        elements: &[Element],
        order: &[u32],
        neighbours: &[Vec<u32>],
        free: Vec<bool>,
        compressibility: impl Fn(&Element) -> (f64, f64),
    ) -> Result<Self, SoftBodyError> {
        let mut first = vec![0; free.len()];
        let mut rank = vec![0; free.len()];
        let mut n_unknowns = 0;
        for (position, &node) in order.iter().enumerate() {
            rank[node as usize] = position as u32;
            first[node as usize] = n_unknowns;
            n_unknowns += unknowns(&free, node);
        }

        let mut columns = vec![0];
        let mut rows = Vec::new();
        // Where the block of a node begins in the columns of another, in the order of `later`.
        let mut later: Vec<Vec<(u32, u32)>> = vec![Vec::new(); free.len()];
        for &node in order {
            let mut below: Vec<u32> = neighbours[node as usize]
                .iter()
                .copied()
                .filter(|&n| rank[n as usize] >= rank[node as usize])
                .collect();
            below.sort_unstable_by_key(|&n| rank[n as usize]);
            let mut offset = 0;
            for &n in &below {
                later[node as usize].push((n, offset));
                offset += unknowns(&free, n);
            }
            for column in 0..unknowns(&free, node) {
                let unknowns_below = below
                    .iter()
                    .flat_map(|&n| (0..unknowns(&free, n)).map(move |row| (n, row)));
                rows.extend(
                    unknowns_below
                        .skip(column as usize)
                        .map(|(n, row)| first[n as usize] + row),
                );
                columns.push(rows.len() as u32);
            }
        }
        let block = |a: u32, b: u32| {
            later[b as usize]
                .iter()
                .find(|(n, _)| *n == a)
                .map_or(0, |(_, offset)| *offset)
        };
        let blocks = elements
            .iter()
            .map(|element| {
                let mut offsets = [0; 10];
                for (a, &row) in element.nodes.iter().enumerate() {
                    for (b, &column) in element.nodes[..=a].iter().enumerate() {
                        offsets[a * (a + 1) / 2 + b] = block(row, column);
                    }
                }
                offsets
            })
            .collect();

        let size = n_unknowns as usize;
        let lower = SymbolicSparseColMat::new_checked(size, size, columns, None, rows);
        let symbolic = analyse(&lower).map_err(|error| SoftBodyError::Analysis {
            n_unknowns: size,
            reason: error.to_string(),
        })?;
        let base = vec![0.0; lower.row_idx().len()];
        let mut system = Self {
            free,
            first,
            lower,
            symbolic,
            blocks,
            base,
        };
        system.fill_base(elements, compressibility);
        Ok(system)
    }

    fn fill_base(&mut self, elements: &[Element], compressibility: impl Fn(&Element) -> (f64, f64)) {
        let mut base = std::mem::take(&mut self.base);
        for (tet, element) in elements.iter().enumerate() {
            let (same, other) = compressibility(element);
            for (a, &row) in element.nodes.iter().enumerate() {
                for (b, &column) in element.nodes[..=a].iter().enumerate() {
                    let value = if a == b { same } else { other };
                    let (row, column) = (self.n_displacements(row), self.n_displacements(column));
                    let start = self.start(element.nodes[b], column, self.blocks[tet][a * (a + 1) / 2 + b]);
                    base[start + row] -= value;
                }
            }
        }
        self.base = base;
    }

    /// Memory for the numbers.
    pub(crate) fn factors(&self) -> Factors {
        let scratch = StackReq::or(
            self.symbolic
                .factorize_numeric_ldlt_scratch::<f32>(Par::Seq, Spec::default()),
            self.symbolic.solve_in_place_scratch::<f32>(1, Par::Seq),
        );
        Factors {
            matrix: self.base.clone(),
            rounded: vec![0.0; self.base.len()],
            factors: vec![0.0; self.symbolic.len_val()],
            unknowns: vec![0.0; self.n_unknowns()],
            scratch: MemBuffer::new(scratch),
        }
    }

    pub(crate) fn n_unknowns(&self) -> usize {
        self.lower.ncols()
    }

    /// Entries of `L`, with those stored as zero.
    pub(crate) fn n_factor_entries(&self) -> usize {
        self.symbolic.len_val()
    }

    /// The unknowns of a node's displacement, if it is free.
    #[inline]
    pub(crate) fn displacement(&self, node: usize) -> Option<usize> {
        self.free[node].then_some(self.first[node] as usize)
    }

    fn n_displacements(&self, node: u32) -> usize {
        if self.free[node as usize] { 3 } else { 0 }
    }

    /// Where the block at `offset` starts in a column of a node, less its first row: add the row within the block.
    #[inline]
    fn start(&self, node: u32, column: usize, offset: u32) -> usize {
        (self.lower.col_ptr()[self.first[node as usize] as usize + column] + offset) as usize - column
    }

    /// Empties the matrix of all but `-S`.
    pub(crate) fn clear(&self, factors: &mut Factors) {
        factors.matrix.copy_from_slice(&self.base);
    }

    /// Adds an element's tangent.
    #[inline]
    pub(crate) fn add(&self, factors: &mut Factors, tet: usize, element: &Element, tangent: &Tangent) {
        let matrix = &mut factors.matrix;
        for (a, &row) in element.nodes.iter().enumerate() {
            for (b, &column) in element.nodes[..=a].iter().enumerate() {
                let pair = a * (a + 1) / 2 + b;
                let offset = self.blocks[tet][pair];
                let (n_rows, n_columns) = (self.n_displacements(row), self.n_displacements(column));
                for j in 0..n_columns {
                    let start = self.start(column, j, offset);
                    let first_row = if a == b { j } else { 0 };
                    if n_rows == 3 {
                        let stiffness = tangent.stiffness[pair].col(j);
                        for i in first_row..3 {
                            matrix[start + i] += stiffness[i];
                        }
                    }
                    matrix[start + n_rows] -= 0.25 * tangent.volume_slope[b][j];
                }
                if n_rows == 3 && a != b {
                    let start = self.start(column, n_columns, offset);
                    for i in 0..3 {
                        matrix[start + i] -= 0.25 * tangent.volume_slope[a][i];
                    }
                }
            }
        }
    }

    /// Adds stiffness to one free node.
    pub(crate) fn add_to_node(&self, factors: &mut Factors, node: usize, stiffness: &DMat3) {
        for j in 0..self.n_displacements(node as u32) {
            let start = self.start(node as u32, j, 0);
            for i in j..3 {
                factors.matrix[start + i] += stiffness.col(j)[i];
            }
        }
    }

    /// Factorises the matrix; true if the energy is convex here.
    pub(crate) fn factorise(&self, factors: &mut Factors) -> Result<bool, Singular> {
        let Factors {
            matrix,
            rounded,
            factors,
            scratch,
            ..
        } = factors;
        for (rounded, value) in rounded.iter_mut().zip(matrix.iter()) {
            *rounded = *value as f32;
        }
        self.symbolic
            .factorize_numeric_ldlt(
                factors,
                SparseColMatRef::new(self.lower.as_ref(), rounded),
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
        Ok(n_negative == self.n_nodes())
    }

    /// Solves with the factors for forces; the pressures' places of `forces` hold zero, and so do those of `solution`.
    pub(crate) fn precondition(&self, factors: &mut Factors, forces: &[f64], solution: &mut [f64]) {
        // Scaled, so that small forces do not underflow.
        let largest = forces
            .iter()
            .fold(f64::MIN_POSITIVE, |largest, force| largest.max(force.abs()));
        for (unknown, force) in factors.unknowns.iter_mut().zip(forces) {
            *unknown = (force / largest) as f32;
        }
        let n_unknowns = self.n_unknowns();
        LdltRef::new(&self.symbolic, &factors.factors).solve_in_place_with_conj(
            Conj::No,
            MatMut::from_column_major_slice_mut(&mut factors.unknowns, n_unknowns, 1),
            Par::Seq,
            MemStack::new(&mut factors.scratch),
        );
        for (solution, unknown) in solution.iter_mut().zip(&factors.unknowns) {
            *solution = f64::from(*unknown) * largest;
        }
        (0..self.n_nodes()).for_each(|node| solution[self.pressure(node)] = 0.0);
    }

    /// `y ← y + M x`, with the whole matrix.
    pub(crate) fn multiply_add(&self, factors: &Factors, x: &[f64], y: &mut [f64]) {
        let (columns, rows) = (self.lower.col_ptr(), self.lower.row_idx());
        for (column, range) in columns.windows(2).enumerate() {
            let range = range[0] as usize..range[1] as usize;
            let (entries, rows) = (&factors.matrix[range.clone()], &rows[range]);
            let (at, mut sum) = (x[column], entries[0] * x[column]);
            for (entry, &row) in entries[1..].iter().zip(&rows[1..]) {
                sum += entry * x[row as usize];
                y[row as usize] += entry * at;
            }
            y[column] += sum;
        }
    }

    /// Moves what stands in the pressures' places of a vector to a vector by nodes.
    pub(crate) fn take_pressures(&self, from: &mut [f64], to: &mut [f64]) {
        for (node, to) in to.iter_mut().enumerate() {
            *to = std::mem::take(&mut from[self.pressure(node)]);
        }
    }

    /// The pressures' places of a vector.
    pub(crate) fn put_pressures(&self, from: &[f64], to: &mut [f64]) {
        from.iter()
            .enumerate()
            .for_each(|(node, from)| to[self.pressure(node)] = *from);
    }

    /// The displacements' places of a vector for forces at nodes.
    pub(crate) fn put_forces(&self, forces_n: &[DVec3], to: &mut [f64]) {
        to.fill(0.0);
        for (node, force) in forces_n.iter().enumerate() {
            if let Some(first) = self.displacement(node) {
                to[first..first + 3].copy_from_slice(&force.to_array());
            }
        }
    }

    /// What stands in the displacements' places of a vector, zero at bonded nodes.
    pub(crate) fn take_displacements(&self, from: &[f64], to: &mut [DVec3]) {
        for (node, to) in to.iter_mut().enumerate() {
            *to = self
                .displacement(node)
                .map_or(DVec3::ZERO, |first| DVec3::from_slice(&from[first..]));
        }
    }

    pub(crate) fn n_nodes(&self) -> usize {
        self.free.len()
    }

    /// The unknown of a node's pressure.
    fn pressure(&self, node: usize) -> usize {
        self.first[node] as usize + if self.free[node] { 3 } else { 0 }
    }
}

fn unknowns(free: &[bool], node: u32) -> u32 {
    if free[node as usize] { 4 } else { 1 }
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
