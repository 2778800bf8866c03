//! The deformation at a quadrature point, for eight tetrahedra at a time, and algebra of 3 × 3
//! matrices.

use twintac_material::Invariants;

use super::table::{NODES, QuadraturePoint};
use crate::wide::{Real, Wide};

/// A matrix, row by row.
pub(crate) type Matrix<T> = [[Wide<T>; 3]; 3];

/// A vector.
pub(crate) type Vector<T> = [Wide<T>; 3];

/// Deformation gradient `F`, its cofactor `J F⁻ᵀ`, and `J`.
#[derive(Clone, Copy)]
pub(crate) struct Deformation<T> {
    pub(crate) gradient: Matrix<T>,
    pub(crate) cofactor: Matrix<T>,
    pub(crate) volume_ratio: Wide<T>,
}

impl<T: Real> Deformation<T> {
    #[inline(always)]
    pub(super) fn new(ten: &[Vector<T>; NODES], point: &QuadraturePoint, gradients: &Matrix<T>) -> Self {
        let origin = &ten[point.nodes[0] as usize];
        let mut f = [[Wide::zero(); 3]; 3];
        for i in 0..3 {
            f[i][i] = Wide::splat(1.0);
            // First along the edges of the coarse tetrahedron, then in space.
            let mut along = [Wide::zero(); 3];
            for (node, slopes) in point.nodes[1..].iter().zip(&point.slopes) {
                let u = ten[*node as usize][i] - origin[i];
                for k in 0..3 {
                    along[k] = along[k].plus_product(u, Wide::splat(slopes[k]));
                }
            }
            for k in 0..3 {
                for j in 0..3 {
                    f[i][j] = f[i][j].plus_product(along[k], gradients[k][j]);
                }
            }
        }
        let cofactor = cofactor(&f);
        let volume_ratio = dot(&f[0], &cofactor[0]);
        Self {
            gradient: f,
            cofactor,
            volume_ratio,
        }
    }

    #[inline(always)]
    pub(super) fn invariants(&self, with_second: bool) -> Invariants<T> {
        let first = contract(&self.gradient, &self.gradient);
        let second = if with_second {
            let c = right_cauchy_green(&self.gradient);
            (first * first - contract(&c, &c)) * Wide::splat(0.5)
        } else {
            Wide::zero()
        };
        let root = self.volume_ratio.inverse_cube_root();
        Invariants {
            first,
            second,
            volume_ratio: self.volume_ratio,
            isochoric: root * root,
        }
    }
}

/// Gradients of the shape functions at a point, in the order of its nodes, from the gradients of
/// the barycentric coordinates.
#[inline(always)]
pub(super) fn gradients<T: Real>(coarse: &Matrix<T>, point: &QuadraturePoint) -> [Vector<T>; NODES] {
    let mut all = [[Wide::zero(); 3]; NODES];
    for (own, slopes) in (1..).zip(&point.slopes) {
        for i in 0..3 {
            let mut sum = Wide::zero();
            for k in 0..3 {
                sum = sum.plus_product(coarse[k][i], Wide::splat(slopes[k]));
            }
            all[own][i] = sum;
            all[0][i] -= sum;
        }
    }
    all
}

/// The same matrix in another precision.
#[inline(always)]
pub(super) fn cast<T: Real>(m: &Matrix<f64>) -> Matrix<T> {
    let mut out = [[Wide::zero(); 3]; 3];
    for i in 0..3 {
        for j in 0..3 {
            out[i][j] = m[i][j].cast();
        }
    }
    out
}

#[inline(always)]
fn cofactor<T: Real>(f: &Matrix<T>) -> Matrix<T> {
    let mut out = [[Wide::zero(); 3]; 3];
    for i in 0..3 {
        let (a, b) = ((i + 1) % 3, (i + 2) % 3);
        for j in 0..3 {
            let (c, d) = ((j + 1) % 3, (j + 2) % 3);
            out[i][j] = (f[a][c] * f[b][d]).plus_product(-f[a][d], f[b][c]);
        }
    }
    out
}

/// `a : b`
#[inline(always)]
pub(super) fn contract<T: Real>(a: &Matrix<T>, b: &Matrix<T>) -> Wide<T> {
    dot(&a[0], &b[0]) + dot(&a[1], &b[1]) + dot(&a[2], &b[2])
}

#[inline(always)]
pub(super) fn dot<T: Real>(a: &Vector<T>, b: &Vector<T>) -> Wide<T> {
    (a[0] * b[0]).plus_product(a[1], b[1]).plus_product(a[2], b[2])
}

/// `C = FᵀF`
#[inline(always)]
pub(super) fn right_cauchy_green<T: Real>(f: &Matrix<T>) -> Matrix<T> {
    let mut c = [[Wide::zero(); 3]; 3];
    for i in 0..3 {
        for j in 0..=i {
            let sum = f[0][i] * f[0][j] + f[1][i] * f[1][j] + f[2][i] * f[2][j];
            c[i][j] = sum;
            c[j][i] = sum;
        }
    }
    c
}

/// `a b`
#[inline(always)]
pub(super) fn multiply<T: Real>(a: &Matrix<T>, b: &Matrix<T>) -> Matrix<T> {
    let mut out = [[Wide::zero(); 3]; 3];
    for i in 0..3 {
        for j in 0..3 {
            out[i][j] = a[i][0] * b[0][j] + a[i][1] * b[1][j] + a[i][2] * b[2][j];
        }
    }
    out
}

/// `m v`
#[inline(always)]
pub(super) fn apply<T: Real>(m: &Matrix<T>, v: &Vector<T>) -> Vector<T> {
    [dot(&m[0], v), dot(&m[1], v), dot(&m[2], v)]
}

/// A symmetric matrix from its entries xx, yy, zz, yz, xz, xy.
#[inline(always)]
pub(super) fn symmetric<T: Real>(entries: &[Wide<f64>; 6]) -> Matrix<T> {
    let [xx, yy, zz, yz, xz, xy] = entries.map(|entry| entry.cast());
    [[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]]
}
