//! Stress, to be shown and to be remembered.

use glam::DVec3;
use twintac_material::{Law, Material};

use super::deformation::{Deformation, Matrix, dot};
use super::forces::first_piola_kirchhoff;
use super::table::Place;
use super::{Elements, LawKernel, Pack, Response, dispatch};
use crate::relaxation::{Memory, Relaxation};
use crate::wide::{LANES, Wide};

/// Hands the stress of eight points at a time, without the pressure's part, to `take`.
struct StressKernel<'a> {
    elements: &'a Elements,
    response: Response<'a>,
    displacements_mm: &'a [DVec3],
    take: &'a mut dyn FnMut(&Point),
}

/// Eight points, and their first Piola–Kirchhoff stress.
struct Point<'a> {
    pack: &'a Pack,
    place: &'a Place,
    index: usize,
    deformation: Deformation<f64>,
    stress: Matrix<f64>,
}

impl LawKernel for StressKernel<'_> {
    type Output = ();

    #[inline(always)]
    fn run<L: Law>(self, law: L) {
        let Response {
            relaxation, memory, ..
        } = self.response;
        for pack in &self.elements.packs {
            let ten = pack.gather(self.displacements_mm);
            for (index, place) in (pack.first_point..).zip(&self.elements.tables[pack.table].places) {
                let deformation = Deformation::new(&ten, place, &pack.gradients);
                let offset = if memory.is_empty() {
                    None
                } else {
                    relaxation.offset(memory.point(index))
                };
                let (stress, _) = first_piola_kirchhoff(&law, &deformation, relaxation.factor, offset);
                (self.take)(&Point {
                    pack,
                    place,
                    index,
                    deformation,
                    stress,
                });
            }
        }
    }
}

fn for_each_stress(
    elements: &Elements,
    response: Response,
    displacements_mm: &[DVec3],
    mut take: impl FnMut(&Point),
) {
    let kernel = StressKernel {
        elements,
        response,
        displacements_mm,
        take: &mut take,
    };
    dispatch(&response.material.model, kernel);
}

impl Point<'_> {
    /// Kirchhoff stress `P Fᵀ`, the Cauchy stress times `J`.
    fn kirchhoff(&self, i: usize, j: usize) -> Wide<f64> {
        dot(&self.stress[i], &self.deformation.gradient[j])
    }

    fn mean_kirchhoff(&self) -> Wide<f64> {
        (self.kirchhoff(0, 0) + self.kirchhoff(1, 1) + self.kirchhoff(2, 2)) * Wide::splat(1.0 / 3.0)
    }

    /// Volume at rest, mm³.
    fn volume_mm3(&self) -> Wide<f64> {
        self.pack.volume_mm3 * Wide::splat(self.place.volume)
    }
}

/// Sums over the points that feel each node of the deviator of the Cauchy stress (xx, yy, zz, yz, xz, xy; MPa) times the deformed volume,
/// and of that volume, mm³. `[n_nodes]`
pub(crate) fn mean_deviators(
    elements: &Elements,
    response: Response,
    displacements_mm: &[DVec3],
) -> Vec<([f64; 6], f64)> {
    let mut sums = vec![([0.0; 6], 0.0); displacements_mm.len()];
    for_each_stress(elements, response, displacements_mm, |point| {
        let mean = point.mean_kirchhoff();
        let volume_mm3 = point.volume_mm3();
        let deviator = [
            point.kirchhoff(0, 0) - mean,
            point.kirchhoff(1, 1) - mean,
            point.kirchhoff(2, 2) - mean,
            point.kirchhoff(1, 2),
            point.kirchhoff(0, 2),
            point.kirchhoff(0, 1),
        ]
        .map(|entry| entry * volume_mm3);
        let volume_mm3 = point.deformation.volume_ratio * volume_mm3;
        for &node in &point.place.nodes {
            for lane in 0..LANES {
                let (sum, volume) = &mut sums[point.pack.nodes[node as usize][lane] as usize];
                for (sum, part) in sum.iter_mut().zip(&deviator) {
                    *sum += part.0[lane];
                }
                *volume += volume_mm3.0[lane];
            }
        }
    });
    sums
}

/// What a law that is not isochoric adds to the hydrostatic pressure: sums over the points of each slot of the corners' shares of `-tr(σ)/3`,
/// MPa, times the volume at rest, mm³; none for an isochoric law. `[n_slots]`
pub(crate) fn hydrostatic_shares(
    elements: &Elements,
    response: Response,
    displacements_mm: &[DVec3],
) -> Option<Vec<[f64; 4]>> {
    if response.material.is_isochoric() {
        return None;
    }
    let mut shares = Vec::with_capacity(elements.n_slots());
    for_each_stress(elements, response, displacements_mm, |point| {
        let pressure = -point.mean_kirchhoff() / point.deformation.volume_ratio * point.volume_mm3();
        if point.index == point.pack.first_point {
            shares.extend([[0.0; 4]; LANES]);
        }
        let first = shares.len() - LANES;
        for (lane, shares) in shares[first..].iter_mut().enumerate() {
            for (share, weight) in shares.iter_mut().zip(point.place.weights) {
                *share += weight * pressure.0[lane];
            }
        }
    });
    Some(shares)
}

/// Takes the memory of all points to the end of a step.
pub(crate) fn remember(
    elements: &Elements,
    material: &Material,
    step: &Relaxation,
    displacements_mm: &[DVec3],
    memory: &mut Memory,
) {
    if memory.is_empty() {
        return;
    }
    // The stress of a material without a past.
    let instantaneous = Response {
        material,
        relaxation: &Relaxation::new(&[], 0.0),
        memory: &Memory::default(),
    };
    for_each_stress(elements, instantaneous, displacements_mm, |point| {
        memory.remember(step, point.index, &instantaneous_deviator(point));
    });
}

/// `S̃ = J^(2/3) F⁻¹ P`, `P` that of the change of shape: a deviator.
fn instantaneous_deviator(point: &Point) -> [Wide<f64>; 6] {
    let Deformation {
        cofactor,
        volume_ratio,
        ..
    } = point.deformation;
    let root = volume_ratio.inverse_cube_root();
    // F⁻¹ is the cofactor's transpose over J.
    let scale = Wide::splat(1.0) / (root * root * volume_ratio);
    [(0, 0), (1, 1), (2, 2), (1, 2), (0, 2), (0, 1)].map(|(i, j)| {
        let column = |m: &Matrix<f64>, j: usize| [m[0][j], m[1][j], m[2][j]];
        dot(&column(&cofactor, i), &column(&point.stress, j)) * scale
    })
}
