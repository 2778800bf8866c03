//! The tangent on the coarse mesh, for displacements that are linear on each coarse tetrahedron.

use glam::{Mat3, Vec3};
use pulp::NullaryFnOnce;

use super::super::table::{NODES, Table, ends};
use super::sink::{NodeBlock, NodeSlopes, Sink};
use crate::parallel::dispatch;
use crate::wide::{LANES, Wide};

/// Derivatives of the energy of a coarse tetrahedron whose midpoints stay midway between its
/// corners.
#[derive(Clone, Copy, Default)]
pub(crate) struct CoarseTangent {
    /// For corners `a >= b`, at `a (a + 1) / 2 + b`; N/mm.
    pub(crate) stiffness: [Mat3; 10],
    /// Derivative of each corner's volume (second index) by each corner's displacement (first
    /// index), mm².
    pub(crate) slopes: [[Vec3; 4]; 4],
}

/// Stores the coarse tangents of the slots from `first` on.
pub(crate) struct CoarseSink<'a> {
    pub(crate) first: usize,
    pub(crate) tangents: &'a mut [CoarseTangent],
}

impl Sink for CoarseSink<'_> {
    fn take(&mut self, slot: usize, table: &Table, blocks: &[NodeBlock], slopes: &[NodeSlopes; NODES]) {
        dispatch(Coarsening {
            table,
            blocks,
            slopes,
            out: &mut self.tangents[slot - self.first..][..LANES],
        });
    }
}

struct Coarsening<'a> {
    table: &'a Table,
    blocks: &'a [NodeBlock],
    slopes: &'a [NodeSlopes; NODES],
    out: &'a mut [CoarseTangent],
}

impl NullaryFnOnce for Coarsening<'_> {
    type Output = ();

    #[inline(always)]
    fn call(self) {
        coarsen(self.table, self.blocks, self.slopes, self.out);
    }
}

/// Sums over the nodes that move with each corner.
#[inline(always)]
fn coarsen(table: &Table, blocks: &[NodeBlock], slopes: &[NodeSlopes; NODES], out: &mut [CoarseTangent]) {
    let mut sums = [[[Wide::<f32>::zero(); 3]; 3]; 10];
    for (pair, block) in table.pairs.iter().zip(blocks) {
        let [a, b] = *pair;
        for p in ends(a) {
            for q in ends(b) {
                let sum = &mut sums[index(p, q)];
                let quarter = Wide::splat(0.25);
                for i in 0..3 {
                    for j in 0..3 {
                        // The pair represents both of its orders, one of which is the transpose of
                        // the other.
                        if p >= q {
                            sum[i][j] += block[i][j] * quarter;
                        }
                        if a != b && q >= p {
                            sum[j][i] += block[i][j] * quarter;
                        }
                    }
                }
            }
        }
    }
    let mut slope_sums = [[[Wide::<f32>::zero(); 3]; 4]; 4];
    for (node, slopes) in slopes.iter().enumerate() {
        for end in ends(node as u8) {
            for (sum, slope) in slope_sums[end as usize].iter_mut().zip(slopes) {
                for i in 0..3 {
                    sum[i] += slope[i] * Wide::splat(0.5);
                }
            }
        }
    }
    for (lane, out) in out.iter_mut().enumerate() {
        for (stiffness, sum) in out.stiffness.iter_mut().zip(&sums) {
            *stiffness = lane_of(sum, lane);
        }
        for (slopes, sums) in out.slopes.iter_mut().zip(&slope_sums) {
            for (slope, sum) in slopes.iter_mut().zip(sums) {
                *slope = Vec3::new(sum[0].0[lane], sum[1].0[lane], sum[2].0[lane]);
            }
        }
    }
}

/// Index of a pair of corners in [`CoarseTangent::stiffness`].
fn index(p: u8, q: u8) -> usize {
    let (high, low) = (p.max(q) as usize, p.min(q) as usize);
    high * (high + 1) / 2 + low
}

/// The block of one of the eight tetrahedra.
#[inline(always)]
fn lane_of(block: &NodeBlock, lane: usize) -> Mat3 {
    let column = |j: usize| Vec3::new(block[0][j].0[lane], block[1][j].0[lane], block[2][j].0[lane]);
    Mat3::from_cols(column(0), column(1), column(2))
}
