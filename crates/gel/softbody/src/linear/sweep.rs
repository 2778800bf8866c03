//! Sweeps of block Gauss–Seidel on `H = L + Δ + Lᵀ`, and the step of conjugate gradients that is
//! done along with them.
//!
//! A backward sweep that ends in `z` leaves the residual `-L c`, where `c` is the change that it
//! made to each row: at its turn a row is solved, and only the rows before it change after that.
//! Therefore `H z = r + L c` can be summed by the next forward sweep, which reads `L` anyway, and
//! `zᵀ H z = zᵀ r + cᵀ Lᵀ z` is known before. An iteration thus reads the matrix twice, not three
//! times (after Eisenstat, SIAM J. Sci. Stat. Comput. 2, 1981, who had no coarse system between the
//! sweeps).

use std::ops::Range;

use pulp::NullaryFnOnce;

use super::block::{Sum, Vector};
use super::matrix::{Matrix, Pattern};
use crate::parallel::{dispatch, join_halves};

/// Vectors of the iteration; `[n_free]`.
pub(crate) struct Vectors {
    /// The residual of the solution so far.
    pub(crate) residual: Vec<Vector>,
    /// The solution so far.
    pub(crate) solution: Vec<Vector>,
    /// The last direction along which the solution moved, and its product with `H`.
    pub(crate) direction: Vec<Vector>,
    product: Vec<Vector>,
    /// The preconditioned residual, and its change by the backward sweep.
    pub(crate) preconditioned: Vec<Vector>,
    change: Vec<Vector>,
    /// After a forward sweep the defect; after a backward sweep the part of `A z` above the
    /// diagonal.
    pub(crate) defect: Vec<Vector>,
}

/// A step of conjugate gradients: its length, and the share of the old direction in the new one.
#[derive(Clone, Copy, Default)]
pub(crate) struct Step {
    pub(crate) length: f32,
    pub(crate) ratio: f32,
}

/// `zᵀ r`, and the parts of `zᵀ H z - zᵀ r`: that of `A`, and that of the volumes, which is
/// subtracted.
#[derive(Clone, Copy, Default)]
pub(crate) struct Squares {
    pub(crate) residual: f64,
    pub(crate) above: f64,
    pub(crate) volumes: f64,
}

impl Vectors {
    pub(crate) fn new(n_free: usize) -> Self {
        let zeros = || vec![Vector::ZERO; n_free];
        Self {
            residual: zeros(),
            solution: zeros(),
            direction: zeros(),
            product: zeros(),
            preconditioned: zeros(),
            change: zeros(),
            defect: zeros(),
        }
    }

    /// Starts again with the given residual.
    pub(crate) fn restart(&mut self) {
        for vector in [
            &mut self.solution,
            &mut self.direction,
            &mut self.product,
            &mut self.preconditioned,
            &mut self.change,
        ] {
            vector.fill(Vector::ZERO);
        }
    }

    /// Does a step that updates the direction and the solution only.
    pub(crate) fn finish(&mut self, step: Step) {
        let rows = self.solution.iter_mut().zip(&mut self.direction);
        for ((solution, direction), z) in rows.zip(&self.preconditioned) {
            *direction = z.plus_scaled(*direction, step.ratio);
            *solution = solution.plus_scaled(*direction, step.length);
        }
    }

    fn part<'a>(&'a mut self, volumes: &'a mut [f32], moved_volumes: &'a mut [f32]) -> Part<'a> {
        Part {
            first: 0,
            residual: &mut self.residual,
            solution: &mut self.solution,
            direction: &mut self.direction,
            product: &mut self.product,
            x: &mut self.preconditioned,
            change: &mut self.change,
            other: &mut self.defect,
            first_volume: 0,
            volumes,
            moved_volumes,
        }
    }
}

/// Rows of all vectors, and volumes, from the indices `first` and `first_volume` on.
struct Part<'a> {
    first: usize,
    residual: &'a mut [Vector],
    solution: &'a mut [Vector],
    direction: &'a mut [Vector],
    product: &'a mut [Vector],
    x: &'a mut [Vector],
    change: &'a mut [Vector],
    other: &'a mut [Vector],
    first_volume: usize,
    volumes: &'a mut [f32],
    moved_volumes: &'a mut [f32],
}

