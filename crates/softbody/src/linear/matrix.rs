//! The system on the fine mesh: of `A` the diagonal and what stands below it, and `B`, by rows.

use std::ops::Range;

use pulp::NullaryFnOnce;

use super::block::{Block, Sum, Vector};
use super::numbering::Halves;
use crate::element::{Elements, NODES, NodeBlock, NodeSlopes, Sink, Table};
use crate::parallel::join_halves;
use crate::wide::LANES;

/// A pair of nodes of which one is bonded.
const NOWHERE: u32 = u32::MAX;

/// Who neighbours whom among the free nodes.
pub(crate) struct Pattern {
    pub(crate) halves: Halves,
    /// Blocks of each row below the diagonal, ascending. `[n_free + 1]`
    rows: Vec<u32>,
    columns: Vec<u32>,
    /// Coarse nodes whose volume each row's node changes. `[n_free + 1]`
    slope_rows: Vec<u32>,
    slope_columns: Vec<u32>,
    /// Bulk modulus over volume of each coarse node, MPa/mm³.
    volume_stiffness: Vec<f32>,
    /// Where the blocks of each slot's pairs go: a row for a node with itself, else twice a block, plus one for its transpose.
    /// `[n_slots][most_pairs]`, flat.
    block_places: Vec<u32>,
    most_pairs: usize,
    /// Where the slopes of each slot's nodes and corners go.
    slope_places: Vec<[[u32; 4]; NODES]>,
}

/// The numbers of the system.
pub(crate) struct Matrix {
    diagonal: Vec<Block>,
    blocks: Vec<Block>,
    slopes: Vec<Vector>,
    /// Stiffness that is added to the diagonal: of contact, of damping. `[n_free]`
    pub(crate) extra: Vec<Block>,
    /// The whole diagonal of `A`. `[n_free]`
    own: Vec<Block>,
    /// Inverse of the diagonal of `H`. `[n_free]`
    inverse: Vec<Block>,
}

/// Adds the tangents of one half, or of what lies between.
struct FineSink<'a> {
    pattern: &'a Pattern,
    first_row: usize,
    diagonal: &'a mut [Block],
    first_block: usize,
    blocks: &'a mut [Block],
    first_slope: usize,
    slopes: &'a mut [Vector],
}

/// Rows of sorted columns, each once.
fn csr(rows: Vec<Vec<u32>>) -> (Vec<u32>, Vec<u32>) {
    let (mut starts, mut columns) = (vec![0], Vec::new());
    for mut row in rows {
        row.sort_unstable();
        row.dedup();
        columns.extend(row);
        starts.push(columns.len() as u32);
    }
    (starts, columns)
}

fn find(rows: &[u32], columns: &[u32], row: u32, column: u32) -> u32 {
    let start = rows[row as usize];
    let range = start as usize..rows[row as usize + 1] as usize;
    start + columns[range].partition_point(|&c| c < column) as u32
}

impl Pattern {
    /// `parents` are the ten nodes of each coarse tetrahedron, corners first, `corners` its coarse nodes.
    pub(crate) fn new(
        elements: &Elements,
        parents: &[[u32; NODES]],
        corners: &[[u32; 4]],
        halves: Halves,
        volume_stiffness: &[f64],
    ) -> Self {
        let is_free = |node: u32| (node as usize) < halves.free;
        // Free pairs, the later node first.
        let pair_of = |nodes: &[u32; NODES], [a, b]: [u8; 2]| {
            let (a, b) = (nodes[a as usize], nodes[b as usize]);
            (is_free(a) && is_free(b)).then_some((a.max(b), a.min(b), a < b))
        };
        let mut blocks = vec![Vec::new(); halves.free];
        let mut slopes = vec![Vec::new(); halves.free];
        for ((nodes, corners), &slot) in parents.iter().zip(corners).zip(&elements.slots) {
            for &pair in &elements.table_of(slot).pairs {
                if let Some((row, column, _)) = pair_of(nodes, pair)
                    && row != column
                {
                    blocks[row as usize].push(column);
                }
            }
            for &node in nodes.iter().filter(|&&node| is_free(node)) {
                slopes[node as usize].extend(corners);
            }
        }
        let (rows, columns) = csr(blocks);
        let (slope_rows, slope_columns) = csr(slopes);
        let most_pairs = elements.most_pairs();
        let mut block_places = vec![NOWHERE; elements.n_slots() * most_pairs];
        let mut slope_places = vec![[[NOWHERE; 4]; NODES]; elements.n_slots()];
        for ((nodes, corners), &slot) in parents.iter().zip(corners).zip(&elements.slots) {
            let slot_places = &mut block_places[slot as usize * most_pairs..];
            for (place, &pair) in slot_places.iter_mut().zip(&elements.table_of(slot).pairs) {
                if let Some((row, column, is_turned)) = pair_of(nodes, pair) {
                    *place = if row == column {
                        row
                    } else {
                        2 * find(&rows, &columns, row, column) + u32::from(is_turned)
                    };
                }
            }
            for (places, &node) in slope_places[slot as usize].iter_mut().zip(nodes) {
                if is_free(node) {
                    *places = corners.map(|corner| find(&slope_rows, &slope_columns, node, corner));
                }
            }
        }
        Self {
            halves,
            rows,
            columns,
            slope_rows,
            slope_columns,
            volume_stiffness: volume_stiffness
                .iter()
                .map(|&stiffness| stiffness as f32)
                .collect(),
            block_places,
            most_pairs,
            slope_places,
        }
    }

