//! Volume changes, energy and nodal forces. The force at node `a` is `Σ V (P - p J F⁻ᵀ) G_a` over
//! the quadrature points, with the stress `P` of the law and the pressure `p`.

use std::ops::Range;

use glam::DVec3;
use pulp::NullaryFnOnce;

use super::deformation::{Deformation, Matrix, Vector, apply};
use super::elements::{Elements, Pack};
use super::folding::Barrier;
use super::response::Response;
use super::stress::Stresses;
use super::table::{NODES, QuadraturePoint, Table};
use crate::parallel::{dispatch, join_halves};
use crate::wide::{LANES, Wide, least};

/// Forces of the elements on their nodes, which are summed for each node.
#[derive(Default)]
pub(crate) struct Forces {
    /// By slot, N.
    pub(crate) forces_n: Vec<[DVec3; NODES]>,
    /// By pack, N mm.
    pub(crate) energies: Vec<f64>,
}

/// Volume changes of the elements' corners, which are summed for each corner.
#[derive(Default)]
pub(crate) struct Volumes {
    /// By slot, mm³.
    pub(crate) changes_mm3: Vec<[f64; 4]>,
    /// Smallest volume ratio, by pack.
    pub(crate) least: Vec<f64>,
}

struct VolumeKernel<'a> {
    tables: &'a [Table],
    packs: &'a [Pack],
    displacements_mm: &'a [DVec3],
    changes_mm3: &'a mut [[f64; 4]],
    least: &'a mut [f64],
}

struct ForceKernel<'a> {
    tables: &'a [Table],
    packs: &'a [Pack],
    displacements_mm: &'a [DVec3],
    corners: &'a [[f64; 4]],
    response: &'a Response<'a>,
    forces_n: &'a mut [[DVec3; NODES]],
    energies: &'a mut [f64],
}

impl Elements {
    /// Volume changes at the given displacements; returns the smallest volume ratio, or NaN if one
    /// is NaN.
    pub(crate) fn volumes(&self, displacements_mm: &[DVec3], out: &mut Volumes) -> f64 {
        out.changes_mm3.resize(self.n_slots(), [0.0; 4]);
        out.least.resize(self.packs.len(), 0.0);
        let half = self.packs.len() / 2;
        let (packs_a, packs_b) = self.packs.split_at(half);
        let (changes_a, changes_b) = out.changes_mm3.split_at_mut(half * LANES);
        let (least_a, least_b) = out.least.split_at_mut(half);
        let run = |packs, changes_mm3, least| {
            dispatch(VolumeKernel {
                tables: &self.tables,
                packs,
                displacements_mm,
                changes_mm3,
                least,
            });
        };
        join_halves(
            || run(packs_a, changes_a, least_a),
            || run(packs_b, changes_b, least_b),
        );
        out.least.iter().copied().fold(f64::INFINITY, least)
    }

    /// Forces of the slots of a range of packs, N, at the given displacements and pressures of all
    /// slots' corners.
    pub(crate) fn forces_of(
        &self,
        packs: Range<usize>,
        response: &Response,
        displacements_mm: &[DVec3],
        corner_pressures_mpa: &[[f64; 4]],
    ) -> Vec<[DVec3; NODES]> {
        let mut forces_n = vec![[DVec3::ZERO; NODES]; packs.len() * LANES];
        dispatch(ForceKernel {
            tables: &self.tables,
            packs: &self.packs[packs.clone()],
            displacements_mm,
            corners: &corner_pressures_mpa[packs.start * LANES..packs.end * LANES],
            response,
            forces_n: &mut forces_n,
            energies: &mut vec![0.0; packs.len()],
        });
        forces_n
    }

    /// Forces and energies of the change of shape, at the given displacements and pressures of the
    /// slots' corners.
    pub(crate) fn forces(
        &self,
        response: &Response,
        displacements_mm: &[DVec3],
        corner_pressures_mpa: &[[f64; 4]],
        out: &mut Forces,
    ) {
        out.forces_n.resize(self.n_slots(), [DVec3::ZERO; NODES]);
        out.energies.resize(self.packs.len(), 0.0);
        let half = self.packs.len() / 2;
        let (packs_a, packs_b) = self.packs.split_at(half);
        let (corners_a, corners_b) = corner_pressures_mpa.split_at(half * LANES);
        let (forces_a, forces_b) = out.forces_n.split_at_mut(half * LANES);
        let (energies_a, energies_b) = out.energies.split_at_mut(half);
        let run = |packs, corners, forces_n, energies| {
            let kernel = ForceKernel {
                tables: &self.tables,
                packs,
                displacements_mm,
                corners,
                response,
                forces_n,
                energies,
            };
            dispatch(kernel);
        };
        join_halves(
            || run(packs_a, corners_a, forces_a, energies_a),
            || run(packs_b, corners_b, forces_b, energies_b),
        );
    }
}

