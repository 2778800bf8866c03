//! Distances to a rigid shape, fast enough to ask for hundreds of them in a microsecond.

use glam::{DVec3, Vec3};
use twintac_shape::{Shape, ShapeError, SignedDistance, Surfaces};

/// Distance of the samples of a shape, mm.
const SPACING_MM: f32 = 0.4;

/// How far around a shape it is sampled, mm: what is further away does not press.
pub(crate) const REACH_MM: f32 = 2.5;

/// A rigid shape whose distance is known at once: a ball by its formula, any other shape by samples on a grid.
#[derive(Clone, Debug, PartialEq)]
pub struct Body {
    pub(crate) form: Form,
    /// Corners of the box that holds the shape, in its own frame, mm.
    pub(crate) bounds_mm: [Vec3; 2],
}

#[derive(Clone, Debug, PartialEq)]
pub(crate) enum Form {
    Ball { radius_mm: f32 },
    Sampled(Samples),
}

/// Distances on a grid, along x first.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Samples {
    first_mm: Vec3,
    n: [usize; 3],
    distance_mm: Vec<f32>,
}

impl Body {
    /// Samples a shape, which takes from a millisecond to a second for a surface of many triangles.
    ///
    /// # Errors
    /// A shape that can't be.
    pub fn new(shape: &Shape, surfaces: &Surfaces) -> Result<Self, ShapeError> {
        let exact = shape.signed_distance_field(surfaces)?;
        let (low, high) = exact.bounds_mm();
        let form = match shape {
            Shape::Sphere { radius_mm } => Form::Ball {
                radius_mm: *radius_mm as f32,
            },
            _ => Form::Sampled(Samples::of(exact.as_ref())),
        };
        Ok(Self {
            form,
            bounds_mm: [low.as_vec3(), high.as_vec3()],
        })
    }

    /// Bytes that the body occupies.
    #[must_use]
    pub fn n_bytes(&self) -> usize {
        let samples = match &self.form {
            Form::Ball { .. } => 0,
            Form::Sampled(samples) => size_of_val(samples.distance_mm.as_slice()),
        };
        size_of::<Self>() + samples
    }
}

impl Samples {
    fn of(exact: &dyn SignedDistance) -> Self {
        let (low, high) = exact.bounds_mm();
        let around = DVec3::splat(f64::from(REACH_MM + SPACING_MM));
        let (low, high) = (low - around, high + around);
        let spacing_mm = f64::from(SPACING_MM);
        let n = ((high - low) / spacing_mm)
            .ceil()
            .to_array()
            .map(|n| n as usize + 1);
        let at = |i: usize, j: usize, k: usize| {
            let point = low + spacing_mm * DVec3::new(i as f64, j as f64, k as f64);
            exact.signed_distance(point).distance_mm as f32
        };
        let [n_x, n_y, n_z] = n;
        let planes = (0..n_z).flat_map(|k| (0..n_y).flat_map(move |j| (0..n_x).map(move |i| (i, j, k))));
        Self {
            first_mm: low.as_vec3(),
            n,
            distance_mm: planes.map(|(i, j, k)| at(i, j, k)).collect(),
        }
    }

    /// The distance, linear between the samples; beyond them [`REACH_MM`].
    #[inline(always)]
    pub(crate) fn distance_mm(&self, point: Vec3) -> f32 {
        let [n_x, n_y, n_z] = self.n;
        let cells = (point - self.first_mm) * (1.0 / SPACING_MM);
        let last = Vec3::new((n_x - 1) as f32, (n_y - 1) as f32, (n_z - 1) as f32);
        if !(cells.cmpge(Vec3::ZERO).all() && cells.cmplt(last).all()) {
            return REACH_MM;
        }
        let [i, j, k] = cells.to_array().map(|cell| cell as usize);
        let part = cells - Vec3::new(i as f32, j as f32, k as f32);
        let first = (k * n_y + j) * n_x + i;
        let line = |from: usize| {
            let [low, high] = [self.distance_mm[from], self.distance_mm[from + 1]];
            low + (high - low) * part.x
        };
        let plane = |from: usize| {
            let [low, high] = [line(from), line(from + n_x)];
            low + (high - low) * part.y
        };
        let [low, high] = [plane(first), plane(first + n_x * n_y)];
        low + (high - low) * part.z
    }
}