    pub(crate) fn matrix(&self) -> Matrix {
        let blocks = || vec![Block::default(); self.halves.free];
        Matrix {
            diagonal: blocks(),
            blocks: vec![Block::default(); self.columns.len()],
            slopes: vec![Vector::ZERO; self.slope_columns.len()],
            extra: blocks(),
            own: blocks(),
            inverse: blocks(),
        }
    }

    pub(crate) fn n_coarse(&self) -> usize {
        self.volume_stiffness.len()
    }

    #[inline(always)]
    fn blocks_of(&self, row: usize) -> Range<usize> {
        self.rows[row] as usize..self.rows[row + 1] as usize
    }

    #[inline(always)]
    fn slopes_of(&self, row: usize) -> Range<usize> {
        self.slope_rows[row] as usize..self.slope_rows[row + 1] as usize
    }
}

impl Matrix {
    /// Empties the matrix, and returns what the two halves add to.
    pub(crate) fn halves<'a>(&'a mut self, pattern: &'a Pattern) -> [impl Sink + use<'a>; 2] {
        self.diagonal.fill(Block::default());
        self.blocks.fill(Block::default());
        self.slopes.fill(Vector::ZERO);
        let first_row = pattern.halves.first;
        let first_block = pattern.rows[first_row] as usize;
        let first_slope = pattern.slope_rows[first_row] as usize;
        let diagonal = self.diagonal.split_at_mut(first_row);
        let blocks = self.blocks.split_at_mut(first_block);
        let slopes = self.slopes.split_at_mut(first_slope);
        [
            FineSink {
                pattern,
                first_row: 0,
                diagonal: diagonal.0,
                first_block: 0,
                blocks: blocks.0,
                first_slope: 0,
                slopes: slopes.0,
            },
            FineSink {
                pattern,
                first_row,
                diagonal: diagonal.1,
                first_block,
                blocks: blocks.1,
                first_slope,
                slopes: slopes.1,
            },
        ]
    }

    /// What lies between the halves adds to this.
    pub(crate) fn between<'a>(&'a mut self, pattern: &'a Pattern) -> impl Sink + use<'a> {
        FineSink {
            pattern,
            first_row: 0,
            diagonal: &mut self.diagonal,
            first_block: 0,
            blocks: &mut self.blocks,
            first_slope: 0,
            slopes: &mut self.slopes,
        }
    }

    /// Completes the diagonal with the extra stiffness as it is now.
    pub(crate) fn complete(&mut self, pattern: &Pattern) {
        let half = pattern.halves.free / 2;
        let (diagonal, slopes, extra) = (&self.diagonal, &self.slopes, &self.extra);
        let complete = |first: usize, own: &mut [Block], inverse: &mut [Block]| {
            for (row, (own, inverse)) in (first..).zip(own.iter_mut().zip(inverse)) {
                *own = diagonal[row];
                own.add(&extra[row]);
                let mut whole = *own;
                for at in pattern.slopes_of(row) {
                    let stiffness = pattern.volume_stiffness[pattern.slope_columns[at] as usize];
                    whole.add_square(&slopes[at], stiffness);
                }
                *inverse = whole.inverse();
            }
        };
        let own = self.own.split_at_mut(half);
        let inverse = self.inverse.split_at_mut(half);
        join_halves(
            || complete(0, own.0, inverse.0),
            || complete(half, own.1, inverse.1),
        );
    }

    /// `D Bᵀ x`, MPa.
    pub(crate) fn pressures(&self, pattern: &Pattern, x: &[Vector], pressures: &mut [f32]) {
        let halves = pattern.halves;
        pressures.fill(0.0);
        let (low, high) = pressures.split_at_mut(halves.coarse);
        let add = |rows, first, pressures: &mut [f32]| {
            pulp::Arch::new().dispatch(Pressures {
                pattern,
                matrix: self,
                rows,
                x,
                first,
                pressures,
            });
        };
        join_halves(
            || add(0..halves.first, 0, low),
            || add(halves.first..halves.both, halves.coarse, high),
        );
        add(halves.both..halves.free, 0, pressures);
        for (pressure, stiffness) in pressures.iter_mut().zip(&pattern.volume_stiffness) {
            *pressure *= stiffness;
        }
    }

    /// `y ← H x` for given `D Bᵀ x`.
    pub(crate) fn multiply(&self, pattern: &Pattern, x: &[Vector], pressures: &[f32], y: &mut [Vector]) {
        let halves = pattern.halves;
        let (low, high) = y.split_at_mut(halves.first);
        join_halves(
            || self.multiply_rows(pattern, 0..halves.first, x, pressures, 0, low),
            || {
                self.multiply_rows(
                    pattern,
                    halves.first..halves.both,
                    x,
                    pressures,
                    halves.first,
                    high,
                )
            },
        );
        self.multiply_rows(pattern, halves.both..halves.free, x, pressures, 0, y);
    }

    /// `y` begins at row `first`.
    fn multiply_rows(
        &self,
        pattern: &Pattern,
        rows: Range<usize>,
        x: &[Vector],
        pressures: &[f32],
        first: usize,
        y: &mut [Vector],
    ) {
        pulp::Arch::new().dispatch(Product {
            pattern,
            matrix: self,
            rows,
            x,
            pressures,
            first,
            y,
        });
    }

    /// One sweep of block Gauss–Seidel from zero. Leaves `x`, `D Bᵀ x`, and of `f - A x` what stands above the diagonal: the rows are
    /// solved for what was known when their turn came.
    pub(crate) fn sweep_forward(
        &self,
        pattern: &Pattern,
        forces: &[Vector],
        x: &mut [Vector],
        pressures: &mut [f32],
        defect: &mut [Vector],
    ) {
        pressures.fill(0.0);
        let halves = pattern.halves;
        let (low, high) = x.split_at_mut(halves.first);
        let (low_pressures, high_pressures) = pressures.split_at_mut(halves.coarse);
        let (low_defect, high_defect) = defect.split_at_mut(halves.first);
        let rows = |rows, part: Part| {
            pulp::Arch::new().dispatch(Forward {
                pattern,
                matrix: self,
                forces,
                rows,
                part,
            });
        };
        let first = Part {
            first: 0,
            x: low,
            other: low_defect,
            first_pressure: 0,
            pressures: low_pressures,
        };
        let second = Part {
            first: halves.first,
            x: high,
            other: high_defect,
            first_pressure: halves.coarse,
            pressures: high_pressures,
        };
        join_halves(
            || rows(0..halves.first, first),
            || rows(halves.first..halves.both, second),
        );
        let between = Part {
            first: 0,
            x,
            other: defect,
            first_pressure: 0,
            pressures,
        };
        rows(halves.both..halves.free, between);
    }

    /// Takes what the pressures add off the defect of a forward sweep.
    pub(crate) fn complete_defect(&self, pattern: &Pattern, pressures: &[f32], defect: &mut [Vector]) {
        let half = pattern.halves.free / 2;
        let (first, second) = defect.split_at_mut(half);
        let run = |first, defect| {
            pulp::Arch::new().dispatch(PressureDefect {
                pattern,
                matrix: self,
                pressures,
                first,
                defect,
            });
        };
        join_halves(|| run(0, first), || run(half, second));
    }

    /// One sweep of block Gauss–Seidel the other way, from `x` and its `D Bᵀ x`. `above` is memory.
    pub(crate) fn sweep_backward(
        &self,
        pattern: &Pattern,
        forces: &[Vector],
        x: &mut [Vector],
        pressures: &mut [f32],
        above: &mut [Vector],
    ) {
        let halves = pattern.halves;
        above.fill(Vector::ZERO);
        let rows = |rows, part: Part| {
            pulp::Arch::new().dispatch(Backward {
                pattern,
                matrix: self,
                forces,
                rows,
                part,
            });
        };
        let between = Part {
            first: 0,
            x: &mut *x,
            other: &mut *above,
            first_pressure: 0,
            pressures: &mut *pressures,
        };
        rows(halves.both..halves.free, between);
        let (low, high) = x.split_at_mut(halves.first);
        let (low_pressures, high_pressures) = pressures.split_at_mut(halves.coarse);
        let (low_above, high_above) = above.split_at_mut(halves.first);
        let first = Part {
            first: 0,
            x: low,
            other: low_above,
            first_pressure: 0,
            pressures: low_pressures,
        };
        let second = Part {
            first: halves.first,
            x: high,
            other: high_above,
            first_pressure: halves.coarse,
            pressures: high_pressures,
        };
        join_halves(
            || rows(0..halves.first, first),
            || rows(halves.first..halves.both, second),
        );
    }
}

