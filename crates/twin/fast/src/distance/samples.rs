//! Signed distances of any shape, by samples.

use glam::{DVec3, Vec3A, Vec4, Vec4Swizzles};
use twintac_shape::SignedDistance;

use super::field::{Field, REACH_MM};
use super::thickness::Thickness;
use super::upward::Upward;

/// Spacing of the samples, mm, unless there would be too many.
const SPACING_MM: f64 = 0.5;

/// Cells across the smallest extent of a body, where there would not be too many: a body with fewer
/// would have no inside.
const CELLS_OF_THICKNESS: f64 = 6.0;

/// Largest number of samples of a body: the samples of a larger body have a larger spacing.
const MOST_SAMPLES: f64 = 4e6;

/// Distances at the corners of cells, along z first: points above one another in an upright body
/// lie side by side in memory.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Samples {
    first_mm: Vec3A,
    /// Cells along each axis.
    n_cells: Vec3A,
    cells_per_mm: Vec3A,
    /// Offsets in memory between sides of neighbouring cells along each axis: whole numbers.
    strides: Vec3A,
    along_x: usize,
    /// Distances, mm, of the four corners of each cell on its side towards lower x, so that they
    /// are read at once: lower y first, then lower z. `[n_cells.x + 1][n_cells.y][n_cells.z]`
    sides_mm: Vec<Vec4>,
    thickness: Thickness,
}

impl Samples {
    pub(super) fn of(exact: &dyn SignedDistance) -> Self {
        let (low, high) = exact.bounds_mm();
        let around = DVec3::splat(f64::from(REACH_MM));
        let volume_mm3 = (high - low + 2.0 * around).element_product();
        let even_mm = DVec3::splat((volume_mm3 / MOST_SAMPLES).cbrt().max(SPACING_MM));
        let finer_mm = even_mm.min((high - low) / CELLS_OF_THICKNESS);
        let is_many = volume_mm3 / finer_mm.element_product() > MOST_SAMPLES;
        let spacing_mm = if is_many { even_mm } else { finer_mm };
        let (low, high) = (low - around - spacing_mm, high + around + spacing_mm);
        let n_cells = ((high - low) / spacing_mm).ceil().to_array().map(|n| n as usize);
        let [n_x, n_y, n_z] = n_cells;
        let mut sides_mm = Vec::with_capacity((n_x + 1) * n_y * n_z);
        for i in 0..=n_x {
            let plane: Vec<f32> = (0..(n_y + 1) * (n_z + 1))
                .map(|number| {
                    let [j, k] = [number / (n_z + 1), number % (n_z + 1)];
                    let point = low + spacing_mm * DVec3::new(i as f64, j as f64, k as f64);
                    exact.signed_distance(point).distance_mm as f32
                })
                .collect();
            for (y0, y1) in plane.chunks(n_z + 1).zip(plane.chunks(n_z + 1).skip(1)) {
                let pairs = y0.windows(2).zip(y1.windows(2));
                sides_mm.extend(pairs.map(|(y0, y1)| Vec4::new(y0[0], y0[1], y1[0], y1[1])));
            }
        }
        let mut samples = Self {
            first_mm: low.as_vec3a(),
            n_cells: Vec3A::from_array(n_cells.map(|n| n as f32)),
            cells_per_mm: (1.0 / spacing_mm).as_vec3a(),
            strides: Vec3A::new((n_y * n_z) as f32, n_z as f32, 1.0),
            along_x: n_y * n_z,
            sides_mm,
            thickness: Thickness::default(),
        };
        samples.thickness = Thickness::of(&samples, samples.near_surface());
        samples
    }

    /// Corners of cells next to the surface.
    fn near_surface(&self) -> impl Iterator<Item = Vec3A> + '_ {
        let step = 1.0 / self.cells_per_mm;
        let sides = self.sides_mm.iter().enumerate();
        let near = sides.filter(move |(_, side)| side.x.abs() < 0.5 * step.max_element());
        near.map(move |(number, _)| {
            let [n_y, n_z] = [self.n_cells.y as usize, self.n_cells.z as usize];
            let corner = [number / self.along_x, number / n_z % n_y, number % n_z];
            self.first_mm + step * Vec3A::from_array(corner.map(|n| n as f32))
        })
    }

    pub(super) fn half_thickness_mm(&self) -> f32 {
        self.thickness.least_mm
    }

    /// Whether a point at this depth inside the body, mm, may be nearer to the body's top than to
    /// its lower side.
    pub(super) fn is_thin(&self, depth_mm: f32, upward: Upward) -> bool {
        self.thickness.is_thin(depth_mm, upward.direction)
    }

    pub(super) fn n_bytes(&self) -> usize {
        size_of_val(self.sides_mm.as_slice())
    }
}

impl Field for Samples {
    /// Linear interpolation between the samples; [`REACH_MM`] outside of them.
    #[inline(always)]
    fn distance_mm(&self, point: Vec3A) -> f32 {
        let cells = (point - self.first_mm) * self.cells_per_mm;
        if !(cells.cmpge(Vec3A::ZERO) & cells.cmplt(self.n_cells)).all() {
            return REACH_MM;
        }
        let corner = cells.floor();
        let part = cells - corner;
        // Whole numbers in single precision are exact for the largest number of samples.
        let sides = &self.sides_mm[whole(corner.dot(self.strides))..];
        let (low, high) = (sides[0], sides[self.along_x]);
        let between_x = low + (high - low) * part.x;
        let [y0, y1] = [between_x.xy(), between_x.zw()];
        let between_y = y0 + (y1 - y0) * part.y;
        between_y.x + (between_y.y - between_y.x) * part.z
    }
}

/// A small whole number that is not negative, as an integer. A cast would also check for other
/// numbers.
#[inline(always)]
fn whole(number: f32) -> usize {
    /// A number below this one, added to it, stands in the last bits of the sum as a whole number.
    const ROUND: f32 = 8_388_608.0;
    ((number + ROUND).to_bits() - ROUND.to_bits()) as usize
}

#[cfg(test)]
mod tests {
    use super::*;
    use twintac_shape::{Shape, Surfaces};

    #[test]
    fn samples_are_close_to_the_shape_near_its_surface() {
        let cube = Shape::Box {
            size_mm: [8.0, 6.0, 10.0],
            edge_radius_mm: 0.8,
        };
        let exact = cube.signed_distance_field(&Surfaces::new()).unwrap();
        let samples = Samples::of(exact.as_ref());
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
        // Kinks of the distance lie between samples: the error is half the diagonal of a cell at
        // most, and much less on average.
        assert!(worst_mm < 0.2, "{worst_mm}");
        assert_eq!(samples.distance_mm(Vec3A::splat(50.0)), REACH_MM);
    }
}
