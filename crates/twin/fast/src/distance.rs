//! Distances to a rigid shape, fast enough to ask for hundreds of them in a microsecond.

use glam::{DVec3, Vec3, Vec3A, Vec4};
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
    Ball(Ball),
    Sampled(Samples),
}

/// What tells distances.
pub(crate) trait Field {
    /// The distance of a point in the body's frame, mm; [`REACH_MM`] or more where it is more than that.
    fn distance_mm(&self, point: Vec3A) -> f32;
}

/// A ball that stands on its origin.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Ball {
    radius_mm: f32,
}

impl Field for Ball {
    #[inline(always)]
    fn distance_mm(&self, point: Vec3A) -> f32 {
        let z = point.z - self.radius_mm;
        (point.x * point.x + point.y * point.y + z * z).sqrt() - self.radius_mm
    }
}

/// Distances at the corners of cells, along z first: points of a body that stands upright, one above the other, lie side by side in memory.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Samples {
    first_mm: Vec3A,
    /// Cells along each axis.
    n_cells: Vec3A,
    /// How far apart in memory samples are that are neighbours along x and along y.
    strides: [usize; 2],
    /// `[n_cells.x + 1][n_cells.y + 1][n_cells.z + 1]`
    distance_mm: Vec<f32>,
    /// Smallest distance in each block of cells: most of the space around a body is out of its reach, and these say so at once.
    /// `[n_blocks.x][n_blocks.y][n_blocks.z]`
    least_mm: Vec<f32>,
    /// The same of blocks.
    block_strides: [usize; 2],
}

/// Cells along each side of a block.
const BLOCK: usize = 4;

impl Body {
    /// Samples a shape, which takes from a millisecond to a second for a surface of many triangles.
    ///
    /// # Errors
    /// A shape that can't be.
    pub fn new(shape: &Shape, surfaces: &Surfaces) -> Result<Self, ShapeError> {
        let exact = shape.signed_distance_field(surfaces)?;
        let (low, high) = exact.bounds_mm();
        let form = match shape {
            Shape::Sphere { radius_mm } => Form::Ball(Ball {
                radius_mm: *radius_mm as f32,
            }),
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
            Form::Ball(_) => 0,
            Form::Sampled(samples) => {
                size_of_val(samples.distance_mm.as_slice()) + size_of_val(samples.least_mm.as_slice())
            }
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
        let [n_x, n_y, n_z] = n_cells.map(|n| n + 1);
        let mut distance_mm = Vec::with_capacity(n_x * n_y * n_z);
        for i in 0..n_x {
            for j in 0..n_y {
                distance_mm.extend((0..n_z).map(|k| {
                    let point = low + spacing_mm * DVec3::new(i as f64, j as f64, k as f64);
                    exact.signed_distance(point).distance_mm as f32
                }));
            }
        }
        let n_blocks = n_cells.map(|n| n.div_ceil(BLOCK));
        let [b_x, b_y, b_z] = n_blocks;
        let mut least_mm = vec![f32::INFINITY; b_x * b_y * b_z];
        // A block ends with the corners of its last cells, with which the next one begins.
        let blocks = |corner: usize, n: usize| corner.saturating_sub(1) / BLOCK..(corner / BLOCK + 1).min(n);
        for (number, distance_mm) in distance_mm.iter().enumerate() {
            let [i, j, k] = [number / (n_y * n_z), number / n_z % n_y, number % n_z];
            for b_i in blocks(i, b_x) {
                for b_j in blocks(j, b_y) {
                    for b_k in blocks(k, b_z) {
                        let least_mm = &mut least_mm[(b_i * b_y + b_j) * b_z + b_k];
                        *least_mm = least_mm.min(*distance_mm);
                    }
                }
            }
        }
        Self {
            first_mm: low.as_vec3a(),
            n_cells: Vec3A::from_array(n_cells.map(|n| n as f32)),
            strides: [n_y * n_z, n_z],
            distance_mm,
            least_mm,
            block_strides: [b_y * b_z, b_z],
        }
    }
}

impl Field for Samples {
    /// Linear between the samples.
    #[inline(always)]
    fn distance_mm(&self, point: Vec3A) -> f32 {
        let cells = (point - self.first_mm) * (1.0 / SPACING_MM);
        if !(cells.cmpge(Vec3A::ZERO) & cells.cmplt(self.n_cells)).all() {
            return REACH_MM;
        }
        let [x, y, z] = [cells.x.floor(), cells.y.floor(), cells.z.floor()];
        let [i, j, k] = [whole(x), whole(y), whole(z)];
        let block = i / BLOCK * self.block_strides[0] + j / BLOCK * self.block_strides[1] + k / BLOCK;
        if self.least_mm[block] >= REACH_MM {
            return REACH_MM;
        }
        let [along_x, along_y] = self.strides;
        let y0 = &self.distance_mm[i * along_x + j * along_y + k..];
        let y1 = &y0[along_y..];
        let low = Vec4::new(y0[0], y0[1], y1[0], y1[1]);
        let (y0, y1) = (&y0[along_x..], &y1[along_x..]);
        let high = Vec4::new(y0[0], y0[1], y1[0], y1[1]);
        let between_x = low + (high - low) * (cells.x - x);
        let [y0z0, y0z1, y1z0, y1z1] = between_x.to_array();
        let part = cells.y - y;
        let [z0, z1] = [y0z0 + (y1z0 - y0z0) * part, y0z1 + (y1z1 - y0z1) * part];
        z0 + (z1 - z0) * (cells.z - z)
    }
}

/// A small whole number that is not negative. A cast would look for what is not.
#[inline(always)]
fn whole(number: f32) -> usize {
    /// Added to a number below it, it leaves a whole number in the last bits.
    const ROUND: f32 = 8_388_608.0;
    ((number + ROUND).to_bits() - ROUND.to_bits()) as usize
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
                let found_mm = f64::from(samples.distance_mm(point.as_vec3a()));
                worst_mm = worst_mm.max((found_mm - distance_mm).abs());
            }
        }
        // A sharp bend of the distance lies between samples: half a spacing's diagonal at most, much less on average.
        assert!(worst_mm < 0.2, "{worst_mm}");
        assert_eq!(samples.distance_mm(Vec3A::splat(50.0)), REACH_MM);
    }
}