impl Sink for FineSink<'_> {
    #[inline(always)]
    fn take(&mut self, slot: usize, table: &Table, blocks: &[NodeBlock], slopes: &[NodeSlopes; NODES]) {
        let n_pairs = self.pattern.most_pairs;
        for lane in 0..LANES {
            let places = &self.pattern.block_places[(slot + lane) * n_pairs..][..n_pairs];
            for ((block, &place), [a, b]) in blocks.iter().zip(places).zip(&table.pairs) {
                if place == NOWHERE {
                    continue;
                }
                let sum = if a == b {
                    &mut self.diagonal[place as usize - self.first_row]
                } else {
                    &mut self.blocks[place as usize / 2 - self.first_block]
                };
                if a != b && place % 2 == 1 {
                    for i in 0..3 {
                        for j in 0..3 {
                            sum.0[i][j] += block[i][j].0[lane];
                        }
                    }
                } else {
                    for i in 0..3 {
                        for j in 0..3 {
                            sum.0[j][i] += block[i][j].0[lane];
                        }
                    }
                }
            }
            for (slopes, places) in slopes.iter().zip(&self.pattern.slope_places[slot + lane]) {
                if places[0] == NOWHERE {
                    continue;
                }
                for (slope, &place) in slopes.iter().zip(places) {
                    let sum = &mut self.slopes[place as usize - self.first_slope].0;
                    for i in 0..3 {
                        sum[i] += slope[i].0[lane];
                    }
                }
            }
        }
    }
}

