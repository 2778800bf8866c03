//! Loads on the surface, for comparisons with closed forms.

use glam::DVec3;

use crate::MPA_PER_KPA;
use crate::body::SoftBody;

/// Number of rows of small triangles that each triangle of the surface is cut into.
const ROWS: u32 = 4;

impl SoftBody {
    /// Loads the surface with a traction, kPa, as a function of the undeformed position. It keeps
    /// its size and direction when the body moves, and acts in full from the next step on. Between
    /// the nodes of the finer mesh it is distributed linearly.
    #[must_use]
    pub fn with_surface_load(mut self, traction_kpa: &dyn Fn(DVec3) -> DVec3) -> Self {
        let mesh = self.mesh();
        let mut sums = vec![DVec3::ZERO; mesh.nodes_mm.len()];
        for triangle in mesh.boundary_triangles() {
            let corners_mm = triangle.map(|node| mesh.nodes_mm[node as usize]);
            let area_mm2 = mesh.area_vector_mm2(&triangle).length() / f64::from(ROWS * ROWS);
            for weights in middles() {
                let at_mm: DVec3 = corners_mm.iter().zip(weights).map(|(at, w)| *at * w).sum();
                let force_n = traction_kpa(at_mm) * (area_mm2 * MPA_PER_KPA);
                for (node, weight) in triangle.iter().zip(weights) {
                    sums[*node as usize] += force_n * weight;
                }
            }
        }
        self.loads_n = (0..)
            .zip(sums)
            .filter(|(_, force_n)| *force_n != DVec3::ZERO)
            .collect();
        self
    }
}

/// Middles of the small triangles, in barycentric coordinates.
fn middles() -> impl Iterator<Item = [f64; 3]> {
    let upright = |i, j| (i + j < ROWS).then_some([i, j].map(|k| f64::from(3 * k + 1)));
    let inverted = |i, j| (i + j + 1 < ROWS).then_some([i, j].map(|k| f64::from(3 * k + 2)));
    (0..ROWS)
        .flat_map(|i| (0..ROWS).map(move |j| (i, j)))
        .flat_map(move |(i, j)| [upright(i, j), inverted(i, j)])
        .flatten()
        .map(|[a, b]| {
            let whole = f64::from(3 * ROWS);
            [a / whole, b / whole, 1.0 - (a + b) / whole]
        })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_small_triangles_fill_the_large_one() {
        let all: Vec<[f64; 3]> = middles().collect();
        assert_eq!(all.len() as u32, ROWS * ROWS);
        for corner in 0..3 {
            let mean = all.iter().map(|weights| weights[corner]).sum::<f64>() / f64::from(ROWS * ROWS);
            assert!((mean - 1.0 / 3.0).abs() < 1e-14);
        }
        assert!(all.iter().flatten().all(|weight| *weight > 0.0));
    }
}
