//! Stress at the points of a pack.
//!
//! `P = ∂W/∂F = 2 w_1 F + 2 w_2 (I1 F - F C) + w_J J F⁻ᵀ` from the derivatives of the energy by the
//! invariants. A material with history variables adds `J^(-2/3) (F O - (O:C)/3 F⁻ᵀ)` from their
//! constant part `O`. The part of the pressure is not included.

use glam::DVec3;
use pulp::NullaryFnOnce;
use twintac_material::{LawProperties, Material};

use super::deformation::{
    Deformation, Matrix, Vector, contract, dot, multiply, right_cauchy_green, symmetric,
};
use super::elements::{Elements, Pack};
use super::law::{FirstDerivatives, Points};
use super::response::Response;
use super::spectral;
use super::table::{MAX_POINTS, NODES, QuadraturePoint, Table};
use crate::MPA_PER_KPA;
use crate::parallel::dispatch;
use crate::relaxation::{History, Relaxation};
use crate::wide::{LANES, Wide};

/// Stress and energy at the points of a pack. Scratch memory, filled pack by pack.
pub(super) struct Stresses {
    points: Points<FirstDerivatives>,
    /// First Piola–Kirchhoff stress `P`, MPa.
    pub(super) stresses: [Matrix<f64>; MAX_POINTS],
    /// Energy per undeformed volume, MPa.
    pub(super) energies: [Wide<f64>; MAX_POINTS],
}

impl Stresses {
    pub(super) fn new() -> Self {
        Self {
            points: Points::new(),
            stresses: [[[Wide::zero(); 3]; 3]; MAX_POINTS],
            energies: [Wide::zero(); MAX_POINTS],
        }
    }

    /// The deformation at a point.
    #[inline(always)]
    pub(super) fn deformation(&self, point: usize) -> &Deformation<f64> {
        &self.points.deformations[point]
    }

    /// Evaluates a pack with this table, from the displacements of its ten nodes. It is not
    /// inlined, so that it is compiled once for all callers.
    #[inline(never)]
    pub(super) fn evaluate(
        &mut self,
        response: &Response,
        properties: LawProperties,
        table: &Table,
        pack: &Pack,
        ten: &[Vector<f64>; NODES],
    ) {
        dispatch(Evaluation {
            stresses: self,
            response,
            properties,
            table,
            pack,
            ten,
        });
    }

    /// Computes stress and energy at a point whose deformation and law have been evaluated.
    #[inline(always)]
    fn finish(
        &mut self,
        properties: LawProperties,
        point: usize,
        factor: f64,
        offset: Option<&[Wide<f64>; 6]>,
    ) {
        let deformation = &self.points.deformations[point];
        let invariants = &self.points.arguments[point].invariants;
        let law = &self.points.law[point];
        let f = &deformation.gradient;
        let scale = Wide::splat(factor * MPA_PER_KPA);
        let mut energy = law.energy * scale;
        let mut along_f = law.slopes.first * scale * Wide::splat(2.0);
        let mut along_cofactor = law.slopes.volume * scale;
        let mut stress = [[Wide::zero(); 3]; 3];
        if properties.uses_second {
            let twice = law.slopes.second * scale * Wide::splat(2.0);
            along_f += twice * invariants.first;
            let pushed = multiply(f, &right_cauchy_green(f));
            for i in 0..3 {
                for j in 0..3 {
                    stress[i][j] -= twice * pushed[i][j];
                }
            }
        }
        if properties.uses_stretches {
            let principal = &self.points.principal[point];
            spectral::add_stress(principal, &law.stretch_slopes, f, scale, &mut stress);
            energy += law.stretch_energy * scale;
        }
        if let Some(offset) = offset {
            let pushed = multiply(f, &symmetric(offset));
            let work = contract(f, &pushed) * invariants.isochoric;
            energy += work * Wide::splat(0.5);
            along_cofactor -= work / (deformation.volume_ratio * Wide::splat(3.0));
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
        self.stresses[point] = stress;
        self.energies[point] = energy;
    }
}

struct Evaluation<'a> {
    stresses: &'a mut Stresses,
    response: &'a Response<'a>,
    properties: LawProperties,
    table: &'a Table,
    pack: &'a Pack,
    ten: &'a [Vector<f64>; NODES],
}

impl NullaryFnOnce for Evaluation<'_> {
    type Output = ();

    #[inline(always)]
    fn call(self) {
        let Self {
            stresses,
            response,
            properties,
            table,
            pack,
            ten,
        } = self;
        let model = &response.material.model;
        stresses
            .points
            .evaluate(model, properties, table, ten, &pack.gradients);
        for point in 0..table.points.len() {
            let offset = response.offset(pack.first_point + point);
            stresses.finish(properties, point, response.relaxation.factor, offset);
        }
    }
}

