//! Random meshes: closed surfaces with bumps and many triangles, like those of scanned objects.

use std::f64::consts::{PI, TAU};
use std::sync::Arc;

use glam::{DVec2, DVec3};
use rand::Rng;
use twintac_shape::{SurfaceError, Surfaces, TriangleSurface};

/// Number of random meshes.
pub(crate) const N: u32 = 5;

/// Rows of triangles from pole to pole, and triangles along the upper side of a row: 20,000
/// triangles.
const ROWS: [usize; 2] = [101, 100];

/// Number of bumps of a mesh.
const N_BUMPS: usize = 6;

/// The name of a random mesh, used as a shape's path.
pub(crate) fn name(number: u32) -> String {
    format!("random mesh {number}")
}

/// The random meshes that test presses use, by name.
///
/// # Errors
/// None that is known.
pub fn test_surfaces() -> Result<Surfaces, SurfaceError> {
    let surface = |number| Ok((name(number), Arc::new(random_mesh(number)?)));
    (0..N).map(surface).collect()
}

/// A ball with bumps.
fn random_mesh(number: u32) -> Result<TriangleSurface, SurfaceError> {
    let random = &mut twintac_random::stream(u64::from(number), "boulder");
    let radius_mm = random.random_range(4.0..10.0);
    let bumps: [(DVec3, f64); N_BUMPS] = std::array::from_fn(|_| {
        let turn = random.random_range(0.0..TAU);
        let height: f64 = random.random_range(-1.0..1.0);
        let way = (DVec2::from_angle(turn) * (1.0 - height * height).sqrt()).extend(height);
        (way, random.random_range(-0.12..0.25))
    });
    let [n_rows, n_columns] = ROWS;
    let vertex = |row: usize, column: usize| {
        let (fall, turn) = (
            PI * row as f64 / n_rows as f64,
            TAU * (column % n_columns) as f64 / n_columns as f64,
        );
        let way = match row {
            0 => DVec3::Z,
            _ if row == n_rows => DVec3::NEG_Z,
            _ => (DVec2::from_angle(turn) * fall.sin()).extend(fall.cos()),
        };
        let waves = bumps
            .iter()
            .map(|(at, height)| height * (4.0 * (way.dot(*at) - 1.0)).exp());
        radius_mm * (1.0 + waves.sum::<f64>()) * way
    };
    let mut triangles = Vec::new();
    for row in 0..n_rows {
        for column in 0..n_columns {
            let [a, b] = [vertex(row, column), vertex(row, column + 1)];
            let [c, d] = [vertex(row + 1, column), vertex(row + 1, column + 1)];
            if row > 0 {
                triangles.push([a, c, b]);
            }
            if row + 1 < n_rows {
                triangles.push([b, c, d]);
            }
        }
    }
    TriangleSurface::from_triangles(&triangles)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn random_meshes_are_closed_and_have_many_triangles() {
        let surfaces = test_surfaces().unwrap();
        assert_eq!(surfaces.len(), N as usize);
        for surface in surfaces.values() {
            assert_eq!(surface.triangles().len(), 20_000);
            let ball_mm3 = |radius_mm: f64| 4.0 / 3.0 * PI * radius_mm.powi(3);
            assert!((ball_mm3(3.5)..ball_mm3(14.0)).contains(&surface.volume_mm3()));
        }
    }
}
