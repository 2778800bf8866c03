//! Second derivatives of the energy at fixed pressures, in single precision: a direction needs no more.
//!
//! With `f_a = F G_a`, `c_a = J F⁻ᵀ G_a`, `h_a = 2 (I1 F - F C) G_a` and `o_a = 2 F O G_a` the slopes of the invariants, a pair of nodes has
//! `w_11 4 f⊗f + w_22 h⊗h + w_12 2 (f⊗h + h⊗f) + w_1J 2 (f⊗c + c⊗f) + w_2J (h⊗c + c⊗h) + w_JJ c⊗c` from the curvature of the energy, the
//! offset's alike, and from that of the invariants `2 w_1 G_a·G_b 1`,
//! `2 w_2 [2 f_a⊗f_b - f_b⊗f_a + (I1 G_a·G_b - f_a·f_b) 1 - G_a·G_b FFᵀ]` and `(w_J - p)/J (c_a⊗c_b - c_b⊗c_a)`.

use std::ops::Range;

use glam::{DVec3, Mat3, Vec3};
use twintac_material::Law;

use super::deformation::{
    Deformation, Vector, apply, cast, contract, dot, gradients, multiply, right_cauchy_green, symmetric,
};
use super::spectral;
use super::table::{Place, ends};
use super::{Elements, LawKernel, NODES, Pack, Response, Table, dispatch};
use crate::MPA_PER_KPA;
use crate::parallel::join_halves;
use crate::wide::{LANES, Wide};

/// The block of a pair of nodes, in eight tetrahedra.
pub(crate) type NodeBlock = [[Wide<f32>; 3]; 3];

/// The slopes of the four corners' volumes in a node's displacement, in eight tetrahedra.
pub(crate) type NodeSlopes = [[Wide<f32>; 3]; 4];

/// Most pairs of nodes that an element has.
pub(super) const MAX_PAIRS: usize = NODES * (NODES + 1) / 2;

/// Takes the tangents of eight coarse tetrahedra at a time.
pub(crate) trait Sink: Send {
    /// `slot` is that of the first; the blocks are those of the table's pairs.
    fn take(&mut self, slot: usize, table: &Table, blocks: &[NodeBlock], slopes: &[NodeSlopes; NODES]);
}

/// Derivatives of the energy of a coarse tetrahedron whose midpoints move with its corners.
#[derive(Clone, Copy, Default)]
pub(crate) struct CoarseTangent {
    /// For corners `a >= b`, at `a (a + 1) / 2 + b`. N/mm
    pub(crate) stiffness: [Mat3; 10],
    /// Change of each corner's volume (second index) with each corner's displacement (first), mm².
    pub(crate) slopes: [[Vec3; 4]; 4],
}

/// Keeps the coarse tangents of the slots from `first` on.
pub(crate) struct CoarseSink<'a> {
    pub(crate) first: usize,
    pub(crate) tangents: &'a mut [CoarseTangent],
}

struct Kernel<'a, S> {
    tables: &'a [Table],
    packs: &'a [Pack],
    first_pack: usize,
    displacements_mm: &'a [DVec3],
    corners: &'a [[f64; 4]],
    response: Response<'a>,
    sink: S,
}

impl Elements {
    /// Hands the tangents at given displacements and pressures of the slots' corners to one sink for each half, then to one for what lies
    /// between.
    pub(crate) fn tangents(
        &self,
        response: Response,
        displacements_mm: &[DVec3],
        corner_pressures_mpa: &[[f64; 4]],
        [first, second]: [impl Sink; 2],
    ) {
        join_halves(
            || {
                self.tangents_of(
                    response,
                    displacements_mm,
                    corner_pressures_mpa,
                    0..self.halves[0],
                    first,
                )
            },
            || {
                let packs = self.halves[0]..self.halves[1];
                self.tangents_of(response, displacements_mm, corner_pressures_mpa, packs, second);
            },
        );
    }

    /// Hands over the tangents of what lies between the halves.
    pub(crate) fn tangents_between(
        &self,
        response: Response,
        displacements_mm: &[DVec3],
        corner_pressures_mpa: &[[f64; 4]],
        sink: impl Sink,
    ) {
        let packs = self.halves[1]..self.packs.len();
        self.tangents_of(response, displacements_mm, corner_pressures_mpa, packs, sink);
    }

    fn tangents_of(
        &self,
        response: Response,
        displacements_mm: &[DVec3],
        corner_pressures_mpa: &[[f64; 4]],
        packs: Range<usize>,
        sink: impl Sink,
    ) {
        let kernel = Kernel {
            tables: &self.tables,
            packs: &self.packs[packs.clone()],
            first_pack: packs.start,
            displacements_mm,
            corners: &corner_pressures_mpa[packs.start * LANES..packs.end * LANES],
            response,
            sink,
        };
        dispatch(&response.material.model, kernel);
    }

    /// Most pairs that a table has.
    pub(crate) fn most_pairs(&self) -> usize {
        let pairs = self.tables.iter().map(|table| table.pairs.len());
        pairs.max().unwrap_or_default()
    }
}

