//! What the gel is touched by: for each point of the grid, how far inside a body it lies, or how close to one.

use glam::{Mat3, Vec3};
use pulp::{Arch, Simd, WithSimd};
use twintac_shape::Pose;

use crate::distance::{Body, Form, REACH_MM};
use crate::surface::SurfaceGrid;

/// Heights above the undeformed surface at which distances are taken, mm: the deeper ones tell how deep a narrow body presses.
const LEVELS_MM: [f32; 3] = [0.0, -1.5, -3.0];

/// Deeper points are no deeper to the network, mm.
const DEEPEST_MM: f32 = 4.0;

/// Numbers for each point.
pub(crate) const N_CHANNELS: usize = LEVELS_MM.len();

/// The points of the grid in single precision.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct ContactGrid {
    first_mm: [f32; 2],
    spacing_mm: f32,
    n: [usize; 2],
    height_mm: Vec<f32>,
    /// Lowest and highest of the points.
    heights_mm: [f32; 2],
}

impl ContactGrid {
    pub(crate) fn new(grid: &SurfaceGrid) -> Self {
        let height_mm: Vec<f32> = grid.height_mm.iter().map(|height| *height as f32).collect();
        Self {
            first_mm: grid.first_mm.map(|first| first as f32),
            spacing_mm: grid.spacing_mm as f32,
            n: grid.n,
            heights_mm: [
                height_mm.iter().copied().fold(f32::INFINITY, f32::min),
                height_mm.iter().copied().fold(f32::NEG_INFINITY, f32::max),
            ],
            height_mm,
        }
    }

    /// Numbers that [`Self::fill`] writes.
    pub(crate) fn n_inputs(&self) -> usize {
        N_CHANNELS * self.height_mm.len()
    }

    /// Writes, point by point and level by level, how much of the reach around a body is left, in units of the reach: 0 far away, 1 at its
    /// surface, more inside. `[n_points * N_CHANNELS]`
    pub(crate) fn fill<'a>(&self, bodies: impl Iterator<Item = (&'a Body, Pose)>, inputs: &mut [f32]) {
        Arch::new().dispatch(Filling {
            grid: self,
            bodies,
            inputs,
        });
    }

    #[inline(always)]
    fn add(&self, body: &Body, gel_from_body: &Pose, inputs: &mut [f32]) {
        let (position_mm, rotation) = (gel_from_body.position_mm, gel_from_body.rotation);
        // It would read as if nothing touched.
        assert!(
            position_mm.is_finite() && rotation.is_finite(),
            "a pose of finite numbers"
        );
        let rotation = rotation.as_quat();
        let body_from_gel = Mat3::from_quat(rotation.inverse());
        let origin = position_mm.as_vec3();
        let [low, high] = self.box_in_gel(body, &Mat3::from_quat(rotation), origin);
        if low.z > self.heights_mm[1] {
            return;
        }
        let [n_x, n_y] = self.n;
        let range = |axis: usize| {
            let cells = |mm: f32| (mm - self.first_mm[axis]) / self.spacing_mm;
            let from = cells(low[axis]).ceil().max(0.0) as usize;
            let to = (cells(high[axis]).floor() + 1.0).clamp(0.0, self.n[axis] as f32) as usize;
            from.min(to)..to
        };
        let (columns, rows) = (range(0), range(1));
        debug_assert!(columns.end <= n_x && rows.end <= n_y);
        for j in rows {
            let y_mm = self.first_mm[1] + self.spacing_mm * j as f32;
            for i in columns.clone() {
                let x_mm = self.first_mm[0] + self.spacing_mm * i as f32;
                let point = j * n_x + i;
                let at = body_from_gel * (Vec3::new(x_mm, y_mm, self.height_mm[point]) - origin);
                let inputs = &mut inputs[point * N_CHANNELS..(point + 1) * N_CHANNELS];
                for (level_mm, input) in LEVELS_MM.iter().zip(inputs) {
                    let distance_mm = body.distance_mm(at + *level_mm * body_from_gel.z_axis);
                    *input = input.max((REACH_MM - distance_mm.max(-DEEPEST_MM)) * (1.0 / REACH_MM));
                }
            }
        }
    }

    /// The box in the gel's frame that holds all points within reach of a body, mm.
    fn box_in_gel(&self, body: &Body, gel_from_body: &Mat3, origin: Vec3) -> [Vec3; 2] {
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
}

/// [`ContactGrid::fill`], compiled for each instruction set.
struct Filling<'a, B> {
    grid: &'a ContactGrid,
    bodies: B,
    inputs: &'a mut [f32],
}

impl<'b, B: Iterator<Item = (&'b Body, Pose)>> WithSimd for Filling<'_, B> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, _: S) {
        self.inputs.fill(0.0);
        for (body, gel_from_body) in self.bodies {
            self.grid.add(body, &gel_from_body, self.inputs);
        }
    }
}

impl Body {
    /// Distance at a point of the body's own frame, mm; never much more than [`REACH_MM`] has to be right.
    #[inline(always)]
    fn distance_mm(&self, point: Vec3) -> f32 {
        match &self.form {
            Form::Ball { radius_mm } => (point - Vec3::Z * *radius_mm).length() - radius_mm,
            Form::Sampled(samples) => samples.distance_mm(point),
        }
    }
}
