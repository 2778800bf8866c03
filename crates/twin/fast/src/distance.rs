//! Distances to a rigid shape, fast enough to ask for hundreds of them in a microsecond.

use glam::{DVec3, Vec3};
use twintac_shape::{Shape, ShapeError, SignedDistance, Surfaces};

/// Distance of the samples of a shape, mm.
const SPACING_MM: f32 = 0.5;

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

/// Distances at the corners of cells, cells along x first. A corner is stored with each of its eight cells: one place in memory has all that a
/// distance is made of.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Samples {
    first_mm: Vec3,
    n_cells: [usize; 3],
    /// Corner `4 x + 2 y + z` of each cell, mm.
    corners_mm: Vec<[f32; 8]>,
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
            Form::Sampled(samples) => size_of_val(samples.corners_mm.as_slice()),
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
        let n_cells = ((high - low) / spacing_mm).ceil().to_array().map(|n| n as usize);
        let [n_x, n_y, n_z] = n_cells;
        let mut distance_mm = Vec::with_capacity((n_x + 1) * (n_y + 1) * (n_z + 1));
        for k in 0..=n_z {
            for j in 0..=n_y {
                distance_mm.extend((0..=n_x).map(|i| {
                    let point = low + spacing_mm * DVec3::new(i as f64, j as f64, k as f64);
                    exact.signed_distance(point).distance_mm as f32
                }));
            }
        }
        let corner = |i: usize, j: usize, k: usize| distance_mm[(k * (n_y + 1) + j) * (n_x + 1) + i];
        let mut corners_mm = Vec::with_capacity(n_x * n_y * n_z);
        for k in 0..n_z {
            for j in 0..n_y {
                corners_mm.extend((0..n_x).map(|i| {
                    std::array::from_fn(|number| {
                        corner(i + (number >> 2), j + (number >> 1 & 1), k + (number & 1))
                    })
                }));
            }
        }
        Self {
            first_mm: low.as_vec3(),
            n_cells,
            corners_mm,
        }
    }

    /// The distance, linear between the samples; beyond them [`REACH_MM`].
    #[inline(always)]
    pub(crate) fn distance_mm(&self, point: Vec3) -> f32 {
        let [n_x, n_y, n_z] = self.n_cells;
        let cells = (point - self.first_mm) * (1.0 / SPACING_MM);
        let end = Vec3::new(n_x as f32, n_y as f32, n_z as f32);
        if !(cells.cmpge(Vec3::ZERO).all() && cells.cmplt(end).all()) {
            return REACH_MM;
        }
        let [i, j, k] = cells.to_array().map(|cell| cell as usize);
        let part = cells - Vec3::new(i as f32, j as f32, k as f32);
        let Some([x0y0z0, x0y0z1, x0y1z0, x0y1z1, x1y0z0, x1y0z1, x1y1z0, x1y1z1]) =
            self.corners_mm.get((k * n_y + j) * n_x + i)
        else {
            return REACH_MM;
        };
        let along_x = |low: f32, high: f32| low + (high - low) * part.x;
        let [y0z0, y0z1] = [along_x(*x0y0z0, *x1y0z0), along_x(*x0y0z1, *x1y0z1)];
        let [y1z0, y1z1] = [along_x(*x0y1z0, *x1y1z0), along_x(*x0y1z1, *x1y1z1)];
        let [z0, z1] = [y0z0 + (y1z0 - y0z0) * part.y, y0z1 + (y1z1 - y0z1) * part.y];
        z0 + (z1 - z0) * part.z
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn samples_are_close_to_the_shape_near_its_surface() {
        let cube = Shape::Box {
            size_mm: [8.0, 6.0, 10.0],
            edge_radius_mm: 0.8,
        };
        let Form::Sampled(samples) = Body::new(&cube, &Surfaces::new()).unwrap().form else {
            panic!("a box is sampled")
        };
        let exact = cube.signed_distance_field(&Surfaces::new()).unwrap();
        let mut worst_mm: f64 = 0.0;
        for step in 0..20_000 {
            let turn = |rate: f64| (f64::from(step) * rate).fract();
            let point = DVec3::new(
                12.0 * turn(0.618) - 6.0,
                10.0 * turn(0.755) - 5.0,
                14.0 * turn(0.57) - 2.0,
            );
            let distance_mm = exact.signed_distance(point).distance_mm;
            if distance_mm.abs() < 2.0 {
                let found_mm = f64::from(samples.distance_mm(point.as_vec3()));
                worst_mm = worst_mm.max((found_mm - distance_mm).abs());
            }
        }
        // A sharp bend of the distance lies between samples: half a spacing's diagonal at most, much less on average.
        assert!(worst_mm < 0.2, "{worst_mm}");
        assert_eq!(samples.distance_mm(Vec3::splat(50.0)), REACH_MM);
    }
}
