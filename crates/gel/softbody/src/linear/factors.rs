//! The triangular factors of the coarse system, and solving with them, which every iteration does.
//!
//! Their entries are stored in sixteen bits, because the speed of a solve is limited by reading
//! memory. They consist of two halves that do not depend on each other, and the part between the
//! halves.

use std::ops::Range;
use std::sync::Arc;

use faer::sparse::linalg::cholesky::supernodal::SymbolicSupernodalCholesky;
use pulp::NullaryFnOnce;

use crate::parallel::{dispatch, join_halves};
use crate::wide::PlusProduct;

/// Number of entries that are processed at once. Columns are padded with zeros to a multiple of it.
const LANES: usize = 16;

/// Largest entry, in units of its column's scale.
const LARGEST: f32 = 32_767.0;

/// Where the columns of `L` have their entries.
pub(crate) struct Layout {
    supernodes: Vec<Supernode>,
    /// Rows below the supernodes, ascending.
    rows: Vec<u32>,
    /// Supernodes of the first half, of the second half, and between the halves.
    parts: [Range<usize>; 3],
    /// First column of the second half, and of the part between the halves.
    starts: [usize; 2],
    n_columns: usize,
    n_entries: usize,
    most_rows: usize,
}

/// Columns that have the same rows below them.
struct Supernode {
    columns: Range<usize>,
    rows: Range<usize>,
    /// Number of rows that are not between the halves.
    n_own_rows: usize,
    first_entry: usize,
}

/// The entries, which all solves with them share, and scratch memory.
#[derive(Clone)]
pub(crate) struct TriangularFactors {
    numbers: Arc<Numbers>,
    /// Scratch memory of each half: the rows of a supernode, and what the half adds to the part
    /// between the halves.
    local: [Vec<f32>; 2],
    between: [Vec<f32>; 2],
}

struct Numbers {
    entries: Vec<i16>,
    /// The factor of the entries of each column; `[n_columns]`.
    scales: Vec<f32>,
    /// Inverse of `D`; `[n_columns]`.
    inverse: Vec<f32>,
}

impl Supernode {
    fn n_local(&self) -> usize {
        self.columns.len() + self.rows.len()
    }

    /// Number of entries of a column with this many rows below its diagonal, including padding.
    fn padded(n_below: usize) -> usize {
        n_below.next_multiple_of(LANES)
    }
}

impl Layout {
    /// `halves` are the numbers of columns of the first and of the second half.
    pub(crate) fn new(symbolic: &SymbolicSupernodalCholesky<u32>, halves: [usize; 2]) -> Self {
        let n_supernodes = symbolic.n_supernodes();
        let mut supernodes = Vec::with_capacity(n_supernodes);
        let mut rows = Vec::new();
        let (mut n_entries, mut most_rows) = (0, 0);
        let column_end = |supernode: usize| symbolic.supernode_end()[supernode] as usize;
        let second = (0..n_supernodes)
            .find(|&supernode| column_end(supernode) > halves[0])
            .unwrap_or(n_supernodes);
        let between = (second..n_supernodes)
            .find(|&supernode| column_end(supernode) > halves[0] + halves[1])
            .unwrap_or(n_supernodes);
        let start = |supernode: usize| {
            symbolic
                .supernode_begin()
                .get(supernode)
                .map_or(symbolic.ncols(), |&column| column as usize)
        };
        let starts = [start(second), start(between)];
        for supernode in 0..n_supernodes {
            let columns = start(supernode)..column_end(supernode);
            let range = [supernode, supernode + 1].map(|at| symbolic.col_ptr_for_row_idx()[at] as usize);
            let first_row = rows.len();
            rows.extend_from_slice(&symbolic.row_idx()[range[0]..range[1]]);
            let own = &rows[first_row..];
            let n_own_rows = own.partition_point(|&row| (row as usize) < starts[1]);
            let node = Supernode {
                rows: first_row..rows.len(),
                n_own_rows,
                first_entry: n_entries,
                columns,
            };
            let n_local = node.n_local();
            n_entries += (1..=node.columns.len())
                .map(|column| Supernode::padded(n_local - column))
                .sum::<usize>();
            most_rows = most_rows.max(n_local);
            supernodes.push(node);
        }
        Self {
            supernodes,
            rows,
            parts: [0..second, second..between, between..n_supernodes],
            starts,
            n_columns: symbolic.ncols(),
            n_entries,
            most_rows,
        }
    }

