//! The system on the fine mesh: the lower triangle of `A` with its diagonal, and `B √D`, row by
//! row.

use std::ops::Range;

use glam::Mat3;
use pulp::NullaryFnOnce;

use super::block::{Block, Vector};
use super::numbering::Halves;
use crate::element::{Elements, NODES, NodeBlock, NodeSlopes, Sink, Table};
use crate::parallel::{dispatch, join_halves};
use crate::wide::LANES;

/// The index for a pair of nodes one of which is bonded: its block is not stored.
const NONE: u32 = u32::MAX;

/// The sparsity of the system: the neighbours of each free node.
pub(crate) struct Pattern {
    pub(crate) halves: Halves,
    /// Start of the blocks of each row below the diagonal, ascending; `[n_free + 1]`.
    rows: Vec<u32>,
    pub(super) columns: Vec<u32>,
    /// Start of the coarse nodes whose volume changes with each row's node; `[n_free + 1]`.
    slope_rows: Vec<u32>,
    pub(super) slope_columns: Vec<u32>,
    /// Square roots of the bulk modulus divided by the volume of each coarse node, `√D`.
    pub(super) root_stiffness: Vec<f32>,
    /// Where the blocks of each slot's pairs are added: for a node with itself the row, otherwise
    /// twice the index of the block, plus one if transposed. `[n_slots][most_pairs]`, flat.
    block_indices: Vec<u32>,
    most_pairs: usize,
    /// Where the derivatives of each slot's nodes and corners are added.
    slope_indices: Vec<[[u32; 4]; NODES]>,
}

/// The values of the system.
pub(crate) struct Matrix {
    diagonal: Vec<Block>,
    pub(super) blocks: Vec<Block>,
    /// Rows of `B √D`.
    pub(super) slopes: Vec<Vector>,
    /// Stiffness of contact and damping, which is added to the diagonal; `[n_free]`.
    extra: Vec<Block>,
    /// The damping in it, in units of each node's own stiffness.
    damping: f64,
    /// Rows to whose diagonal contact has added, and those of the previous contact.
    pressed: Vec<u32>,
    released: Vec<u32>,
    /// Whether the whole diagonal has changed since it was last completed.
    is_new: bool,
    /// Blocks that contact has added to, and their previous values.
    covered: Vec<(u32, Block)>,
    /// The complete diagonal of `A`; `[n_free]`.
    pub(super) own: Vec<Block>,
    /// Inverse of the diagonal of `H`; `[n_free]`.
    pub(super) inverse: Vec<Block>,
}

/// Adds the tangents of one half, or of the elements between the halves.
pub(crate) struct FineSink<'a> {
    pattern: &'a Pattern,
    first_row: usize,
    diagonal: &'a mut [Block],
    first_block: usize,
    blocks: &'a mut [Block],
    first_slope: usize,
    slopes: &'a mut [Vector],
}

impl FineSink<'_> {
    fn clear(&mut self) {
        self.diagonal.fill(Block::default());
        self.blocks.fill(Block::default());
        self.slopes.fill(Vector::ZERO);
    }
}

