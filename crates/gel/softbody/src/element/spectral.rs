//! The part of stress and tangent that comes from a law of the principal stretches (Simo and
//! Taylor, Comput. Methods Appl. Mech. Eng. 85, 1991; Holzapfel, Nonlinear Solid Mechanics, 2000,
//! section 6.6).
//!
//! With `C = Σ x_k N_k ⊗ N_k`, `x = λ²` and the derivatives `β_k = f'(ln λ̄_k)`, the principal
//! Kirchhoff stresses are `τ_k = β_k - (β_1 + β_2 + β_3)/3`. In the principal axes the second
//! derivative of the energy has the entries `∂²W/∂F_kk∂F_ll = (∂τ_k/∂ln λ_l - δ_kl τ_k)/(λ_k λ_l)`,
//! `∂²W/∂F_kl² = q = (τ_k - τ_l)/(x_k - x_l)` and
//! `∂²W/∂F_kl∂F_lk = (q (x_k + x_l)/2 - (τ_k + τ_l)/2)/(λ_k λ_l)`. Only `q` is a quotient of
//! differences: `q = m / 2e`, with `m = (β_k - β_l)/(ln λ_k - ln λ_l)` of the law and
//! `e = (x_k - x_l)/(ln x_k - ln x_l)`, both exact for equal stretches.

use twintac_material::StretchSlopes;

use super::deformation::{Matrix, Vector, apply, dot, right_cauchy_green};
use super::principal::principal;
use super::table::{NODES, QuadraturePoint};
use crate::wide::{Real, Wide};

/// Squares of the stretches, their logarithms, those of the isochoric stretches, and the axes in
/// the undeformed state.
#[derive(Clone, Copy)]
pub(super) struct Principal<T> {
    squares: Vector<T>,
    double_logarithms: Vector<T>,
    pub(super) isochoric_logarithms: Vector<T>,
    axes: [Vector<T>; 3],
}

impl<T: Real> Principal<T> {
    /// The values without deformation, as a start.
    pub(super) fn zero() -> Self {
        let zero = [Wide::zero(); 3];
        Self {
            squares: zero,
            double_logarithms: zero,
            isochoric_logarithms: zero,
            axes: [zero; 3],
        }
    }

    /// The values of a deformation gradient.
    #[inline(always)]
    pub(super) fn new(f: &Matrix<T>) -> Self {
        let (squares, axes) = principal(&right_cauchy_green(f));
        let double_logarithms = squares.map(Wide::ln);
        let isochoric_logarithms = deviator(&double_logarithms).map(|value| value * Wide::splat(0.5));
        Self {
            squares,
            double_logarithms,
            isochoric_logarithms,
            axes,
        }
    }
}

/// The values minus their mean.
#[inline(always)]
fn deviator<T: Real>(values: &Vector<T>) -> Vector<T> {
    let mean = (values[0] + values[1] + values[2]) * Wide::splat(1.0 / 3.0);
    values.map(|value| value - mean)
}

/// Adds `∂W/∂F` times a factor, from the derivatives `β` of the law.
#[inline(always)]
pub(super) fn add_stress(
    at: &Principal<f64>,
    slopes: &Vector<f64>,
    f: &Matrix<f64>,
    scale: Wide<f64>,
    stress: &mut Matrix<f64>,
) {
    let kirchhoff = deviator(slopes);
    for k in 0..3 {
        let pushed = apply(f, &at.axes[k]);
        let along = kirchhoff[k] * scale / at.squares[k];
        for i in 0..3 {
            for j in 0..3 {
                stress[i][j] = stress[i][j].plus_product(pushed[i] * along, at.axes[k][j]);
            }
        }
    }
}

/// The second derivative in the principal axes, times a factor.
struct Stiffness {
    /// Entries (kk, ll).
    direct: Matrix<f32>,
    /// Entries (kl, kl), k ≠ l.
    shear: Matrix<f32>,
    /// Entries (kl, lk), k ≠ l.
    swapped: Matrix<f32>,
}

