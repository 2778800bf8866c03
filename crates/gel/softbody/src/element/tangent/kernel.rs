//! Computes the tangents of the elements, pack by pack.

use std::ops::Range;

use glam::DVec3;
use pulp::NullaryFnOnce;

use super::super::deformation::{Deformation, Vector, cast, gradients};
use super::super::elements::{Elements, Pack};
use super::super::folding::Barrier;
use super::super::law::{Points, SecondDerivatives};
use super::super::response::Response;
use super::super::spectral;
use super::super::table::{NODES, Table};
use super::sink::Sink;
use super::stiffness::PointStiffness;
use crate::MPA_PER_KPA;
use crate::parallel::{dispatch, join_halves};
use crate::wide::{LANES, Wide};

/// Largest number of pairs of nodes of an element.
const MAX_PAIRS: usize = NODES * (NODES + 1) / 2;

struct Kernel<'a> {
    tables: &'a [Table],
    packs: &'a [Pack],
    first_pack: usize,
    displacements_mm: &'a [DVec3],
    corners: &'a [[f64; 4]],
    response: &'a Response<'a>,
    sink: &'a mut dyn Sink,
}

impl Elements {
    /// Passes the tangents of each half to its sink, at the given displacements and pressures of
    /// the slots' corners.
    pub(crate) fn tangents(
        &self,
        response: &Response,
        displacements_mm: &[DVec3],
        corner_pressures_mpa: &[[f64; 4]],
        [first, second]: [&mut dyn Sink; 2],
    ) {
        let run = |packs: Range<usize>, sink: &mut dyn Sink| {
            self.tangents_of(response, displacements_mm, corner_pressures_mpa, packs, sink);
        };
        join_halves(
            || run(0..self.halves[0], first),
            || run(self.halves[0]..self.halves[1], second),
        );
    }

    /// Passes the tangents of the elements between the halves to the sink.
    pub(crate) fn tangents_between(
        &self,
        response: &Response,
        displacements_mm: &[DVec3],
        corner_pressures_mpa: &[[f64; 4]],
        sink: &mut dyn Sink,
    ) {
        let packs = self.halves[1]..self.packs.len();
        self.tangents_of(response, displacements_mm, corner_pressures_mpa, packs, sink);
    }

    fn tangents_of(
        &self,
        response: &Response,
        displacements_mm: &[DVec3],
        corner_pressures_mpa: &[[f64; 4]],
        packs: Range<usize>,
        sink: &mut dyn Sink,
    ) {
        dispatch(Kernel {
            tables: &self.tables,
            packs: &self.packs[packs.clone()],
            first_pack: packs.start,
            displacements_mm,
            corners: &corner_pressures_mpa[packs.start * LANES..packs.end * LANES],
            response,
            sink,
        });
    }

    /// Largest number of pairs of a table.
    pub(crate) fn most_pairs(&self) -> usize {
        let pairs = self.tables.iter().map(|table| table.pairs.len());
        pairs.max().unwrap_or_default()
    }
}

impl NullaryFnOnce for Kernel<'_> {
    type Output = ();

    #[inline(always)]
    fn call(self) {
        let model = &self.response.material.model;
        let properties = model.properties();
        let factor = Wide::splat(self.response.relaxation.factor * MPA_PER_KPA);
        let shear_mpa = self.response.shear_modulus_mpa();
        let mut at = Points::<SecondDerivatives>::new();
        let mut stiffness = PointStiffness::new();
        let mut blocks = [[[Wide::<f32>::zero(); 3]; 3]; MAX_PAIRS];
        let inputs = self.packs.iter().zip(self.corners.chunks_exact(LANES));
        for (index, (pack, corners)) in (self.first_pack..).zip(inputs) {
            let table = &self.tables[pack.table];
            let ten = pack.gather_single(self.displacements_mm);
            let mut corner_pressures = [Wide::<f32>::zero(); 4];
            for (lane, corners) in corners.iter().enumerate() {
                for (pressure, corner) in corner_pressures.iter_mut().zip(corners) {
                    pressure.0[lane] = *corner as f32;
                }
            }
            let coarse_gradients = cast::<f32>(&pack.gradients);
            let pack_volume_mm3 = pack.volume_mm3.cast::<f32>();
            let blocks = &mut blocks[..table.pairs.len()];
            blocks.fill([[Wide::zero(); 3]; 3]);
            let mut slopes = [[[Wide::<f32>::zero(); 3]; 4]; NODES];
            at.evaluate(model, properties, table, &ten, &coarse_gradients);
            for (number, point) in table.points.iter().enumerate() {
                let mut pressure = Wide::zero();
                for (corner, weight) in corner_pressures.iter().zip(point.weights) {
                    pressure = pressure.plus_product(*corner, Wide::splat(weight));
                }
                let offset = self.response.offset(pack.first_point + number);
                let gradients = gradients(&coarse_gradients, point);
                let volume_mm3 = pack_volume_mm3 * Wide::splat(point.volume);
                stiffness.set(
                    &at,
                    number,
                    properties,
                    &gradients[..point.nodes.len()],
                    [pressure, volume_mm3, factor],
                    offset,
                );
                for a in 0..point.nodes.len() {
                    for b in 0..=a {
                        let block = &mut blocks[point.pairs[a * (a + 1) / 2 + b] as usize];
                        stiffness.add(properties, &gradients, [a, b], block);
                    }
                }
                if properties.uses_stretches {
                    let f = &at.deformations[number].gradient;
                    let (principal, law) = (&at.principal[number], &at.law[number].stretches);
                    spectral::add_stiffness(
                        principal,
                        law,
                        f,
                        &gradients,
                        point,
                        factor * volume_mm3,
                        blocks,
                    );
                }
                for (node, spatial) in point.nodes.iter().zip(&stiffness.spatial) {
                    let spatial = spatial.map(|x| x * volume_mm3);
                    let slopes = &mut slopes[*node as usize];
                    for corner in 0..4 {
                        for i in 0..3 {
                            slopes[corner][i] = slopes[corner][i]
                                .plus_product(spatial[i], Wide::splat(point.weights[corner]));
                        }
                    }
                }
            }
            for guard in &table.guards {
                let deformation = Deformation::new(&ten, guard, &coarse_gradients);
                if let Some(barrier) = Barrier::at(&deformation.volume_ratio) {
                    let scale = pack_volume_mm3 * Wide::splat(guard.volume * shear_mpa);
                    let gradients = gradients(&coarse_gradients, guard);
                    barrier.add_stiffness(&deformation, &gradients, guard, scale, blocks);
                }
            }
            self.sink.take(index * LANES, table, blocks, &slopes);
        }
    }
}

impl Pack {
    /// The displacements of the ten nodes, in single precision.
    #[inline(always)]
    fn gather_single(&self, displacements_mm: &[DVec3]) -> [Vector<f32>; NODES] {
        let ten = self.gather(displacements_mm);
        let mut single = [[Wide::zero(); 3]; NODES];
        for node in 0..NODES {
            for i in 0..3 {
                single[node][i] = ten[node][i].cast();
            }
        }
        single
    }
}