    /// From factors that contain, for each supernode, a matrix by columns with `D` on its diagonal.
    pub(crate) fn factors(&self, factors: &[f32]) -> TriangularFactors {
        let local = || vec![0.0; self.most_rows + 2 * LANES];
        let between = || vec![0.0; self.n_columns - self.starts[1]];
        TriangularFactors {
            numbers: Arc::new(self.numbers(factors)),
            local: [local(), local()],
            between: [between(), between()],
        }
    }

    fn numbers(&self, factors: &[f32]) -> Numbers {
        let mut numbers = Numbers {
            entries: vec![0; self.n_entries],
            scales: vec![0.0; self.n_columns],
            inverse: vec![0.0; self.n_columns],
        };
        let mut from = factors;
        for node in &self.supernodes {
            let n_local = node.n_local();
            let (own, rest) = from.split_at(node.columns.len() * n_local);
            from = rest;
            let mut to = &mut numbers.entries[node.first_entry..];
            for (index, column) in node.columns.clone().enumerate() {
                let values = &own[index * n_local + index..(index + 1) * n_local];
                let below = &values[1..];
                let largest = below
                    .iter()
                    .fold(f32::MIN_POSITIVE, |most, value| most.max(value.abs()));
                numbers.inverse[column] = 1.0 / values[0];
                numbers.scales[column] = largest / LARGEST;
                let (entries, rest) = to.split_at_mut(Supernode::padded(below.len()));
                for (entry, value) in entries.iter_mut().zip(below) {
                    *entry = (value / largest * LARGEST).round() as i16;
                }
                to = rest;
            }
        }
        numbers
    }
}

impl TriangularFactors {
    /// `x ← (L D Lᵀ)⁻¹ x`
    pub(crate) fn solve(&mut self, layout: &Layout, x: &mut [f32]) {
        let Self {
            numbers,
            local: [first_local, second_local],
            between: [first_between, second_between],
        } = self;
        let numbers = &**numbers;
        let [second_start, between_start] = layout.starts;
        let (halves, middle) = x.split_at_mut(between_start);
        let (first, second) = halves.split_at_mut(second_start);
        let [first_nodes, second_nodes, middle_nodes] = &layout.parts;
        let run =
            |down, nodes: &Range<usize>, start, x: &mut [f32], between: &mut [f32], local: &mut [f32]| {
                dispatch(Solve {
                    layout,
                    numbers,
                    down,
                    nodes: nodes.clone(),
                    start,
                    x,
                    between,
                    local,
                });
            };
        first_between.fill(0.0);
        second_between.fill(0.0);
        join_halves(
            || run(true, first_nodes, 0, first, first_between, first_local),
            || {
                run(
                    true,
                    second_nodes,
                    second_start,
                    second,
                    second_between,
                    second_local,
                )
            },
        );
        for ((x, first), second) in middle.iter_mut().zip(&*first_between).zip(&*second_between) {
            *x += first + second;
        }
        run(true, middle_nodes, between_start, middle, &mut [], first_local);
        run(false, middle_nodes, between_start, middle, &mut [], first_local);
        first_between.copy_from_slice(middle);
        second_between.copy_from_slice(middle);
        join_halves(
            || run(false, first_nodes, 0, first, first_between, first_local),
            || {
                run(
                    false,
                    second_nodes,
                    second_start,
                    second,
                    second_between,
                    second_local,
                )
            },
        );
    }
}

/// A solve with the supernodes of one part, whose columns begin at `start`: with `L`, or with
/// `D Lᵀ`.
struct Solve<'a> {
    layout: &'a Layout,
    numbers: &'a Numbers,
    down: bool,
    nodes: Range<usize>,
    start: usize,
    x: &'a mut [f32],
    between: &'a mut [f32],
    local: &'a mut [f32],
}

impl NullaryFnOnce for Solve<'_> {
    type Output = ();

    #[inline(always)]
    fn call(mut self) {
        let layout = self.layout;
        if self.down {
            for node in &layout.supernodes[self.nodes.clone()] {
                self.down(node);
            }
        } else {
            for node in layout.supernodes[self.nodes.clone()].iter().rev() {
                self.up(node);
            }
        }
    }
}

