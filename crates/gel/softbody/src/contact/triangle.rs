//! Contact inside of the boundary's triangles, for shapes that turn sharply within one, such as the
//! rim of a punch.
//!
//! With contact at nodes alone, a triangle can cut off such a rim. Gel that is squeezed out from
//! under a punch also takes its short edges along, so that at depth, long edges lie across the rim;
//! under a sliding punch, they do so in front of it. Therefore quadrature points inside of
//! triangles are pushed out of the shape as well, except for the depth that a flat triangle has in
//! an arc as round as the shape (`bend`): where a shape is smooth, contact at nodes is enough.
//! There are more quadrature points than the nodes have degrees of freedom, so they cannot all be
//! exactly outside: they are softer than nodes and have no multiplier.

use glam::DVec3;

use super::point::ContactPoint;

/// Number of parts of each side when a triangle is cut. A quadrature point is in the middle of each
/// part of the triangle.
const CUTS: u32 = 3;

/// Corners of each side.
pub(super) const SIDES: [[usize; 2]; 3] = [[0, 1], [1, 2], [2, 0]];

/// Factor of the depth in an arc. An arc only approximates the shape, and points must not be in
/// contact because of that.
const MARGIN: f64 = 1.25;

/// Stiffness of the points inside, relative to that of nodes. Stiffer ones widen a punch by a
/// fraction of an edge and let its force rise in steps, as rows of nodes slide around its rim one
/// after the other; softer ones narrow it. Chosen with the meshes of paths, on the presses of
/// `cargo xtask verify rims`.
const SOFTNESS: f64 = 0.3;

/// Factor of their stiffness where the triangle lies across a wall that is thinner than the
/// triangle, because no node presses there.
const ACROSS_WALL: f64 = 2.5;

/// A triangle of the boundary.
pub(crate) struct BoundaryTriangle {
    pub(super) nodes: [u32; 3],
    /// Index of each corner among the boundary's nodes, if it is free.
    pub(super) corners: [Option<u32>; 3],
    /// Stiffness of all points inside together, N/mm.
    stiffness: f64,
    pub(super) longest_mm: f64,
}

impl BoundaryTriangle {
    /// A triangle between these nodes; `corners` are their indices among the boundary's nodes, and
    /// `stiffness` is the contact stiffness per area and inverse edge length, MPa.
    pub(crate) fn new(nodes: [u32; 3], corners: [Option<u32>; 3], at_mm: [DVec3; 3], stiffness: f64) -> Self {
        let [a, b, c] = at_mm;
        let area_mm2 = 0.5 * (b - a).cross(c - a).length();
        let size_mm = (2.0 * area_mm2).sqrt();
        Self {
            nodes,
            corners,
            stiffness: SOFTNESS * stiffness * area_mm2 / size_mm,
            longest_mm: a.distance(b).max(b.distance(c)).max(c.distance(a)),
        }
    }

    /// Its free corners, as indices of the boundary's nodes.
    pub(super) fn free_corners(&self) -> impl Iterator<Item = usize> {
        self.corners.into_iter().flatten().map(|corner| corner as usize)
    }

    /// The quadrature points of a triangle, given the bends of the shape along its sides: see
    /// [`bend_mm`](super::rigid_body::RigidBody::bend_mm).
    pub(super) fn points(
        &self,
        bends_mm: [f64; 3],
        is_across_wall: bool,
    ) -> impl Iterator<Item = ContactPoint> {
        let stiffening = if is_across_wall { ACROSS_WALL } else { 1.0 };
        let stiffness = stiffening * self.stiffness / f64::from(CUTS * CUTS);
        middles().map(move |weights| {
            // For an arc of curvature c, which bends by c l² over a length l: c/2 times the sum of
            // w w l² over the sides.
            let sides = SIDES.into_iter().zip(bends_mm);
            let slack_mm = 0.5
                * MARGIN
                * sides
                    .map(|([a, b], bend_mm)| weights[a] * weights[b] * bend_mm)
                    .sum::<f64>();
            ContactPoint::inside(self.nodes, weights, stiffness, slack_mm)
        })
    }
}

/// Middles of equal parts of a triangle, as weights of its corners.
pub(super) fn middles() -> impl Iterator<Item = [f64; 3]> {
    let part = |value: u32| f64::from(value) / f64::from(3 * CUTS);
    (0..CUTS).flat_map(move |row| {
        // Counted from the first corner, a row has upright parts, and inverted ones between them.
        (0..2 * row + 1).map(move |part_of_row| {
            let (away, along) = if part_of_row % 2 == 0 { (2, 1) } else { (1, 2) };
            let (away, along) = (3 * row + away, 3 * (part_of_row / 2) + along);
            [1.0 - part(away), part(away - along), part(along)]
        })
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn points_spread_evenly_over_a_triangle() {
        let points: Vec<DVec3> = middles().map(DVec3::from_array).collect();
        assert_eq!(points.len(), (CUTS * CUTS) as usize);
        let mean = points.iter().sum::<DVec3>() / points.len() as f64;
        assert!((mean - DVec3::splat(1.0 / 3.0)).length() < 1e-12);
        for (i, a) in points.iter().enumerate() {
            assert!(a.min_element() > 0.0 && (a.element_sum() - 1.0).abs() < 1e-12);
            for b in &points[i + 1..] {
                assert!(a.distance(*b) > 0.2, "{a} {b}");
            }
        }
    }
}