impl<S: Sink> LawKernel for Kernel<'_, S> {
    type Output = ();

    #[inline(always)]
    fn run<L: Law>(mut self, law: L) {
        let mut blocks = [[[Wide::<f32>::zero(); 3]; 3]; MAX_PAIRS];
        let inputs = self.packs.iter().zip(self.corners.chunks_exact(LANES));
        for (index, (pack, corners)) in (self.first_pack..).zip(inputs) {
            let table = &self.tables[pack.table];
            let wide = pack.gather(self.displacements_mm);
            let mut ten = [[Wide::<f32>::zero(); 3]; NODES];
            for node in 0..NODES {
                for i in 0..3 {
                    ten[node][i] = wide[node][i].cast();
                }
            }
            let mut corner_pressures = [Wide::<f32>::zero(); 4];
            for (lane, corners) in corners.iter().enumerate() {
                for (pressure, corner) in corner_pressures.iter_mut().zip(corners) {
                    pressure.0[lane] = *corner as f32;
                }
            }
            let coarse_gradients = cast::<f32>(&pack.gradients);
            let pack_volume_mm3 = pack.volume_mm3.cast::<f32>();
            let n_pairs = table.pairs.len();
            blocks[..n_pairs].fill([[Wide::zero(); 3]; 3]);
            let mut slopes = [[[Wide::<f32>::zero(); 3]; 4]; NODES];
            for (at, place) in (pack.first_point..).zip(&table.places) {
                let mut pressure = Wide::zero();
                for (corner, weight) in corner_pressures.iter().zip(place.weights) {
                    pressure = pressure.plus_product(*corner, Wide::splat(weight));
                }
                let offset = if self.response.memory.is_empty() {
                    None
                } else {
                    self.response.relaxation.offset(self.response.memory.point(at))
                };
                let spatial = add_stiffness(
                    &law,
                    &Deformation::new(&ten, place, &coarse_gradients),
                    &gradients(&coarse_gradients, place),
                    place,
                    [
                        pressure,
                        pack_volume_mm3 * Wide::splat(place.volume),
                        Wide::splat(self.response.relaxation.factor * MPA_PER_KPA),
                    ],
                    offset,
                    &mut blocks,
                );
                for (node, spatial) in place.nodes.iter().zip(&spatial) {
                    let slopes = &mut slopes[*node as usize];
                    for corner in 0..4 {
                        for i in 0..3 {
                            slopes[corner][i] = slopes[corner][i]
                                .plus_product(spatial[i], Wide::splat(place.weights[corner]));
                        }
                    }
                }
            }
            self.sink.take(index * LANES, table, &blocks[..n_pairs], &slopes);
        }
    }
}

#[inline(always)]
fn lane_of(block: &NodeBlock, lane: usize) -> Mat3 {
    let column = |j: usize| Vec3::new(block[0][j].0[lane], block[1][j].0[lane], block[2][j].0[lane]);
    Mat3::from_cols(column(0), column(1), column(2))
}

