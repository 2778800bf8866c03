//! Interpolation of a nodal field on the board.

use glam::{DMat2, DVec2};

/// Eight-node faces in the gel's plane, with a value at each node.
pub(super) struct Faces<'a> {
    /// Four corners anticlockwise, then the midpoints of the edges that follow them.
    pub(super) faces: &'a [[usize; 8]],
    /// Position of a node, mm.
    pub(super) at_mm: &'a dyn Fn(usize) -> DVec2,
    /// Value at a node.
    pub(super) value: &'a dyn Fn(usize) -> f64,
}

/// Corners in the face's natural coordinates.
const CORNERS: [[f64; 2]; 4] = [[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]];

/// Number of rings of samples in a disc.
const RINGS: u32 = 6;

impl Faces<'_> {
    /// The value at a point; `None` outside all faces.
    pub(super) fn at(&self, point_mm: DVec2) -> Option<f64> {
        self.faces.iter().find_map(|face| {
            let own = self.own_coordinates(face, point_mm)?;
            Some(
                face.iter()
                    .zip(shape_functions(own))
                    .map(|(node, weight)| weight * (self.value)(*node))
                    .sum(),
            )
        })
    }

    /// The mean over a disc, from sample points that represent equal areas.
    pub(super) fn disc_mean(&self, center_mm: DVec2, radius_mm: f64) -> Option<f64> {
        let (mut sum, mut count) = (0.0, 0);
        for ring in 0..RINGS {
            let n = 6 * (2 * ring + 1);
            let distance_mm = radius_mm * (f64::from(ring) + 0.5) / f64::from(RINGS);
            for i in 0..n {
                let angle = std::f64::consts::TAU * (f64::from(i) + 0.5) / f64::from(n);
                sum += self.at(center_mm + distance_mm * DVec2::from_angle(angle))?;
                count += 1;
            }
        }
        Some(sum / f64::from(count))
    }

    /// The natural coordinates of a point, by Newton's method on the bilinear map of the corners
    /// (edges are straight); `None` outside.
    fn own_coordinates(&self, face: &[usize; 8], point_mm: DVec2) -> Option<DVec2> {
        let corners: [DVec2; 4] = std::array::from_fn(|i| (self.at_mm)(face[i]));
        let low = corners
            .iter()
            .fold(DVec2::INFINITY, |low, corner| low.min(*corner))
            - 1e-6;
        let high = corners
            .iter()
            .fold(DVec2::NEG_INFINITY, |high, corner| high.max(*corner))
            + 1e-6;
        if point_mm.cmplt(low).any() || point_mm.cmpgt(high).any() {
            return None;
        }
        let mut own = DVec2::ZERO;
        for _ in 0..20 {
            let (mut at_mm, mut slope) = (DVec2::ZERO, DMat2::ZERO);
            for (corner, [x, y]) in corners.iter().zip(CORNERS) {
                at_mm += 0.25 * (1.0 + x * own.x) * (1.0 + y * own.y) * *corner;
                slope.x_axis += 0.25 * x * (1.0 + y * own.y) * *corner;
                slope.y_axis += 0.25 * y * (1.0 + x * own.x) * *corner;
            }
            own += slope.inverse() * (point_mm - at_mm);
        }
        (own.abs().max_element() <= 1.0 + 1e-6).then_some(own)
    }
}

/// Shape functions of the eight-node serendipity element.
fn shape_functions(own: DVec2) -> [f64; 8] {
    std::array::from_fn(|node| {
        let [x, y] = CORNERS[node % 4];
        match node {
            0..4 => 0.25 * (1.0 + x * own.x) * (1.0 + y * own.y) * (x * own.x + y * own.y - 1.0),
            4 | 6 => 0.5 * (1.0 - own.x * own.x) * (1.0 + y * own.y),
            _ => 0.5 * (1.0 - own.y * own.y) * (1.0 + x * own.x),
        }
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn quadratic_fields_on_a_parallelogram_are_exact() {
        let corners = [[0.0, 0.0], [3.0, 0.5], [3.5, 3.0], [0.5, 2.5]].map(DVec2::from_array);
        let at = |node: usize| {
            if node < 4 {
                corners[node]
            } else {
                corners[node - 4].midpoint(corners[(node - 3) % 4])
            }
        };
        let field = |at: DVec2| 1.0 + at.x - 2.0 * at.y + at.x * at.y + at.y * at.y;
        let faces = [[0, 1, 2, 3, 4, 5, 6, 7]];
        let faces = Faces {
            faces: &faces,
            at_mm: &at,
            value: &|node| field(at(node)),
        };
        let point = DVec2::new(1.7, 1.4);
        assert!((faces.at(point).unwrap() - field(point)).abs() < 1e-9);
        // The mean of y² over a disc exceeds the value at its centre by a quarter of the squared
        // radius.
        let mean = faces.disc_mean(point, 0.5).unwrap();
        assert!((mean - field(point) - 0.0625).abs() < 1e-3);
        assert!(faces.at(DVec2::new(4.0, 0.0)).is_none());
    }
}