/// Rows of sorted columns without repetition.
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
    /// `parents` are the ten nodes of each coarse tetrahedron, corners first; `corners` are its
    /// coarse nodes.
    pub(crate) fn new(
        elements: &Elements,
        parents: &[[u32; NODES]],
        corners: &[[u32; 4]],
        halves: Halves,
        volume_stiffness: &[f64],
    ) -> Self {
        let is_free = |node: u32| (node as usize) < halves.free;
        // Pairs of free nodes, later node first.
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
        let mut block_indices = vec![NONE; elements.n_slots() * most_pairs];
        let mut slope_indices = vec![[[NONE; 4]; NODES]; elements.n_slots()];
        for ((nodes, corners), &slot) in parents.iter().zip(corners).zip(&elements.slots) {
            let slot_indices = &mut block_indices[slot as usize * most_pairs..];
            for (index, &pair) in slot_indices.iter_mut().zip(&elements.table_of(slot).pairs) {
                if let Some((row, column, is_turned)) = pair_of(nodes, pair) {
                    *index = if row == column {
                        row
                    } else {
                        2 * find(&rows, &columns, row, column) + u32::from(is_turned)
                    };
                }
            }
            for (indices, &node) in slope_indices[slot as usize].iter_mut().zip(nodes) {
                if is_free(node) {
                    *indices = corners.map(|corner| find(&slope_rows, &slope_columns, node, corner));
                }
            }
        }
        Self {
            halves,
            rows,
            columns,
            slope_rows,
            slope_columns,
            root_stiffness: volume_stiffness
                .iter()
                .map(|stiffness| stiffness.sqrt() as f32)
                .collect(),
            block_indices,
            most_pairs,
            slope_indices,
        }
    }

    pub(crate) fn matrix(&self) -> Matrix {
        let blocks = || vec![Block::default(); self.halves.free];
        Matrix {
            diagonal: blocks(),
            blocks: vec![Block::default(); self.columns.len()],
            slopes: vec![Vector::ZERO; self.slope_columns.len()],
            extra: blocks(),
            damping: 0.0,
            pressed: Vec::new(),
            released: Vec::new(),
            is_new: true,
            covered: Vec::new(),
            own: blocks(),
            inverse: blocks(),
        }
    }

    pub(crate) fn n_coarse(&self) -> usize {
        self.root_stiffness.len()
    }

    #[inline(always)]
    pub(super) fn blocks_of(&self, row: usize) -> Range<usize> {
        self.rows[row] as usize..self.rows[row + 1] as usize
    }

    #[inline(always)]
    pub(super) fn slopes_of(&self, row: usize) -> Range<usize> {
        self.slope_rows[row] as usize..self.slope_rows[row + 1] as usize
    }
}

impl Matrix {
    /// Clears the matrix, and returns the sinks of the two halves.
    pub(crate) fn halves<'a>(&'a mut self, pattern: &'a Pattern) -> [FineSink<'a>; 2] {
        self.covered.clear();
        self.is_new = true;
        let first_row = pattern.halves.first;
        let first_block = pattern.rows[first_row] as usize;
        let first_slope = pattern.slope_rows[first_row] as usize;
        let diagonal = self.diagonal.split_at_mut(first_row);
        let blocks = self.blocks.split_at_mut(first_block);
        let slopes = self.slopes.split_at_mut(first_slope);
        let mut sinks = [
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
        ];
        let [first, second] = &mut sinks;
        join_halves(|| first.clear(), || second.clear());
        sinks
    }

    /// The sink of the elements between the halves.
    pub(crate) fn between<'a>(&'a mut self, pattern: &'a Pattern) -> FineSink<'a> {
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

    /// Scales the summed derivatives from `B` to `B √D`.
    pub(crate) fn scale_slopes(&mut self, pattern: &Pattern) {
        for (slope, column) in self.slopes.iter_mut().zip(&pattern.slope_columns) {
            *slope = Vector::ZERO.plus_scaled(*slope, pattern.root_stiffness[*column as usize]);
        }
    }

    /// Takes the stiffness of contact away, and damps each node by a multiple of its own stiffness.
    pub(crate) fn take_back(&mut self, damping: f64, node_stiffness: &[f64]) {
        let damped = |stiffness: &f64| Block::diagonal((damping * stiffness) as f32);
        if damping == self.damping {
            for &row in &self.pressed {
                self.extra[row as usize] = damped(&node_stiffness[row as usize]);
            }
        } else {
            self.damping = damping;
            self.is_new = true;
            let rows = self.extra.iter_mut().zip(node_stiffness);
            rows.for_each(|(extra, stiffness)| *extra = damped(stiffness));
        }
        self.released.append(&mut self.pressed);
        for (index, block) in self.covered.drain(..).rev() {
            self.blocks[index as usize] = block;
        }
    }

    /// Adds the stiffness of a point that depends on neighbouring nodes. The matrix has to be
    /// completed afterwards.
    pub(crate) fn add_at(
        &mut self,
        pattern: &Pattern,
        parts: impl Iterator<Item = (u32, f64)> + Clone,
        stiffness: &Mat3,
    ) {
        let mut parts = parts.filter(|(node, _)| (*node as usize) < pattern.halves.free);
        while let Some((node, part)) = parts.next() {
            let part = part as f32;
            self.extra[node as usize].add(&Block::from_mat3(&(*stiffness * (part * part))));
            self.pressed.push(node);
            for (other, other_part) in parts.clone() {
                let index = find(&pattern.rows, &pattern.columns, node.max(other), node.min(other));
                let block = &mut self.blocks[index as usize];
                self.covered.push((index, *block));
                // The stiffness is symmetric, so the order does not matter.
                block.add(&Block::from_mat3(&(*stiffness * (part * other_part as f32))));
            }
        }
    }

    /// Completes the diagonal with the present extra stiffness.
    pub(crate) fn complete(&mut self, pattern: &Pattern) {
        let (diagonal, slopes, extra) = (&self.diagonal, &self.slopes, &self.extra);
        let complete = |row: usize, own: &mut Block, inverse: &mut Block| {
            *own = diagonal[row];
            own.add(&extra[row]);
            let mut whole = *own;
            for at in pattern.slopes_of(row) {
                whole.add_square(&slopes[at]);
            }
            *inverse = whole.inverse();
        };
        if self.is_new {
            let half = pattern.halves.free / 2;
            let rows = |first: usize, own: &mut [Block], inverse: &mut [Block]| {
                for (row, (own, inverse)) in (first..).zip(own.iter_mut().zip(inverse)) {
                    complete(row, own, inverse);
                }
            };
            let own = self.own.split_at_mut(half);
            let inverse = self.inverse.split_at_mut(half);
            join_halves(|| rows(0, own.0, inverse.0), || rows(half, own.1, inverse.1));
        } else {
            for row in self.released.iter().chain(&self.pressed) {
                let row = *row as usize;
                complete(row, &mut self.own[row], &mut self.inverse[row]);
            }
        }
        self.released.clear();
        self.is_new = false;
    }
}

