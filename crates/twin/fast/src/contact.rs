//! The contact geometry as network inputs: how far each point of the grids lies inside a body, or
//! how close to one.
//!
//! The value at a distance `d` is the proximity `(reach - d) / reach`, at least 0: 0 at the reach
//! and beyond, 1 at the body's surface, more inside.

use std::ops::Range;

use glam::{Mat3, Vec3, Vec3A};
use pulp::{Simd, WithSimd};
use twintac_shape::Pose;

use crate::columns::{AROUND, Columns, Standing};
use crate::distance::{Body, Field, Form, REACH_MM, Upward};
use crate::simd::dispatch;
use crate::surface::{BASE_MM, SurfaceGrid};

/// Heights relative to the undeformed surface at which distances are evaluated, mm. The deeper ones
/// show how deep a narrow body presses. They scale with the spacing of the points where it is
/// larger than [`SPACING_MM`].
const LEVELS_MM: [f32; N_CHANNELS] = [0.0, -1.5, -3.0];

/// Largest depth inside a body that the network sees, mm; it scales with the spacing likewise.
const DEEPEST_MM: f32 = 4.0;

/// Spacing of the points for which both constants hold, mm.
const SPACING_MM: f32 = 2.0;

/// Gaps to the nearest point, in grid spacings: up to the first a body may touch between the
/// points, beyond the second it does not. An end with a radius of 2.5 mm that touches in the middle
/// of four points of PhysTac's grid has a gap of a fifth of the spacing to them.
pub(crate) const TOUCHED: [f32; 2] = [0.05, 0.25];

/// Number of heights, thus of values at each point.
pub(crate) const N_CHANNELS: usize = 3;

/// Heights relative to the undeformed surface at which distances are evaluated for points of this
/// spacing, mm.
pub(crate) fn levels_mm(spacing_mm: f32) -> [f32; N_CHANNELS] {
    let scale = (spacing_mm / SPACING_MM).max(1.0);
    LEVELS_MM.map(|level_mm| scale * level_mm)
}

/// The points of all grids, one grid after the other.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct ContactPoints {
    grids: Vec<ContactGrid>,
    n_inputs: usize,
}

/// The points of a grid in single precision.
#[derive(Clone, Debug, PartialEq)]
struct ContactGrid {
    first_mm: [f32; 2],
    spacing_mm: f32,
    n: [usize; 2],
    height_mm: Vec<f32>,
    /// Height of the highest point.
    highest_mm: f32,
    levels_mm: [f32; N_CHANNELS],
    deepest_mm: f32,
}

impl ContactPoints {
    pub(crate) fn new(grids: &[SurfaceGrid]) -> Self {
        Self {
            grids: grids.iter().map(ContactGrid::new).collect(),
            n_inputs: N_CHANNELS * grids.iter().map(SurfaceGrid::len).sum::<usize>(),
        }
    }

    /// Number of values that [`Self::fill`] writes.
    pub(crate) fn n_inputs(&self) -> usize {
        self.n_inputs
    }

    /// Proximity of the point that is nearest to a body: 1 at the body's surface, 0 where it is the
    /// reach away or farther.
    pub(crate) fn nearest(&self, inputs: &[f32]) -> f32 {
        let of_points = inputs.iter().step_by(N_CHANNELS);
        of_points.fold(0.0, |most: f32, own| most.max(*own))
    }

    /// Whether something touches, from the proximity of the nearest point: 1 where this point lies
    /// inside or nearly so, 0 where it lies so far outside that the body does not reach into the
    /// gel between the points either.
    pub(crate) fn touched(&self, nearest: f32) -> f32 {
        let gap_mm = REACH_MM * (1.0 - nearest);
        let [near_mm, far_mm] = TOUCHED.map(|part| part * self.grids[0].spacing_mm);
        ((far_mm - gap_mm) / (far_mm - near_mm)).clamp(0.0, 1.0)
    }

    /// Writes the proximity of the bodies at each point and level. `[n_points * N_CHANNELS]`
    pub(crate) fn fill<'a>(
        &self,
        bodies: impl Iterator<Item = (&'a Body, Pose)> + Clone,
        inputs: &mut [f32],
    ) {
        dispatch(Filling {
            points: self,
            bodies,
            inputs,
        });
    }
}

