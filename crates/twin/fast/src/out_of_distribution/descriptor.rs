//! Descriptor of a contact: a few numbers that do not depend on the location on the gel, and little
//! on the rotation about the vertical.

use glam::{Vec2, Vec3};

use crate::contact::N_CHANNELS;
use crate::surface::SurfaceGrid;

/// Numbers for each height at which distances are evaluated.
const N_OF_LEVEL: usize = 6;

/// Numbers of a contact.
pub(crate) const N_TRAITS: usize = N_CHANNELS * N_OF_LEVEL;

/// Weight of a point near a body where points inside count, so that a body without points inside
/// has a plane too.
const NEAR_WEIGHT: f32 = 1e-3;

/// Added to the determinant of second moments, in grid spacings to the fourth power: a contact of
/// few points has hardly any tilt.
const LEAST_DETERMINANT: f32 = 0.02;

/// How deep, steep, large, tilted and uneven a contact is at each height; `None` where nothing is
/// near. A thin body may press without having a grid point inside it, so points near a body count
/// too.
///
/// `inputs`: those of a grid's points. `[n_points * N_CHANNELS]`
pub(crate) fn traits(grid: &SurfaceGrid, inputs: &[f32]) -> Option<[f32; N_TRAITS]> {
    let points = inputs.as_chunks::<N_CHANNELS>().0;
    let mut traits = [0.0; N_TRAITS];
    for (number, traits) in traits.as_chunks_mut::<N_OF_LEVEL>().0.iter_mut().enumerate() {
        *traits = Level { grid, points, number }.traits();
    }
    (traits[0] > 0.0).then_some(traits)
}

/// The points at one height.
struct Level<'a> {
    grid: &'a SurfaceGrid,
    points: &'a [[f32; N_CHANNELS]],
    number: usize,
}

/// The weighted least-squares plane through the proximities of the points.
struct Plane {
    /// Sum of the weights.
    weight: f32,
    /// Standard deviation of the points from their centroid, grid spacings.
    spread: f32,
    /// Gradient of the plane, per grid spacing.
    slope: f32,
    /// Standard deviation of the proximities from the plane.
    rest: f32,
}

impl Level<'_> {
    fn share(&self, [i, j]: [usize; 2]) -> f32 {
        self.points[j * self.grid.n[0] + i][self.number]
    }

    /// Columns, rows and proximities of the points that something is near.
    fn near(&self) -> impl Iterator<Item = ([usize; 2], f32)> {
        let [n_x, n_y] = self.grid.n;
        let all = (0..n_y).flat_map(move |j| (0..n_x).map(move |i| [i, j]));
        all.map(|at| (at, self.share(at)))
            .filter(|(_, share)| *share > 0.0)
    }

    fn traits(&self) -> [f32; N_OF_LEVEL] {
        let deepest = self.near().map(|(_, share)| share).fold(0.0, f32::max);
        if deepest <= 0.0 {
            return [0.0; N_OF_LEVEL];
        }
        let around = self.plane(|share| share);
        let inside = self.plane(|share| (share - 1.0).max(0.0) + NEAR_WEIGHT);
        // Roots, so that small tilts count.
        [
            deepest,
            self.steps() / around.weight,
            around.spread,
            around.slope.sqrt(),
            inside.slope.sqrt(),
            inside.rest.sqrt(),
        ]
    }

    /// Sum of the absolute differences between neighbouring points.
    fn steps(&self) -> f32 {
        let [n_x, n_y] = self.grid.n;
        let mut steps = 0.0;
        for ([i, j], share) in self.near() {
            let beside = [
                (i + 1 < n_x).then_some([i + 1, j]),
                (j + 1 < n_y).then_some([i, j + 1]),
            ];
            for beside in beside.into_iter().flatten() {
                steps += (self.share(beside) - share).abs();
            }
        }
        steps
    }

    fn plane(&self, weight: impl Fn(f32) -> f32) -> Plane {
        let places = || {
            self.near().map(|([i, j], share)| {
                let place = Vec3::new(i as f32, j as f32, share);
                (place, weight(share))
            })
        };
        let (mut sum, mut total) = (Vec3::ZERO, 0.0);
        for (place, weight) in places() {
            sum += weight * place;
            total += weight;
        }
        let middle = sum / total;
        // Second moments about the centroid: of the locations, and of locations with proximities.
        let (mut squares, mut products) = (Vec3::ZERO, Vec3::ZERO);
        for (place, weight) in places() {
            let Vec3 { x, y, z } = place - middle;
            squares += weight * Vec3::new(x * x, y * y, z * z);
            products += weight * Vec3::new(x * y, x * z, y * z);
        }
        let (squares, products) = (squares / total, products / total);
        let determinant = squares.x * squares.y - products.x * products.x + LEAST_DETERMINANT;
        let slope = Vec2::new(
            squares.y * products.y - products.x * products.z,
            squares.x * products.z - products.x * products.y,
        ) / determinant;
        let rest = places().map(|(place, weight)| {
            let from = place - middle;
            weight * (from.z - slope.dot(from.truncate())).powi(2)
        });
        Plane {
            weight: total,
            spread: (squares.x + squares.y).sqrt(),
            slope: slope.length(),
            rest: (rest.sum::<f32>() / total).sqrt(),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::layout::Layout;
    use twintac_sensor::SensorFile;

    #[test]
    fn traits_do_not_depend_on_the_place() {
        let sensor = SensorFile::phystac().unwrap().sensor;
        let layout = Layout::of(&sensor);
        let grid = layout.grid();
        let at = |column: usize, row: usize| {
            let mut inputs = vec![0.0; grid.len() * N_CHANNELS];
            for (i, j, share) in [(0, 0, 1.5), (1, 0, 1.2), (0, 1, 0.4)] {
                inputs[((row + j) * grid.n[0] + column + i) * N_CHANNELS] = share;
            }
            traits(grid, &inputs)
        };
        let (here, there) = (at(3, 3).unwrap(), at(8, 5).unwrap());
        for (here, there) in here.iter().zip(there) {
            assert!((here - there).abs() < 1e-3, "{here} {there}");
        }
        assert_eq!(traits(grid, &vec![0.0; grid.len() * N_CHANNELS]), None);
    }
}
