//! Vectors of three and blocks of 3 × 3 numbers, padded with a fourth row of zeros to fit the
//! vector registers of the processor.

use glam::{DVec3, Mat3, Vec3};

use crate::wide::PlusProduct;

/// A vector.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[repr(C, align(16))]
pub(crate) struct Vector(pub(crate) [f32; 4]);

/// A matrix, column by column.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[repr(C, align(16))]
pub(crate) struct Block(pub(crate) [[f32; 4]; 3]);

/// A sum of products of blocks and vectors, in three parts, one for each column, so that no
/// addition has to wait for another.
#[derive(Clone, Copy, Default)]
pub(crate) struct Sum([[f32; 4]; 3]);

impl Vector {
    pub(crate) const ZERO: Self = Self([0.0; 4]);

    pub(crate) fn from_dvec3(v: DVec3) -> Self {
        Self([v.x as f32, v.y as f32, v.z as f32, 0.0])
    }

    pub(crate) fn to_dvec3(self) -> DVec3 {
        Vec3::new(self.0[0], self.0[1], self.0[2]).as_dvec3()
    }

    /// `self + a v`
    #[inline(always)]
    pub(crate) fn plus_scaled(mut self, v: Self, a: f32) -> Self {
        for i in 0..4 {
            self.0[i] += a * v.0[i];
        }
        self
    }

    #[inline(always)]
    pub(crate) fn dot(&self, other: &Self) -> f32 {
        let [a, b, c, d]: [f32; 4] = std::array::from_fn(|i| self.0[i] * other.0[i]);
        (a + b) + (c + d)
    }
}

impl Block {
    pub(crate) fn diagonal(value: f32) -> Self {
        Self::from_mat3(&Mat3::from_diagonal(Vec3::splat(value)))
    }

    pub(crate) fn from_mat3(m: &Mat3) -> Self {
        Self([m.x_axis, m.y_axis, m.z_axis].map(|column| [column.x, column.y, column.z, 0.0]))
    }

    #[inline(always)]
    pub(crate) fn times(&self, x: &Vector) -> Vector {
        let mut sum = Sum::default();
        sum.add(self, x);
        sum.total()
    }

    /// The product of the transposed block and a vector.
    #[inline(always)]
    pub(crate) fn transpose_product(&self, x: &Vector) -> Vector {
        let [a, b, c] = self.0;
        let row = |i: usize| [a[i], b[i], c[i], 0.0];
        let rows = [row(0), row(1), row(2)];
        let mut out = [0.0; 4];
        for i in 0..4 {
            out[i] = rows[0][i] * x.0[0];
        }
        for k in 1..3 {
            for i in 0..4 {
                out[i] = out[i].plus_product(rows[k][i], x.0[k]);
            }
        }
        Vector(out)
    }

    #[inline(always)]
    pub(crate) fn add(&mut self, other: &Self) {
        for j in 0..3 {
            for i in 0..4 {
                self.0[j][i] += other.0[j][i];
            }
        }
    }

    /// Adds `v⊗v`.
    #[inline(always)]
    pub(crate) fn add_square(&mut self, v: &Vector) {
        for j in 0..3 {
            for i in 0..4 {
                self.0[j][i] += v.0[j] * v.0[i];
            }
        }
    }

    /// The inverse of a symmetric positive definite matrix; for any other matrix, that of a
    /// multiple of the identity of the same size.
    #[inline(always)]
    pub(crate) fn inverse(&self) -> Self {
        let [[a, b, c, _], [_, d, e, _], [_, _, f, _]] = self.0;
        let (x, y, z) = (d * f - e * e, c * e - b * f, b * e - c * d);
        let determinant = a * x + b * y + c * z;
        let mean = (a + d + f) / 3.0;
        if a > 0.0 && a * d - b * b > 0.0 && determinant > 1e-6 * mean * mean * mean {
            let scale = 1.0 / determinant;
            let (p, q, r) = (a * f - c * c, b * c - a * e, a * d - b * b);
            let row = |x: f32, y: f32, z: f32| [x * scale, y * scale, z * scale, 0.0];
            Self([row(x, y, z), row(y, p, q), row(z, q, r)])
        } else {
            Self::diagonal(1.0 / (3.0 * mean.abs()).max(1e-12))
        }
    }
}

impl Sum {
    /// Adds `block x`.
    #[inline(always)]
    pub(crate) fn add(&mut self, block: &Block, x: &Vector) {
        for j in 0..3 {
            for i in 0..4 {
                self.0[j][i] = self.0[j][i].plus_product(block.0[j][i], x.0[j]);
            }
        }
    }

    /// Adds `a v`.
    #[inline(always)]
    pub(crate) fn add_scaled(&mut self, v: &Vector, a: f32) {
        for i in 0..4 {
            self.0[0][i] = self.0[0][i].plus_product(v.0[i], a);
        }
    }

    /// `start - self`
    #[inline(always)]
    pub(crate) fn taken_from(&self, start: &Vector) -> Vector {
        Vector(std::array::from_fn(|i| {
            start.0[i] - ((self.0[0][i] + self.0[1][i]) + self.0[2][i])
        }))
    }

    /// The sum of the three parts.
    #[inline(always)]
    pub(crate) fn total(&self) -> Vector {
        Vector(std::array::from_fn(|i| {
            (self.0[0][i] + self.0[1][i]) + self.0[2][i]
        }))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_inverse_undoes_its_block() {
        let m = Mat3::from_cols_array(&[4.0, 1.0, 0.5, 1.0, 3.0, -0.2, 0.5, -0.2, 2.0]);
        let expected = Block::from_mat3(&m.inverse());
        let found = Block::from_mat3(&m).inverse();
        for (found, expected) in found.0.as_flattened().iter().zip(expected.0.as_flattened()) {
            assert!((found - expected).abs() < 1e-6);
        }
        assert_eq!(Block::from_mat3(&-m).inverse().0[1][1], 1.0 / 9.0);
    }
}