impl<'a> Part<'a> {
    fn split(self, row: usize, volume: usize) -> [Part<'a>; 2] {
        let residual = self.residual.split_at_mut(row);
        let solution = self.solution.split_at_mut(row);
        let direction = self.direction.split_at_mut(row);
        let product = self.product.split_at_mut(row);
        let x = self.x.split_at_mut(row);
        let change = self.change.split_at_mut(row);
        let other = self.other.split_at_mut(row);
        let volumes = self.volumes.split_at_mut(volume);
        let moved_volumes = self
            .moved_volumes
            .split_at_mut(volume.min(self.moved_volumes.len()));
        [
            Part {
                first: 0,
                residual: residual.0,
                solution: solution.0,
                direction: direction.0,
                product: product.0,
                x: x.0,
                change: change.0,
                other: other.0,
                first_volume: 0,
                volumes: volumes.0,
                moved_volumes: moved_volumes.0,
            },
            Part {
                first: row,
                residual: residual.1,
                solution: solution.1,
                direction: direction.1,
                product: product.1,
                x: x.1,
                change: change.1,
                other: other.1,
                first_volume: volume,
                volumes: volumes.1,
                moved_volumes: moved_volumes.1,
            },
        ]
    }
}

impl Matrix {
    /// Does a step of conjugate gradients, and sweeps from zero for the residual after it. Computes
    /// `√D Bᵀ x`, and the defect without the part of the volumes. `moved_volumes` is scratch
    /// memory.
    pub(crate) fn sweep_forward(
        &self,
        pattern: &Pattern,
        step: Step,
        vectors: &mut Vectors,
        volumes: &mut [f32],
        moved_volumes: &mut [f32],
    ) {
        volumes.fill(0.0);
        moved_volumes.fill(0.0);
        let halves = pattern.halves;
        let rows = |rows, part: Part| {
            dispatch(Forward {
                pattern,
                matrix: self,
                step,
                rows,
                part,
            });
        };
        let [first, second] = vectors
            .part(volumes, moved_volumes)
            .split(halves.first, halves.coarse);
        join_halves(
            || rows(0..halves.first, first),
            || rows(halves.first..halves.both, second),
        );
        rows(halves.both..halves.free, vectors.part(volumes, moved_volumes));
    }

    /// Sweeps backward, from `x` and its `√D Bᵀ x`.
    pub(crate) fn sweep_backward(
        &self,
        pattern: &Pattern,
        vectors: &mut Vectors,
        volumes: &mut [f32],
    ) -> Squares {
        let halves = pattern.halves;
        vectors.defect.fill(Vector::ZERO);
        let rows = |rows, part: Part| {
            dispatch(Backward {
                pattern,
                matrix: self,
                rows,
                part,
            })
        };
        let between = rows(halves.both..halves.free, vectors.part(volumes, &mut []));
        let [first, second] = vectors.part(volumes, &mut []).split(halves.first, halves.coarse);
        let (first, second) = join_halves(
            || rows(0..halves.first, first),
            || rows(halves.first..halves.both, second),
        );
        let mut sum = between;
        for part in [first, second] {
            sum.residual += part.residual;
            sum.above += part.above;
            sum.volumes += part.volumes;
        }
        sum
    }
}

struct Forward<'a> {
    pattern: &'a Pattern,
    matrix: &'a Matrix,
    step: Step,
    rows: Range<usize>,
    part: Part<'a>,
}

