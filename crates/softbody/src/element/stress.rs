//! Stress, to be shown and to be remembered.

use glam::DVec3;

use super::deformation::{Deformation, contract, multiply};
use super::forces::first_piola_kirchhoff;
use super::{Elements, Response, with_law};
use crate::material::{Law, Memory, Relaxation};
use crate::wide::{LANES, Wide};

/// Sums over the points that feel each node of the deviator of the Cauchy stress (xx, yy, zz, yz, xz, xy; MPa) times the deformed volume,
/// and of that volume, mm³. `[n_nodes]`
pub(crate) fn mean_deviators(
    elements: &Elements,
    response: Response,
    displacements_mm: &[DVec3],
) -> Vec<([f64; 6], f64)> {
    let mut sums = vec![([0.0; 6], 0.0); displacements_mm.len()];
    for pack in &elements.packs {
        let ten = pack.gather(displacements_mm);
        for (at, place) in (pack.first_point..).zip(&elements.tables[pack.table].places) {
            let volume_mm3 = pack.volume_mm3 * Wide::splat(place.volume);
            let deformation = Deformation::new(&ten, place, &pack.gradients);
            let offset = if response.memory.is_empty() {
                None
            } else {
                response.relaxation.offset(response.memory.point(at))
            };
            let (stress, _) = with_law!(response.material, law =>
                first_piola_kirchhoff(&law, &deformation, response.relaxation.factor, offset));
            // Kirchhoff stress P Fᵀ: the Cauchy stress times the deformed over the reference volume.
            let f = &deformation.gradient;
            let entry = |i: usize, j: usize| {
                (stress[i][0] * f[j][0] + stress[i][1] * f[j][1] + stress[i][2] * f[j][2]) * volume_mm3
            };
            let [xx, yy, zz] = [entry(0, 0), entry(1, 1), entry(2, 2)];
            let mean = (xx + yy + zz) * Wide::splat(1.0 / 3.0);
            let deviator = [
                xx - mean,
                yy - mean,
                zz - mean,
                entry(1, 2),
                entry(0, 2),
                entry(0, 1),
            ];
            let volume_mm3 = deformation.volume_ratio * volume_mm3;
            for &node in &place.nodes {
                for lane in 0..LANES {
                    let (sum, volume) = &mut sums[pack.nodes[node as usize][lane] as usize];
                    for (sum, part) in sum.iter_mut().zip(&deviator) {
                        *sum += part.0[lane];
                    }
                    *volume += volume_mm3.0[lane];
                }
            }
        }
    }
    sums
}

/// Takes the memory of all points to the end of a step.
pub(crate) fn remember(
    elements: &Elements,
    material: &crate::Material,
    step: &Relaxation,
    displacements_mm: &[DVec3],
    memory: &mut Memory,
) {
    if memory.is_empty() {
        return;
    }
    for pack in &elements.packs {
        let ten = pack.gather(displacements_mm);
        for (at, place) in (pack.first_point..).zip(&elements.tables[pack.table].places) {
            let deformation = Deformation::new(&ten, place, &pack.gradients);
            let stress = with_law!(material, law => instantaneous_deviator(&law, &deformation));
            memory.remember(step, at, &stress);
        }
    }
}

/// `S̃ = J^(2/3) (S - (S:C)/3 C⁻¹)` with `S = F⁻¹ P`, `P` that of the change of shape.
fn instantaneous_deviator<L: Law>(law: &L, deformation: &Deformation<f64>) -> [Wide<f64>; 6] {
    let (stress, _) = first_piola_kirchhoff(law, deformation, 1.0, None);
    let invariants = deformation.invariants(law);
    let inverse = Wide::splat(1.0) / deformation.volume_ratio;
    // F⁻ᵀ, whose rows dotted with those of P give S: its transpose is F⁻¹.
    let mut inverse_transpose = deformation.cofactor;
    for row in &mut inverse_transpose {
        *row = row.map(|entry| entry * inverse);
    }
    // P:F is S:C; for an energy of the change of shape alone it is zero already.
    let mean = contract(&stress, &deformation.gradient) * Wide::splat(1.0 / 3.0);
    let mut difference = stress;
    for i in 0..3 {
        for j in 0..3 {
            difference[i][j] = stress[i][j] - inverse_transpose[i][j] * mean;
        }
    }
    let mut transposed = inverse_transpose;
    for i in 0..3 {
        for j in 0..3 {
            transposed[i][j] = inverse_transpose[j][i];
        }
    }
    let product = multiply(&transposed, &difference);
    let scale = Wide::splat(1.0) / invariants.isochoric;
    [(0, 0), (1, 1), (2, 2), (1, 2), (0, 2), (0, 1)].map(|(i, j)| product[i][j] * scale)
}
