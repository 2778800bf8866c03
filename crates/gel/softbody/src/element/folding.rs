//! A barrier against folding. Between quadrature points, at which everything is right, quadratic
//! displacements may turn a tetrahedron inside out, beside rims first at its corners. An energy of
//! the volume ratio `J` at each corner prevents that, for a quarter of the tetrahedron's volume:
//!
//! `μ b(J / J_0)` with `b(x) = -(1 - x)² ln x` below `x = 1`, and 0 above
//!
//! It is smooth at `J_0` and rises without bound towards `J = 0` (the barrier of Li et al.,
//! Incremental potential contact, ACM Trans. Graph. 39, 2020, there of a distance). Very close to
//! zero and below, it goes on as a parabola, for materials that find their way out of a fold. It is
//! nonzero beside rims that a mesh is too coarse for, and where the surface moves so far in one
//! step that a tetrahedron folds: there it may hold the fold at another equilibrium.

use super::deformation::{Deformation, Vector, apply};
use super::table::{NODES, QuadraturePoint};
use super::tangent::NodeBlock;
use crate::wide::{Real, Wide};

/// Volume ratio `J_0` below which a corner is stiffened.
const START: f64 = 0.3;

/// `J / J_0` below which the barrier is a parabola.
const STEEP: f64 = 0.02;

/// Energy of the barrier over the shear modulus, and its first two derivatives by the volume ratio.
#[derive(Clone, Copy)]
pub(super) struct Barrier<T> {
    pub(super) energy: Wide<T>,
    pub(super) slope: Wide<T>,
    pub(super) curvature: Wide<T>,
}

impl<T: Real> Barrier<T> {
    /// The barrier at these volume ratios; `None` where it is zero for all of them.
    #[inline(always)]
    pub(super) fn at(volume_ratio: &Wide<T>) -> Option<Self> {
        let ratios = &volume_ratio.0;
        if ratios.iter().all(|ratio| *ratio >= T::from_f64(START)) {
            return None;
        }
        let all = ratios.map(barrier);
        let lanes = |derivative: usize| Wide(all.map(|lane| lane[derivative]));
        Some(Self {
            energy: lanes(0),
            slope: lanes(1),
            curvature: lanes(2),
        })
    }
}

impl Barrier<f32> {
    /// Adds the second derivatives, times a stiffness, to the blocks of the pairs of nodes of a
    /// point.
    #[inline(always)]
    pub(super) fn add_stiffness(
        &self,
        deformation: &Deformation<f32>,
        gradients: &[Vector<f32>; NODES],
        point: &QuadraturePoint,
        scale: Wide<f32>,
        blocks: &mut [NodeBlock],
    ) {
        let curvature = self.curvature * scale;
        // In a fold, the change of the cofactor would make the tangent far from convex.
        let upright = deformation
            .volume_ratio
            .map(|ratio| ratio.max((START * STEEP) as f32));
        let mut skew = self.slope * scale / upright;
        for (skew, ratio) in skew.0.iter_mut().zip(deformation.volume_ratio.0) {
            if f64::from(ratio) < START * STEEP {
                *skew = 0.0;
            }
        }
        let mut spatial = [[Wide::zero(); 3]; NODES];
        for (spatial, gradient) in spatial.iter_mut().zip(&gradients[..point.nodes.len()]) {
            *spatial = apply(&deformation.cofactor, gradient);
        }
        for a in 0..point.nodes.len() {
            for b in 0..=a {
                let block = &mut blocks[point.pairs[a * (a + 1) / 2 + b] as usize];
                for i in 0..3 {
                    for j in 0..3 {
                        block[i][j] = block[i][j]
                            .plus_product(spatial[a][i] * (curvature + skew), spatial[b][j])
                            .plus_product(-(spatial[b][i] * skew), spatial[a][j]);
                    }
                }
            }
        }
    }
}