impl Sink for FineSink<'_> {
    fn take(&mut self, slot: usize, table: &Table, blocks: &[NodeBlock], slopes: &[NodeSlopes; NODES]) {
        dispatch(Addition {
            sink: self,
            slot,
            table,
            blocks,
            slopes,
        });
    }
}

/// Eight tetrahedra whose tangents are added.
struct Addition<'a, 'b> {
    sink: &'a mut FineSink<'b>,
    slot: usize,
    table: &'a Table,
    blocks: &'a [NodeBlock],
    slopes: &'a [NodeSlopes; NODES],
}

impl NullaryFnOnce for Addition<'_, '_> {
    type Output = ();

    #[inline(always)]
    fn call(self) {
        let Self {
            sink,
            slot,
            table,
            blocks,
            slopes,
        } = self;
        let n_pairs = sink.pattern.most_pairs;
        for lane in 0..LANES {
            let indices = &sink.pattern.block_indices[(slot + lane) * n_pairs..][..n_pairs];
            for ((block, &index), [a, b]) in blocks.iter().zip(indices).zip(&table.pairs) {
                if index == NONE {
                    continue;
                }
                let sum = if a == b {
                    &mut sink.diagonal[index as usize - sink.first_row]
                } else {
                    &mut sink.blocks[index as usize / 2 - sink.first_block]
                };
                if a != b && index % 2 == 1 {
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
            for (slopes, indices) in slopes.iter().zip(&sink.pattern.slope_indices[slot + lane]) {
                if indices[0] == NONE {
                    continue;
                }
                for (slope, &index) in slopes.iter().zip(indices) {
                    let sum = &mut sink.slopes[index as usize - sink.first_slope].0;
                    for i in 0..3 {
                        sum[i] += slope[i].0[lane];
                    }
                }
            }
        }
    }
}