/// One point of a pack, and its stress.
struct Point<'a> {
    pack: &'a Pack,
    quadrature: &'a QuadraturePoint,
    /// Index among the points of all packs.
    index: usize,
    deformation: &'a Deformation<f64>,
    /// First Piola–Kirchhoff stress without the part of the pressure, MPa.
    stress: &'a Matrix<f64>,
}

/// Calls `take` with the points of all packs.
fn for_each_point(
    elements: &Elements,
    response: &Response,
    displacements_mm: &[DVec3],
    take: &mut dyn FnMut(&Point),
) {
    let properties = response.material.model.properties();
    let mut stresses = Stresses::new();
    for pack in &elements.packs {
        let table = &elements.tables[pack.table];
        let ten = pack.gather(displacements_mm);
        stresses.evaluate(response, properties, table, pack, &ten);
        for (index, quadrature) in table.points.iter().enumerate() {
            take(&Point {
                pack,
                quadrature,
                index: pack.first_point + index,
                deformation: stresses.deformation(index),
                stress: &stresses.stresses[index],
            });
        }
    }
}

impl Point<'_> {
    /// Kirchhoff stress `P Fᵀ`, the Cauchy stress times `J`.
    fn kirchhoff(&self, i: usize, j: usize) -> Wide<f64> {
        dot(&self.stress[i], &self.deformation.gradient[j])
    }

    fn mean_kirchhoff(&self) -> Wide<f64> {
        (self.kirchhoff(0, 0) + self.kirchhoff(1, 1) + self.kirchhoff(2, 2)) * Wide::splat(1.0 / 3.0)
    }

    /// Undeformed volume, mm³.
    fn volume_mm3(&self) -> Wide<f64> {
        self.pack.volume_mm3 * Wide::splat(self.quadrature.volume)
    }
}

/// Sums at each node over the points of its elements: the deviator of the Cauchy stress (xx, yy,
/// zz, yz, xz, xy; MPa) times the deformed volume, and that volume, mm³; `[n_nodes]`.
pub(crate) fn mean_deviators(
    elements: &Elements,
    response: &Response,
    displacements_mm: &[DVec3],
) -> Vec<([f64; 6], f64)> {
    let mut sums = vec![([0.0; 6], 0.0); displacements_mm.len()];
    for_each_point(elements, response, displacements_mm, &mut |point| {
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
        for &node in &point.quadrature.nodes {
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

/// The contribution of a law that is not isochoric to the hydrostatic pressure: sums over the
/// points of each slot of the corners' shares of `-tr(σ)/3`, MPa, times the undeformed volume, mm³;
/// `None` for an isochoric law; `[n_slots]`.
pub(crate) fn hydrostatic_shares(
    elements: &Elements,
    response: &Response,
    displacements_mm: &[DVec3],
) -> Option<Vec<[f64; 4]>> {
    if response.material.model.properties().is_isochoric {
        return None;
    }
    let mut shares = Vec::with_capacity(elements.n_slots());
    for_each_point(elements, response, displacements_mm, &mut |point| {
        let pressure = -point.mean_kirchhoff() / point.deformation.volume_ratio * point.volume_mm3();
        if point.index == point.pack.first_point {
            shares.extend([[0.0; 4]; LANES]);
        }
        let first = shares.len() - LANES;
        for (lane, shares) in shares[first..].iter_mut().enumerate() {
            for (share, weight) in shares.iter_mut().zip(point.quadrature.weights) {
                *share += weight * pressure.0[lane];
            }
        }
    });
    Some(shares)
}

/// Updates the history variables of all points to the end of a step.
pub(crate) fn update_history(
    elements: &Elements,
    material: &Material,
    step: &Relaxation,
    displacements_mm: &[DVec3],
    history: &mut History,
) {
    if history.is_empty() {
        return;
    }
    let no_history = History::default();
    let instantaneous = Response::instantaneous(material, &no_history);
    for_each_point(elements, &instantaneous, displacements_mm, &mut |point| {
        history.update(step, point.index, &instantaneous_deviator(point));
    });
}

/// `S̃ = J^(2/3) F⁻¹ P`, with the `P` of the change of shape: a deviator.
fn instantaneous_deviator(point: &Point) -> [Wide<f64>; 6] {
    let Deformation {
        cofactor,
        volume_ratio,
        ..
    } = *point.deformation;
    let root = volume_ratio.inverse_cube_root();
    // F⁻¹ is the transpose of the cofactor divided by J.
    let scale = Wide::splat(1.0) / (root * root * volume_ratio);
    [(0, 0), (1, 1), (2, 2), (1, 2), (0, 2), (0, 1)].map(|(i, j)| {
        let column = |m: &Matrix<f64>, j: usize| [m[0][j], m[1][j], m[2][j]];
        dot(&column(&cofactor, i), &column(point.stress, j)) * scale
    })
}