impl NullaryFnOnce for Forward<'_> {
    type Output = ();

    #[inline(always)]
    fn call(self) {
        let (pattern, matrix, part) = (self.pattern, self.matrix, self.part);
        let Step { length, ratio } = self.step;
        for row in self.rows {
            let here = row - part.first;
            let range = pattern.blocks_of(row);
            let (blocks, columns) = (&matrix.blocks[range.clone()], &pattern.columns[range]);
            let (mut below, mut moved) = (Sum::default(), Sum::default());
            for (block, column) in blocks.iter().zip(columns) {
                let column = *column as usize - part.first;
                below.add(block, &part.x[column]);
                moved.add(block, &part.change[column]);
            }
            let range = pattern.slopes_of(row);
            let (slopes, corners) = (&matrix.slopes[range.clone()], &pattern.slope_columns[range]);
            let mut squeezed = Sum::default();
            for (slope, corner) in slopes.iter().zip(corners) {
                let corner = *corner as usize - part.first_volume;
                squeezed.add_scaled(slope, part.volumes[corner]);
                moved.add_scaled(slope, part.moved_volumes[corner]);
            }
            let direction = part.x[here].plus_scaled(part.direction[here], ratio);
            part.direction[here] = direction;
            part.solution[here] = part.solution[here].plus_scaled(direction, length);
            let product = part.residual[here]
                .plus_scaled(moved.total(), 1.0)
                .plus_scaled(part.product[here], ratio);
            part.product[here] = product;
            let residual = part.residual[here].plus_scaled(product, -length);
            part.residual[here] = residual;

            let known = below.taken_from(&residual);
            let x = matrix.inverse[row].times(&squeezed.taken_from(&known));
            part.x[here] = x;
            let own = matrix.own[row].times(&x);
            part.other[here] = known.plus_scaled(own, -1.0);
            for (block, column) in blocks.iter().zip(columns) {
                let defect = &mut part.other[*column as usize - part.first];
                *defect = defect.plus_scaled(block.transpose_product(&x), -1.0);
            }
            let change = part.change[here];
            for (slope, corner) in slopes.iter().zip(corners) {
                let corner = *corner as usize - part.first_volume;
                part.volumes[corner] += slope.dot(&x);
                part.moved_volumes[corner] += slope.dot(&change);
            }
        }
    }
}

struct Backward<'a> {
    pattern: &'a Pattern,
    matrix: &'a Matrix,
    rows: Range<usize>,
    part: Part<'a>,
}

impl NullaryFnOnce for Backward<'_> {
    type Output = Squares;

    #[inline(always)]
    fn call(self) -> Squares {
        let (pattern, matrix, part) = (self.pattern, self.matrix, self.part);
        let mut squares = Squares::default();
        for row in self.rows.rev() {
            let here = row - part.first;
            let range = pattern.blocks_of(row);
            let (blocks, columns) = (&matrix.blocks[range.clone()], &pattern.columns[range]);
            let mut below = Sum::default();
            for (block, column) in blocks.iter().zip(columns) {
                below.add(block, &part.x[*column as usize - part.first]);
            }
            let range = pattern.slopes_of(row);
            let (slopes, corners) = (&matrix.slopes[range.clone()], &pattern.slope_columns[range]);
            let mut squeezed = Sum::default();
            for (slope, corner) in slopes.iter().zip(corners) {
                squeezed.add_scaled(slope, part.volumes[*corner as usize - part.first_volume]);
            }
            let squeezed = squeezed.total();
            let old = part.x[here];
            below.add(&matrix.own[row], &old);
            let above = part.other[here];
            let known = part.residual[here]
                .plus_scaled(above, -1.0)
                .plus_scaled(squeezed, -1.0);
            let left = below.taken_from(&known);
            let change = matrix.inverse[row].times(&left);
            let x = old.plus_scaled(change, 1.0);
            part.x[here] = x;
            part.change[here] = change;
            for (block, column) in blocks.iter().zip(columns) {
                let above = &mut part.other[*column as usize - part.first];
                *above = above.plus_scaled(block.transpose_product(&x), 1.0);
            }
            for (slope, corner) in slopes.iter().zip(corners) {
                part.volumes[*corner as usize - part.first_volume] += slope.dot(&change);
            }
            squares.residual += f64::from(part.residual[here].dot(&x));
            squares.above += f64::from(change.dot(&above));
            // `B p` after the row has changed: larger by `Δ` minus the block of `A`.
            let own = matrix.own[row].times(&change);
            let squeezed = squeezed.plus_scaled(left, 1.0).plus_scaled(own, -1.0);
            squares.volumes += f64::from(squeezed.dot(&x));
        }
        squares
    }
}