/// Rows of vectors that begin at row `first`, and pressures from `first_pressure` on.
struct Part<'a> {
    first: usize,
    x: &'a mut [Vector],
    other: &'a mut [Vector],
    first_pressure: usize,
    pressures: &'a mut [f32],
}

struct Product<'a> {
    pattern: &'a Pattern,
    matrix: &'a Matrix,
    rows: Range<usize>,
    x: &'a [Vector],
    pressures: &'a [f32],
    first: usize,
    y: &'a mut [Vector],
}

impl NullaryFnOnce for Product<'_> {
    type Output = ();

    #[inline(always)]
    fn call(self) {
        let (pattern, matrix) = (self.pattern, self.matrix);
        for row in self.rows {
            let x = &self.x[row];
            let mut sum = Sum::default();
            sum.add(&matrix.own[row], x);
            let range = pattern.blocks_of(row);
            for (block, column) in matrix.blocks[range.clone()].iter().zip(&pattern.columns[range]) {
                let column = *column as usize;
                sum.add(block, &self.x[column]);
                let y = &mut self.y[column - self.first];
                *y = y.plus_scaled(block.transpose_product(x), 1.0);
            }
            sum.add_slopes(pattern, matrix, row, self.pressures, 0);
            self.y[row - self.first] = sum.total();
        }
    }
}

struct Pressures<'a> {
    pattern: &'a Pattern,
    matrix: &'a Matrix,
    rows: Range<usize>,
    x: &'a [Vector],
    first: usize,
    pressures: &'a mut [f32],
}

impl NullaryFnOnce for Pressures<'_> {
    type Output = ();

    #[inline(always)]
    fn call(self) {
        for row in self.rows {
            let range = self.pattern.slopes_of(row);
            let slopes = &self.matrix.slopes[range.clone()];
            for (slope, column) in slopes.iter().zip(&self.pattern.slope_columns[range]) {
                self.pressures[*column as usize - self.first] += slope.dot(&self.x[row]);
            }
        }
    }
}

struct PressureDefect<'a> {
    pattern: &'a Pattern,
    matrix: &'a Matrix,
    pressures: &'a [f32],
    first: usize,
    defect: &'a mut [Vector],
}