impl NullaryFnOnce for VolumeKernel<'_> {
    type Output = ();

    #[inline(always)]
    fn call(self) {
        let out = self.changes_mm3.chunks_exact_mut(LANES).zip(self.least);
        for (pack, (changes, least)) in self.packs.iter().zip(out) {
            let ten = pack.gather(self.displacements_mm);
            let mut sums = [Wide::<f64>::zero(); 4];
            let mut smallest = Wide::<f64>::splat(f64::INFINITY);
            let table = &self.tables[pack.table];
            let mut least_of = |ratios: Wide<f64>| {
                for (smallest, ratio) in smallest.0.iter_mut().zip(ratios.0) {
                    *smallest = crate::wide::least(*smallest, ratio);
                }
            };
            for guard in &table.guards {
                least_of(Deformation::new(&ten, guard, &pack.gradients).volume_ratio);
            }
            for point in &table.points {
                let ratio = Deformation::new(&ten, point, &pack.gradients).volume_ratio;
                let change = (ratio - Wide::splat(1.0)) * pack.volume_mm3 * Wide::splat(point.volume);
                for (sum, weight) in sums.iter_mut().zip(point.weights) {
                    *sum += change * Wide::splat(weight);
                }
                least_of(ratio);
            }
            for (lane, changes) in changes.iter_mut().enumerate() {
                *changes = sums.map(|sum| sum.0[lane]);
            }
            *least = smallest.least();
        }
    }
}

impl NullaryFnOnce for ForceKernel<'_> {
    type Output = ();

    #[inline(always)]
    fn call(self) {
        let properties = self.response.material.model.properties();
        let mut at = Stresses::new();
        let inputs = self.packs.iter().zip(self.corners.chunks_exact(LANES));
        let outputs = self.forces_n.chunks_exact_mut(LANES).zip(self.energies);
        for ((pack, corners), (forces_n, energy)) in inputs.zip(outputs) {
            let ten = pack.gather(self.displacements_mm);
            let mut corner_pressures = [Wide::<f64>::zero(); 4];
            for (lane, corners) in corners.iter().enumerate() {
                for (pressure, corner) in corner_pressures.iter_mut().zip(corners) {
                    pressure.0[lane] = *corner;
                }
            }
            let mut sums = [[Wide::<f64>::zero(); 3]; NODES];
            let mut energies = Wide::<f64>::zero();
            let table = &self.tables[pack.table];
            at.evaluate(self.response, properties, table, pack, &ten);
            for (index, point) in table.points.iter().enumerate() {
                let (deformation, stress) = (at.deformation(index), &at.stresses[index]);
                let mut pressure = Wide::zero();
                for (corner, weight) in corner_pressures.iter().zip(point.weights) {
                    pressure = pressure.plus_product(*corner, Wide::splat(weight));
                }
                let volume_mm3 = pack.volume_mm3 * Wide::splat(point.volume);
                energies = energies.plus_product(at.energies[index], volume_mm3);
                let mut scaled = *stress;
                for (row, cofactor) in scaled.iter_mut().zip(&deformation.cofactor) {
                    for (entry, cofactor) in row.iter_mut().zip(cofactor) {
                        *entry = entry.plus_product(-pressure, *cofactor) * volume_mm3;
                    }
                }
                add_forces(&mut sums, pack, point, &scaled);
            }
            for guard in &table.guards {
                let deformation = Deformation::new(&ten, guard, &pack.gradients);
                if let Some(barrier) = Barrier::at(&deformation.volume_ratio) {
                    let shear_mpa = Wide::splat(guard.volume * self.response.shear_modulus_mpa());
                    let scale = pack.volume_mm3 * shear_mpa;
                    energies = energies.plus_product(barrier.energy, scale);
                    let slope = barrier.slope * scale;
                    let scaled = deformation.cofactor.map(|row| row.map(|entry| entry * slope));
                    add_forces(&mut sums, pack, guard, &scaled);
                }
            }
            *energy = energies.sum();
            for (lane, forces) in forces_n.iter_mut().enumerate() {
                for (force, sum) in forces.iter_mut().zip(&sums) {
                    *force = DVec3::new(sum[0].0[lane], sum[1].0[lane], sum[2].0[lane]);
                }
            }
        }
    }
}

/// Adds the forces of a stress, times the volume, to those of the ten nodes.
#[inline(always)]
fn add_forces(sums: &mut [Vector<f64>; NODES], pack: &Pack, point: &QuadraturePoint, scaled: &Matrix<f64>) {
    for (i, row) in scaled.iter().enumerate() {
        // First along the edges of the coarse tetrahedron, then to the nodes.
        let mut first = Wide::zero();
        let along = apply(&pack.gradients, row);
        for (node, slopes) in point.nodes[1..].iter().zip(&point.slopes) {
            let mut force = Wide::zero();
            for k in 0..3 {
                force = force.plus_product(along[k], Wide::splat(slopes[k]));
            }
            sums[*node as usize][i] += force;
            first += force;
        }
        let sum = &mut sums[point.nodes[0] as usize][i];
        *sum -= first;
    }
}