impl ContactGrid {
    fn new(grid: &SurfaceGrid) -> Self {
        let height_mm: Vec<f32> = grid.height_mm.iter().map(|height| *height as f32).collect();
        let highest_mm = height_mm.iter().copied().fold(f32::NEG_INFINITY, f32::max);
        let scale = (grid.spacing_mm as f32 / SPACING_MM).max(1.0);
        Self {
            first_mm: grid.first_mm.map(|first| first as f32),
            spacing_mm: grid.spacing_mm as f32,
            n: grid.n,
            highest_mm,
            levels_mm: levels_mm(grid.spacing_mm as f32),
            deepest_mm: scale * DEEPEST_MM,
            height_mm,
        }
    }

    #[inline(always)]
    fn add(&self, body: &Body, gel_from_body: &Pose, inputs: &mut [f32]) {
        let (position_mm, rotation) = (gel_from_body.position_mm, gel_from_body.rotation);
        // A pose that is not finite would give the result of no contact.
        assert!(
            position_mm.is_finite() && rotation.is_finite(),
            "a pose of finite numbers"
        );
        let rotation = rotation.as_quat();
        let body_from_gel = Mat3::from_quat(rotation.inverse());
        let origin = position_mm.as_vec3();
        let [low, high] = box_in_gel(body, &Mat3::from_quat(rotation), origin);
        if low.z > self.highest_mm {
            return;
        }
        let upward = Upward::new(body_from_gel.z_axis.into());
        // A body that is less deep than half of its thickness has its top far from all points.
        let is_open = body.is_thin(self.highest_mm - low.z - REACH_MM, upward);
        let [n_x, n_y] = self.n;
        let range = |axis: usize| {
            let cells = |mm: f32| (mm - self.first_mm[axis]) / self.spacing_mm;
            let from = cells(low[axis]).ceil().max(0.0) as usize;
            let to = (cells(high[axis]).floor() + 1.0).clamp(0.0, self.n[axis] as f32) as usize;
            from.min(to)..to
        };
        let (columns, rows) = (range(0), range(1));
        debug_assert!(columns.end <= n_x && rows.end <= n_y);
        let placed = Placed {
            body_from_gel,
            origin,
            columns,
            rows,
            reaches_base: low.z + REACH_MM < BASE_MM,
        };
        match (&body.form, is_open) {
            (Form::Ball(ball), false) => self.add_placed(&placed, inputs, ball),
            (Form::Box(rounded), false) => self.add_placed(&placed, inputs, rounded),
            (Form::Cylinder(rounded), false) => self.add_placed(&placed, inputs, rounded),
            (Form::Ball(ball), true) => self.add_placed(&placed, inputs, &ball.open(upward)),
            (Form::Box(rounded), true) => self.add_placed(&placed, inputs, &rounded.open(upward)),
            (Form::Cylinder(rounded), true) => self.add_placed(&placed, inputs, &rounded.open(upward)),
            (Form::Sampled(samples), false) => self.add_placed(&placed, inputs, samples),
            (Form::Sampled(_), true) => {
                let standing = Standing::new(body, body_from_gel, origin, low.z + REACH_MM);
                self.add_columns(&placed.columns, &placed.rows, &standing, inputs);
            }
        }
    }

    /// Adds a thin sampled body at the points within its box.
    fn add_columns(
        &self,
        columns: &Range<usize>,
        rows: &Range<usize>,
        standing: &Standing<'_>,
        inputs: &mut [f32],
    ) {
        let around = |range: &Range<usize>| range.start as i32 - AROUND..range.end as i32 + AROUND;
        let all = Columns {
            first_mm: self.first_mm,
            spacing_mm: self.spacing_mm,
            columns: around(columns),
            rows: around(rows),
        };
        let [n_x, n_y] = self.n.map(|n| n as i32);
        let levels_mm = |[i, j]: [i32; 2]| {
            let point = j.clamp(0, n_y - 1) * n_x + i.clamp(0, n_x - 1);
            self.levels_mm
                .map(|level_mm| self.height_mm[point as usize] + level_mm)
        };
        let inputs = inputs.as_chunks_mut::<N_CHANNELS>().0;
        all.open(standing, levels_mm, |[i, j], distances_mm| {
            if (0..n_x).contains(&i) && (0..n_y).contains(&j) {
                let point = &mut inputs[(j * n_x + i) as usize];
                for (input, distance_mm) in point.iter_mut().zip(distances_mm) {
                    *input = larger(*input, share(larger(distance_mm, -self.deepest_mm)));
                }
            }
        });
    }

