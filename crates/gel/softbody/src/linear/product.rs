//! Products of the system with a vector.

use std::ops::Range;

use pulp::NullaryFnOnce;

use super::block::{Sum, Vector};
use super::matrix::{Matrix, Pattern};
use crate::parallel::{dispatch, join_halves};

impl Matrix {
    /// `√D Bᵀ x`.
    pub(crate) fn volumes(&self, pattern: &Pattern, x: &[Vector], volumes: &mut [f32]) {
        let halves = pattern.halves;
        volumes.fill(0.0);
        let (low, high) = volumes.split_at_mut(halves.coarse);
        let add = |rows, first, volumes: &mut [f32]| {
            dispatch(Volumes {
                pattern,
                matrix: self,
                rows,
                x,
                first,
                volumes,
            });
        };
        join_halves(
            || add(0..halves.first, 0, low),
            || add(halves.first..halves.both, halves.coarse, high),
        );
        add(halves.both..halves.free, 0, volumes);
    }

    /// Subtracts `B D Bᵀ x` from a vector, given `√D Bᵀ x`.
    pub(crate) fn take_volumes(&self, pattern: &Pattern, volumes: &[f32], from: &mut [Vector]) {
        let half = pattern.halves.free / 2;
        let (first, second) = from.split_at_mut(half);
        let run = |first, from| {
            dispatch(VolumesTaken {
                pattern,
                matrix: self,
                volumes,
                first,
                from,
            });
        };
        join_halves(|| run(0, first), || run(half, second));
    }

    /// `H x`.
    pub(crate) fn product(&self, pattern: &Pattern, x: &[Vector]) -> Vec<Vector> {
        let mut volumes = vec![0.0; pattern.n_coarse()];
        self.volumes(pattern, x, &mut volumes);
        let mut y = vec![Vector::ZERO; x.len()];
        for (row, from) in x.iter().enumerate() {
            let mut sum = Sum::default();
            sum.add(&self.own[row], from);
            for at in pattern.blocks_of(row) {
                let (block, column) = (&self.blocks[at], pattern.columns[at] as usize);
                sum.add(block, &x[column]);
                y[column] = y[column].plus_scaled(block.transpose_product(from), 1.0);
            }
            for at in pattern.slopes_of(row) {
                sum.add_scaled(&self.slopes[at], volumes[pattern.slope_columns[at] as usize]);
            }
            y[row] = y[row].plus_scaled(sum.total(), 1.0);
        }
        y
    }
}

struct Volumes<'a> {
    pattern: &'a Pattern,
    matrix: &'a Matrix,
    rows: Range<usize>,
    x: &'a [Vector],
    first: usize,
    volumes: &'a mut [f32],
}

impl NullaryFnOnce for Volumes<'_> {
    type Output = ();

    #[inline(always)]
    fn call(self) {
        for row in self.rows {
            let range = self.pattern.slopes_of(row);
            let slopes = &self.matrix.slopes[range.clone()];
            for (slope, column) in slopes.iter().zip(&self.pattern.slope_columns[range]) {
                self.volumes[*column as usize - self.first] += slope.dot(&self.x[row]);
            }
        }
    }
}

struct VolumesTaken<'a> {
    pattern: &'a Pattern,
    matrix: &'a Matrix,
    volumes: &'a [f32],
    first: usize,
    from: &'a mut [Vector],
}

impl NullaryFnOnce for VolumesTaken<'_> {
    type Output = ();

    #[inline(always)]
    fn call(self) {
        for (row, from) in (self.first..).zip(self.from) {
            let range = self.pattern.slopes_of(row);
            let slopes = &self.matrix.slopes[range.clone()];
            let mut sum = Sum::default();
            for (slope, column) in slopes.iter().zip(&self.pattern.slope_columns[range]) {
                sum.add_scaled(slope, self.volumes[*column as usize]);
            }
            *from = sum.taken_from(from);
        }
    }
}