impl NullaryFnOnce for PressureDefect<'_> {
    type Output = ();

    #[inline(always)]
    fn call(self) {
        for (row, defect) in (self.first..).zip(self.defect) {
            let mut sum = Sum::default();
            sum.add_slopes(self.pattern, self.matrix, row, self.pressures, 0);
            *defect = sum.taken_from(defect);
        }
    }
}

struct Forward<'a> {
    pattern: &'a Pattern,
    matrix: &'a Matrix,
    forces: &'a [Vector],
    rows: Range<usize>,
    /// The other vector is the defect.
    part: Part<'a>,
}

impl NullaryFnOnce for Forward<'_> {
    type Output = ();

    #[inline(always)]
    fn call(self) {
        let (pattern, matrix, part) = (self.pattern, self.matrix, self.part);
        for row in self.rows {
            let range = pattern.blocks_of(row);
            let (blocks, columns) = (&matrix.blocks[range.clone()], &pattern.columns[range]);
            let mut sum = Sum::default();
            for (block, column) in blocks.iter().zip(columns) {
                sum.add(block, &part.x[*column as usize - part.first]);
            }
            let known = sum.taken_from(&self.forces[row]);
            let mut sum = Sum::default();
            sum.add_slopes(pattern, matrix, row, part.pressures, part.first_pressure);
            let x = matrix.inverse[row].times(&sum.taken_from(&known));
            part.x[row - part.first] = x;
            let own = matrix.own[row].times(&x);
            part.other[row - part.first] = known.plus_scaled(own, -1.0);
            for (block, column) in blocks.iter().zip(columns) {
                let defect = &mut part.other[*column as usize - part.first];
                *defect = defect.plus_scaled(block.transpose_product(&x), -1.0);
            }
            matrix.move_pressures(pattern, row, &x, part.pressures, part.first_pressure);
        }
    }
}

struct Backward<'a> {
    pattern: &'a Pattern,
    matrix: &'a Matrix,
    forces: &'a [Vector],
    rows: Range<usize>,
    /// The other vector is what stands above the diagonal of `A x`, as far as it is known.
    part: Part<'a>,
}

impl NullaryFnOnce for Backward<'_> {
    type Output = ();

    #[inline(always)]
    fn call(self) {
        let (pattern, matrix, part) = (self.pattern, self.matrix, self.part);
        for row in self.rows.rev() {
            let range = pattern.blocks_of(row);
            let (blocks, columns) = (&matrix.blocks[range.clone()], &pattern.columns[range]);
            let x = part.x[row - part.first];
            let mut sum = Sum::default();
            for (block, column) in blocks.iter().zip(columns) {
                sum.add(block, &part.x[*column as usize - part.first]);
            }
            sum.add(&matrix.own[row], &x);
            sum.add_slopes(pattern, matrix, row, part.pressures, part.first_pressure);
            let known = self.forces[row].plus_scaled(part.other[row - part.first], -1.0);
            let change = matrix.inverse[row].times(&sum.taken_from(&known));
            let x = x.plus_scaled(change, 1.0);
            part.x[row - part.first] = x;
            for (block, column) in blocks.iter().zip(columns) {
                let above = &mut part.other[*column as usize - part.first];
                *above = above.plus_scaled(block.transpose_product(&x), 1.0);
            }
            matrix.move_pressures(pattern, row, &change, part.pressures, part.first_pressure);
        }
    }
}

impl Matrix {
    /// What a row's change does to the pressures.
    #[inline(always)]
    fn move_pressures(
        &self,
        pattern: &Pattern,
        row: usize,
        change: &Vector,
        pressures: &mut [f32],
        first: usize,
    ) {
        let range = pattern.slopes_of(row);
        for (slope, column) in self.slopes[range.clone()]
            .iter()
            .zip(&pattern.slope_columns[range])
        {
            let column = *column as usize;
            pressures[column - first] += pattern.volume_stiffness[column] * slope.dot(change);
        }
    }
}

impl Sum {
    /// Adds `B p` of a row.
    #[inline(always)]
    fn add_slopes(
        &mut self,
        pattern: &Pattern,
        matrix: &Matrix,
        row: usize,
        pressures: &[f32],
        first: usize,
    ) {
        let range = pattern.slopes_of(row);
        let slopes = matrix.slopes[range.clone()]
            .iter()
            .zip(&pattern.slope_columns[range]);
        for (slope, column) in slopes {
            self.add_scaled(slope, pressures[*column as usize - first]);
        }
    }
}