    /// Adds a body at the points within its box.
    #[inline(always)]
    fn add_placed(&self, placed: &Placed, inputs: &mut [f32], field: &impl Field) {
        let n_x = self.n[0];
        let [along, across, up] = [
            placed.body_from_gel.x_axis,
            placed.body_from_gel.y_axis,
            placed.body_from_gel.z_axis,
        ]
        .map(Vec3A::from);
        let (levels_mm, least_mm) = (self.levels_mm, -self.deepest_mm);
        let inputs = inputs.as_chunks_mut::<N_CHANNELS>().0;
        for j in placed.rows.clone() {
            let row = across * (self.first_mm[1] + self.spacing_mm * j as f32 - placed.origin.y);
            let points = j * n_x + placed.columns.start..j * n_x + placed.columns.end;
            let heights_mm = &self.height_mm[points.clone()];
            for ((i, height_mm), input) in placed.columns.clone().zip(heights_mm).zip(&mut inputs[points]) {
                let x_mm = self.first_mm[0] + self.spacing_mm * i as f32 - placed.origin.x;
                let (plane, z_mm) = (along * x_mm + row, height_mm - placed.origin.z);
                // What is below the base has not come through the gel: it is behind the sensor.
                if placed.reaches_base && field.is_below(plane + up * (BASE_MM - placed.origin.z)) {
                    continue;
                }
                for (level, (input, level_mm)) in input.iter_mut().zip(levels_mm).enumerate() {
                    let distance_mm = field.distance_mm(plane + up * (z_mm + level_mm));
                    let share = share(larger(distance_mm, least_mm));
                    // A body whose surface point is out of reach is out of reach at the deeper
                    // levels too.
                    if level == 0 && share == 0.0 {
                        break;
                    }
                    *input = larger(*input, share);
                }
            }
        }
    }
}

/// The box in the gel's frame that holds all points within reach of a body, mm.
pub(crate) fn box_in_gel(body: &Body, gel_from_body: &Mat3, origin: Vec3) -> [Vec3; 2] {
    let [low, high] = body.bounds_mm;
    let middle = *gel_from_body * (0.5 * (low + high)) + origin;
    let half = 0.5 * (high - low);
    let abs = Mat3::from_cols(
        gel_from_body.x_axis.abs(),
        gel_from_body.y_axis.abs(),
        gel_from_body.z_axis.abs(),
    );
    let around = abs * half + Vec3::splat(REACH_MM);
    [middle - around, middle + around]
}

/// [`ContactPoints::fill`], compiled for each instruction set.
struct Filling<'a, B> {
    points: &'a ContactPoints,
    bodies: B,
    inputs: &'a mut [f32],
}

impl<'b, B: Iterator<Item = (&'b Body, Pose)> + Clone> WithSimd for Filling<'_, B> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, _: S) {
        self.inputs.fill(0.0);
        let mut rest = self.inputs;
        for grid in &self.points.grids {
            let (inputs, behind) = rest.split_at_mut(N_CHANNELS * grid.height_mm.len());
            for (body, gel_from_body) in self.bodies.clone() {
                grid.add(body, &gel_from_body, inputs);
            }
            rest = behind;
        }
    }
}

/// The proximity at a distance.
#[inline(always)]
fn share(distance_mm: f32) -> f32 {
    larger((REACH_MM - distance_mm) * (1.0 / REACH_MM), 0.0)
}

/// The larger of two numbers in one instruction; `f32::max` also checks for NaN.
#[inline(always)]
fn larger(a: f32, b: f32) -> f32 {
    if a > b { a } else { b }
}

/// A body in the gel's frame, and the points of the grid within its box.
struct Placed {
    body_from_gel: Mat3,
    origin: Vec3,
    columns: Range<usize>,
    rows: Range<usize>,
    /// Whether a part of the body is below the base of the gel.
    reaches_base: bool,
}