/// The barrier and its first two derivatives.
fn barrier<T: Real>(ratio: T) -> [T; 3] {
    let number = T::from_f64;
    let ratio = ratio / number(START);
    if ratio >= number(1.0) {
        return [0.0; 3].map(number);
    }
    let x = if ratio < number(STEEP) {
        number(STEEP)
    } else {
        ratio
    };
    let (left, logarithm, beyond) = (number(1.0) - x, x.ln(), ratio - x);
    let over = left / x;
    let curvature = over * (number(4.0) + over) - number(2.0) * logarithm;
    let slope = left * (number(2.0) * logarithm - over);
    let energy = -(left * left * logarithm);
    [
        energy + beyond * (slope + number(0.5) * curvature * beyond),
        (slope + curvature * beyond) / number(START),
        curvature / number(START * START),
    ]
}

#[cfg(test)]
mod tests {
    use glam::DVec3;
    use twintac_material::Model;

    use super::super::tests::{check_derivatives, material, one};
    use super::super::{Element, Response, Volumes};
    use super::*;
    use crate::relaxation::History;

    /// Displacements at which the volume ratio is `1 - 4 part` at one end of an edge.
    fn folded(nodes_mm: &[DVec3], part: f64) -> Vec<DVec3> {
        let mut moved_mm = vec![DVec3::ZERO; nodes_mm.len()];
        let middle_mm = 0.5 * (nodes_mm[0] + nodes_mm[1]);
        let midpoint = nodes_mm.iter().position(|at| at.distance(middle_mm) < 1e-12);
        moved_mm[midpoint.expect("an edge has a midpoint")] = part * (nodes_mm[1] - nodes_mm[0]);
        moved_mm
    }

    #[test]
    fn the_barrier_starts_smoothly_and_pushes_out_of_a_fold() {
        assert_eq!(barrier(START), [0.0; 3]);
        assert!(barrier(0.999 * START).iter().all(|value| value.abs() < 0.1));
        assert!(barrier(-0.5)[1] < barrier(0.0)[1] && barrier(0.0)[1] < barrier(0.01)[1]);
        assert!(barrier(f64::NAN)[0].is_nan());
        let (step, close) = (1e-7, |a: f64, b: f64| (a - b).abs() <= 1e-4 * b.abs());
        for ratio in [-0.3, 0.003, 0.01, 0.1, 0.2, 0.29, 0.35] {
            let [ahead, behind] = [ratio + step, ratio - step].map(barrier);
            let slopes = [0, 1].map(|derivative| (ahead[derivative] - behind[derivative]) / (2.0 * step));
            let [_, slope, curvature] = barrier(ratio);
            assert!(close(slopes[0], slope) && close(slopes[1], curvature), "{ratio}");
        }
    }

    #[test]
    fn a_fold_at_a_corner_is_seen_between_points_that_are_right() {
        for element in [Element::Blended, Element::Quadratic] {
            let (nodes_mm, elements) = one(element);
            let smallest = |moved_mm: &[DVec3]| elements.volumes(moved_mm, &mut Volumes::default());
            let grown_mm: Vec<DVec3> = nodes_mm.iter().map(|at| *at * 0.2).collect();
            assert!((smallest(&grown_mm) - 1.2_f64.powi(3)).abs() < 1e-12);
            for part in [0.2, 0.3] {
                let found = smallest(&folded(&nodes_mm, part));
                assert!((found - (1.0 - 4.0 * part)).abs() < 1e-12, "{element:?}: {found}");
            }
        }
    }

    #[test]
    fn forces_and_tangent_are_slopes_of_the_energy_close_to_a_fold() {
        for element in [Element::Blended, Element::Quadratic] {
            let (nodes_mm, elements) = one(element);
            let material = material(Model::examples()[0].clone(), Vec::new());
            let history = History::default();
            let response = Response::new(&material, 0.0, &history);
            for part in [0.18, 0.2, 0.22] {
                check_derivatives(&elements, &response, &folded(&nodes_mm, part)).expect("slopes");
            }
        }
    }
}
