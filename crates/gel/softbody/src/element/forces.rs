//! Volume changes, energy and nodal forces.
//!
//! `P = ∂W/∂F = 2 w_1 F + 2 w_2 (I1 F - F C) + (w_J - p) J F⁻ᵀ` from the derivatives of the energy in the invariants, and for a
//! material with a memory `J^(-2/3) (F O - (O:C)/3 F⁻ᵀ)` from its offset `O`. The force that pulls at node `a` is `Σ V P G_a`.

use glam::DVec3;
use twintac_material::Law;

use super::deformation::{Deformation, Matrix, apply, contract, multiply, right_cauchy_green, symmetric};
use super::spectral;
use super::{Elements, LawKernel, NODES, Pack, Response, Table, dispatch};
use crate::MPA_PER_KPA;
use crate::parallel::join_halves;
use crate::wide::{LANES, Wide, least};

/// Forces of the elements on their nodes, to be gathered node by node.
#[derive(Default)]
pub(crate) struct Forces {
    /// By slot. N
    pub(crate) forces_n: Vec<[DVec3; NODES]>,
    /// By pack. N mm
    pub(crate) energies: Vec<f64>,
}

/// Volume changes of the elements' corners, to be gathered corner by corner.
#[derive(Default)]
pub(crate) struct Volumes {
    /// By slot. mm³
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
    response: Response<'a>,
    forces_n: &'a mut [[DVec3; NODES]],
    energies: &'a mut [f64],
}

impl Elements {
    /// Volume changes at given displacements; the smallest volume ratio is not a number if any is not.
    pub(crate) fn volumes(&self, displacements_mm: &[DVec3], out: &mut Volumes) -> f64 {
        out.changes_mm3.resize(self.n_slots(), [0.0; 4]);
        out.least.resize(self.packs.len(), 0.0);
        let half = self.packs.len() / 2;
        let (packs_a, packs_b) = self.packs.split_at(half);
        let (changes_a, changes_b) = out.changes_mm3.split_at_mut(half * LANES);
        let (least_a, least_b) = out.least.split_at_mut(half);
        let run = |packs, changes_mm3, least| {
            pulp::Arch::new().dispatch(VolumeKernel {
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

    /// Forces and energies of the change of shape; `pressures_mpa` by coarse node.
    pub(crate) fn forces(
        &self,
        response: Response,
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
            dispatch(&response.material.model, kernel);
        };
        join_halves(
            || run(packs_a, corners_a, forces_a, energies_a),
            || run(packs_b, corners_b, forces_b, energies_b),
        );
    }
}

impl pulp::NullaryFnOnce for VolumeKernel<'_> {
    type Output = ();

    #[inline(always)]
    fn call(self) {
        let out = self.changes_mm3.chunks_exact_mut(LANES).zip(self.least);
        for (pack, (changes, least)) in self.packs.iter().zip(out) {
            let ten = pack.gather(self.displacements_mm);
            let mut sums = [Wide::<f64>::zero(); 4];
            let mut smallest = Wide::<f64>::splat(f64::INFINITY);
            for place in &self.tables[pack.table].places {
                let ratio = Deformation::new(&ten, place, &pack.gradients).volume_ratio;
                let change = (ratio - Wide::splat(1.0)) * pack.volume_mm3 * Wide::splat(place.volume);
                for (sum, weight) in sums.iter_mut().zip(place.weights) {
                    *sum += change * Wide::splat(weight);
                }
                for (smallest, ratio) in smallest.0.iter_mut().zip(ratio.0) {
                    *smallest = crate::wide::least(*smallest, ratio);
                }
            }
            for (lane, changes) in changes.iter_mut().enumerate() {
                *changes = sums.map(|sum| sum.0[lane]);
            }
            *least = smallest.least();
        }
    }
}

/// `∂W/∂F` without the pressure's part, and `W`, MPa.
#[inline(always)]
pub(super) fn first_piola_kirchhoff<L: Law>(
    law: &L,
    deformation: &Deformation<f64>,
    factor: f64,
    offset: Option<[Wide<f64>; 6]>,
) -> (Matrix<f64>, Wide<f64>) {
    let f = &deformation.gradient;
    let invariants = deformation.invariants(law);
    let slopes = law.slopes(&invariants);
    let scale = Wide::splat(factor * MPA_PER_KPA);
    let mut energy = law.energy(&invariants) * scale;
    let mut along_f = slopes.first * scale * Wide::splat(2.0);
    let mut along_cofactor = slopes.volume * scale;
    let mut stress = [[Wide::zero(); 3]; 3];
    if L::USES_SECOND {
        let twice = slopes.second * scale * Wide::splat(2.0);
        along_f += twice * invariants.first;
        let pushed = multiply(f, &right_cauchy_green(f));
        for i in 0..3 {
            for j in 0..3 {
                stress[i][j] -= twice * pushed[i][j];
            }
        }
    }
    if let Some(stretches) = law.stretches() {
        energy += spectral::add_stress(&stretches, f, scale, &mut stress);
    }
    if let Some(offset) = offset {
        let pushed = multiply(f, &symmetric(offset));
        let remembered = contract(f, &pushed) * invariants.isochoric;
        energy += remembered * Wide::splat(0.5);
        along_cofactor -= remembered / (deformation.volume_ratio * Wide::splat(3.0));
        for i in 0..3 {
            for j in 0..3 {
                stress[i][j] += invariants.isochoric * pushed[i][j];
            }
        }
    }
    for i in 0..3 {
        for j in 0..3 {
            stress[i][j] = stress[i][j]
                .plus_product(along_f, f[i][j])
                .plus_product(along_cofactor, deformation.cofactor[i][j]);
        }
    }
    (stress, energy)
}

impl LawKernel for ForceKernel<'_> {
    type Output = ();

    #[inline(always)]
    fn run<L: Law>(self, law: L) {
        let Response {
            relaxation, memory, ..
        } = self.response;
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
            for (at, place) in (pack.first_point..).zip(&self.tables[pack.table].places) {
                let deformation = Deformation::new(&ten, place, &pack.gradients);
                let offset = if memory.is_empty() {
                    None
                } else {
                    relaxation.offset(memory.point(at))
                };
                let (stress, energy) = first_piola_kirchhoff(&law, &deformation, relaxation.factor, offset);
                let mut pressure = Wide::zero();
                for (corner, weight) in corner_pressures.iter().zip(place.weights) {
                    pressure = pressure.plus_product(*corner, Wide::splat(weight));
                }
                let volume_mm3 = pack.volume_mm3 * Wide::splat(place.volume);
                energies = energies.plus_product(energy, volume_mm3);
                for i in 0..3 {
                    let mut row = stress[i];
                    for j in 0..3 {
                        row[j] = row[j].plus_product(-pressure, deformation.cofactor[i][j]) * volume_mm3;
                    }
                    // Along the coarse tetrahedron's edges, then to the nodes.
                    let mut first = Wide::zero();
                    let along = apply(&pack.gradients, &row);
                    for (node, slopes) in place.nodes[1..].iter().zip(&place.slopes) {
                        let mut force = Wide::zero();
                        for k in 0..3 {
                            force = force.plus_product(along[k], Wide::splat(slopes[k]));
                        }
                        sums[*node as usize][i] += force;
                        first += force;
                    }
                    let sum = &mut sums[place.nodes[0] as usize][i];
                    *sum -= first;
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