#[inline(always)]
fn stiffness(
    at: &Principal<f32>,
    law: &StretchSlopes<f32>,
    inverse_stretches: &Vector<f32>,
    scale: Wide<f32>,
) -> Stiffness {
    let x = &at.squares;
    let half = Wide::splat(0.5);
    let kirchhoff = deviator(&law.slopes);
    let mut direct = [[Wide::zero(); 3]; 3];
    let mut shear = direct;
    let mut swapped = direct;
    let third = Wide::splat(1.0 / 3.0);
    let mean = (law.own[0] + law.own[1] + law.own[2]) * Wide::splat(1.0 / 9.0);
    for k in 0..3 {
        for l in 0..3 {
            let mut change = mean - (law.own[k] + law.own[l]) * third;
            if k == l {
                change += law.own[k] - kirchhoff[k];
            }
            direct[k][l] = change * inverse_stretches[k] * inverse_stretches[l] * scale;
        }
        let (a, b) = ((k + 1) % 3, (k + 2) % 3);
        let quotient =
            Wide::exponential_quotient([at.double_logarithms[a], at.double_logarithms[b]], [x[a], x[b]]);
        let same = half * law.between[k] / quotient;
        let other = half * (same * (x[a] + x[b]) - kirchhoff[a] - kirchhoff[b]);
        let other = other * inverse_stretches[a] * inverse_stretches[b] * scale;
        (shear[a][b], shear[b][a]) = (same * scale, same * scale);
        (swapped[a][b], swapped[b][a]) = (other, other);
    }
    Stiffness {
        direct,
        shear,
        swapped,
    }
}

/// Adds `∂²W/∂F²` times a factor to the blocks of all pairs of a point's nodes, from the
/// derivatives of the law.
#[inline(always)]
pub(super) fn add_stiffness(
    at: &Principal<f32>,
    law: &StretchSlopes<f32>,
    f: &Matrix<f32>,
    gradients: &[Vector<f32>; NODES],
    point: &QuadraturePoint,
    scale: Wide<f32>,
    blocks: &mut [Matrix<f32>],
) {
    let inverse_stretches = at.squares.map(|square| Wide::splat(1.0) / square.sqrt());
    let Stiffness {
        direct,
        shear,
        swapped,
    } = stiffness(at, law, &inverse_stretches, scale);

    let mut axes = at.axes;
    for k in 0..3 {
        axes[k] = apply(f, &at.axes[k]).map(|entry| entry * inverse_stretches[k]);
    }
    let mut along = [[Wide::zero(); 3]; NODES];
    for a in 0..point.nodes.len() {
        along[a] = apply(&at.axes, &gradients[a]);
    }
    for a in 0..point.nodes.len() {
        for b in 0..=a {
            let (of_a, of_b) = (&along[a], &along[b]);
            // Rows in the principal axes, columns in space.
            let mut rows = [[Wide::zero(); 3]; 3];
            for k in 0..3 {
                let mut row = [Wide::zero(); 3];
                for l in 0..3 {
                    if k == l {
                        let (p, q) = ((k + 1) % 3, (k + 2) % 3);
                        row[k] = of_a[k] * of_b[k] * direct[k][k]
                            + of_a[p] * of_b[p] * shear[k][p]
                            + of_a[q] * of_b[q] * shear[k][q];
                    } else {
                        row[l] = of_a[k] * of_b[l] * direct[k][l] + of_a[l] * of_b[k] * swapped[k][l];
                    }
                }
                for j in 0..3 {
                    rows[k][j] = dot(&row, &[axes[0][j], axes[1][j], axes[2][j]]);
                }
            }
            let block = &mut blocks[point.pairs[a * (a + 1) / 2 + b] as usize];
            for i in 0..3 {
                for j in 0..3 {
                    for k in 0..3 {
                        block[i][j] = block[i][j].plus_product(axes[k][i], rows[k][j]);
                    }
                }
            }
        }
    }
}