/// Adds the blocks of all pairs `a >= b` of the nodes that a point feels; returns the slopes of its volume in their displacements.
#[inline(always)]
fn add_stiffness<L: Law>(
    law: &L,
    deformation: &Deformation<f32>,
    gradients: &[Vector<f32>; NODES],
    place: &Place,
    [pressure, volume_mm3, factor]: [Wide<f32>; 3],
    offset: Option<[Wide<f64>; 6]>,
    blocks: &mut [NodeBlock; MAX_PAIRS],
) -> [Vector<f32>; NODES] {
    let f = &deformation.gradient;
    let two = Wide::splat(2.0);
    let invariants = deformation.invariants(law);
    let slopes = law.slopes(&invariants);
    let curvatures = law.curvatures(&invariants);
    let scale = factor * volume_mm3;
    let inverse = if L::BEARS_INVERSION {
        Wide::splat(1.0) / away_from_zero(deformation.volume_ratio)
    } else {
        Wide::splat(1.0) / deformation.volume_ratio
    };

    let mut pushed = [[Wide::zero(); 3]; NODES];
    let mut spatial = [[Wide::zero(); 3]; NODES];
    for a in 0..place.nodes.len() {
        pushed[a] = apply(f, &gradients[a]);
        spatial[a] = apply(&deformation.cofactor, &gradients[a]);
    }
    let mut along_volume = slopes.volume * scale - pressure * volume_mm3;
    let mut spatial_spatial = curvatures.volume_volume * scale;
    let spatial_pushed = curvatures.first_volume * scale * two;
    let pushed_pushed = curvatures.first_first * scale * Wide::splat(4.0);
    let isotropic = slopes.first * scale * two;

    // What a memory adds: the slopes of `J^(-2/3) O:C / 2`.
    let mut remembered = [[Wide::zero(); 3]; NODES];
    let mut spatial_remembered = Wide::zero();
    let mut turned = [[Wide::zero(); 3]; NODES];
    if let Some(offset) = offset {
        let offset = symmetric::<f32>(offset);
        let product = multiply(f, &offset);
        let isochoric = invariants.isochoric * volume_mm3;
        let square = contract(f, &product) * isochoric;
        along_volume -= square * inverse * Wide::splat(1.0 / 3.0);
        spatial_spatial += square * inverse * inverse * Wide::splat(5.0 / 9.0);
        spatial_remembered = isochoric * inverse * Wide::splat(-2.0 / 3.0);
        for a in 0..place.nodes.len() {
            remembered[a] = apply(&product, &gradients[a]);
            turned[a] = apply(&offset, &gradients[a]).map(|x| x * isochoric);
        }
    }

    // What the second invariant adds.
    let mut second = [[Wide::zero(); 3]; NODES];
    let mut left_cauchy_green = [[Wide::zero(); 3]; 3];
    if L::USES_SECOND {
        let product = multiply(f, &right_cauchy_green(f));
        for a in 0..place.nodes.len() {
            let moved = apply(&product, &gradients[a]);
            for i in 0..3 {
                second[a][i] = (invariants.first * pushed[a][i] - moved[i]) * two;
            }
        }
        for i in 0..3 {
            for j in 0..3 {
                left_cauchy_green[i][j] = dot(&f[i], &f[j]);
            }
        }
    }

    // (w_J - p)/J (c_a⊗c_b - c_b⊗c_a)
    let skew = along_volume * inverse;
    for a in 0..place.nodes.len() {
        for b in 0..=a {
            // What stands right of c_a, and of f_a.
            let mut right_of_spatial = [Wide::zero(); 3];
            let mut right_of_pushed = [Wide::zero(); 3];
            for j in 0..3 {
                right_of_spatial[j] =
                    (spatial[b][j] * (spatial_spatial + skew)).plus_product(pushed[b][j], spatial_pushed);
                right_of_pushed[j] = spatial[b][j] * spatial_pushed;
                if L::IS_CURVED {
                    right_of_pushed[j] += pushed[b][j] * pushed_pushed;
                }
                if offset.is_some() {
                    right_of_spatial[j] += remembered[b][j] * spatial_remembered;
                }
            }
            let block = &mut blocks[place.pairs[a * (a + 1) / 2 + b] as usize];
            for i in 0..3 {
                let left = -(spatial[b][i] * skew);
                for j in 0..3 {
                    block[i][j] = block[i][j]
                        .plus_product(spatial[a][i], right_of_spatial[j])
                        .plus_product(pushed[a][i], right_of_pushed[j])
                        .plus_product(left, spatial[a][j]);
                }
            }
            let product = dot(&gradients[a], &gradients[b]);
            let mut diagonal = isotropic * product;
            if offset.is_some() {
                diagonal += dot(&gradients[a], &turned[b]);
                for i in 0..3 {
                    for j in 0..3 {
                        block[i][j] += remembered[a][i] * spatial_remembered * spatial[b][j];
                    }
                }
            }
            if L::USES_SECOND {
                let twice = slopes.second * scale * two;
                diagonal += twice * (invariants.first * product - dot(&pushed[a], &pushed[b]));
                let with_volume = curvatures.second_volume * scale;
                for i in 0..3 {
                    for j in 0..3 {
                        block[i][j] += twice
                            * (two * pushed[a][i] * pushed[b][j]
                                - pushed[b][i] * pushed[a][j]
                                - product * left_cauchy_green[i][j])
                            + with_volume * (second[a][i] * spatial[b][j] + spatial[a][i] * second[b][j]);
                        if L::IS_CURVED {
                            block[i][j] += curvatures.second_second * scale * second[a][i] * second[b][j]
                                + curvatures.first_second
                                    * scale
                                    * two
                                    * (pushed[a][i] * second[b][j] + second[a][i] * pushed[b][j]);
                        }
                    }
                }
            }
            for i in 0..3 {
                block[i][i] += diagonal;
            }
        }
    }
    if let Some(stretches) = law.stretches() {
        spectral::add_stiffness(&stretches, f, gradients, place, scale, blocks);
    }
    for spatial in &mut spatial {
        *spatial = spatial.map(|x| x * volume_mm3);
    }
    spatial
}

/// Keeps single precision meaningful in tetrahedra that are about to turn inside out.
#[inline(always)]
fn away_from_zero(volume_ratio: Wide<f32>) -> Wide<f32> {
    volume_ratio.map(|ratio| ratio.abs().max(1e-3).copysign(ratio))
}

impl Sink for CoarseSink<'_> {
    #[inline(always)]
    fn take(&mut self, slot: usize, table: &Table, blocks: &[NodeBlock], slopes: &[NodeSlopes; NODES]) {
        let out = &mut self.tangents[slot - self.first..][..LANES];
        coarsen(table, blocks, slopes, out);
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
                        // The pair stands for both of its orders, one the other's transpose.
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

/// Where a pair of corners stands.
fn index(p: u8, q: u8) -> usize {
    let (high, low) = (p.max(q) as usize, p.min(q) as usize);
    high * (high + 1) / 2 + low
}