impl Solve<'_> {
    #[inline(always)]
    fn down(&mut self, node: &Supernode) {
        let layout = self.layout;
        let Numbers { entries, scales, .. } = self.numbers;
        let (n_columns, n_local) = (node.columns.len(), node.n_local());
        let own = &mut self.x[node.columns.start - self.start..][..n_columns];
        let local = &mut *self.local;
        local[..n_columns].copy_from_slice(own);
        local[n_columns..n_local].fill(0.0);
        let mut entries = &entries[node.first_entry..];
        for (index, column) in node.columns.clone().enumerate() {
            let (here, rest) = entries.split_at(Supernode::padded(n_local - 1 - index));
            entries = rest;
            let x = -local[index] * scales[column];
            let below = &mut local[index + 1..][..here.len()];
            let (below, _) = below.as_chunks_mut::<LANES>();
            let (here, _) = here.as_chunks::<LANES>();
            for (below, here) in below.iter_mut().zip(here) {
                *below = std::array::from_fn(|lane| below[lane].plus_product(f32::from(here[lane]), x));
            }
        }
        own.copy_from_slice(&local[..n_columns]);
        let rows = &layout.rows[node.rows.clone()];
        let (rows, between) = rows.split_at(node.n_own_rows.min(rows.len()));
        let (own, added) = local[n_columns..n_local].split_at(rows.len());
        if self.between.is_empty() {
            for (row, added) in between.iter().zip(added) {
                self.x[*row as usize - self.start] += added;
            }
        } else {
            for (row, added) in between.iter().zip(added) {
                self.between[*row as usize - layout.starts[1]] += added;
            }
        }
        for (row, added) in rows.iter().zip(own) {
            self.x[*row as usize - self.start] += added;
        }
    }

    #[inline(always)]
    fn up(&mut self, node: &Supernode) {
        let layout = self.layout;
        let Numbers {
            entries,
            scales,
            inverse,
        } = self.numbers;
        let (n_columns, n_local) = (node.columns.len(), node.n_local());
        let rows = &layout.rows[node.rows.clone()];
        let (rows, between) = rows.split_at(node.n_own_rows.min(rows.len()));
        let local = &mut *self.local;
        let (below, from_between) = local[n_columns..n_local].split_at_mut(rows.len());
        for (below, row) in below.iter_mut().zip(rows) {
            *below = self.x[*row as usize - self.start];
        }
        let (source, start) = if self.between.is_empty() {
            (&*self.x, self.start)
        } else {
            (&*self.between, layout.starts[1])
        };
        for (below, row) in from_between.iter_mut().zip(between) {
            *below = source[*row as usize - start];
        }
        local[n_local..n_local + LANES].fill(0.0);
        let mut end = node.first_entry
            + (1..=n_columns)
                .map(|column| Supernode::padded(n_local - column))
                .sum::<usize>();
        let own = &mut self.x[node.columns.start - self.start..][..n_columns];
        for (index, column) in node.columns.clone().enumerate().rev() {
            let n_here = Supernode::padded(n_local - 1 - index);
            let here = &entries[end - n_here..end];
            end -= n_here;
            let mut sums = [0.0_f32; LANES];
            let below = &local[index + 1..][..n_here];
            let (below, _) = below.as_chunks::<LANES>();
            let (here, _) = here.as_chunks::<LANES>();
            for (below, here) in below.iter().zip(here) {
                sums =
                    std::array::from_fn(|lane| sums[lane].plus_product(f32::from(here[lane]), below[lane]));
            }
            let x = own[index] * inverse[column] - scales[column] * total(&sums);
            own[index] = x;
            local[index] = x;
        }
    }
}

/// The sum of all lanes. It is not inlined, because the compiler would otherwise add pairs of lanes
/// inside of the loop, which is slower.
#[inline(never)]
fn total(lanes: &[f32; LANES]) -> f32 {
    let [first, second] = [0, LANES / 2].map(|start| &lanes[start..][..LANES / 2]);
    first.iter().zip(second).map(|(a, b)| a + b).sum()
}
