//! Which tetrahedron holds a point.

use glam::DVec3;

use crate::TetMesh;
use crate::boundary::FACES;
use crate::tet_mesh::signed_volume_mm3;

impl TetMesh {
    /// The tetrahedron that holds a point, with the point's barycentric coordinates, which interpolate a nodal field.
    ///
    /// A point outside, but within `tolerance_mm` of the mesh, is moved to the nearest point of the mesh. None if it is farther out.
    /// On a shared face, edge or node the tetrahedron with the lowest index is taken.
    #[must_use]
    pub fn locate(&self, point_mm: DVec3, tolerance_mm: f64) -> Option<(usize, [f64; 4])> {
        // Round-off may put a point on a face outside of both its tetrahedra.
        let tolerance_mm = tolerance_mm.max(1e-9);
        let tolerance = DVec3::splat(tolerance_mm);
        let mut nearest: Option<(f64, usize, [f64; 4])> = None;
        for tet in 0..self.tets.len() {
            let corners = self.corners_mm(tet);
            let low = corners[0].min(corners[1]).min(corners[2].min(corners[3])) - tolerance;
            let high = corners[0].max(corners[1]).max(corners[2].max(corners[3])) + tolerance;
            if !(point_mm.cmpge(low).all() && point_mm.cmple(high).all()) {
                continue;
            }
            let inside = barycentric(corners, point_mm);
            if inside.iter().all(|&weight| weight >= 0.0) {
                return Some((tet, inside));
            }
            let (distance_mm, weights) = nearest_on_surface(corners, point_mm);
            if distance_mm <= tolerance_mm && nearest.is_none_or(|(least_mm, ..)| distance_mm < least_mm) {
                nearest = Some((distance_mm, tet, weights));
            }
        }
        nearest.map(|(_, tet, weights)| (tet, weights))
    }
}

fn barycentric([a, b, c, d]: [DVec3; 4], p: DVec3) -> [f64; 4] {
    let whole = signed_volume_mm3([a, b, c, d]);
    [[p, b, c, d], [a, p, c, d], [a, b, p, d], [a, b, c, p]].map(|part| signed_volume_mm3(part) / whole)
}

/// Distance from a point to the surface of a tetrahedron, and the barycentric coordinates of the nearest point there.
fn nearest_on_surface(corners: [DVec3; 4], point_mm: DVec3) -> (f64, [f64; 4]) {
    let mut nearest = (f64::INFINITY, [0.0; 4]);
    for face in FACES {
        let triangle = face.map(|corner| corners[corner]);
        let weights = nearest_on_triangle(triangle, point_mm);
        let foot: DVec3 = triangle
            .iter()
            .zip(weights)
            .map(|(&corner, weight)| corner * weight)
            .sum();
        let distance_mm = foot.distance(point_mm);
        if distance_mm < nearest.0 {
            let mut all = [0.0; 4];
            face.iter()
                .zip(weights)
                .for_each(|(&corner, weight)| all[corner] = weight);
            nearest = (distance_mm, all);
        }
    }
    nearest
}

/// Barycentric coordinates of the point of a triangle that is nearest to `p`: its projection, or else the nearest on the edges.
fn nearest_on_triangle([a, b, c]: [DVec3; 3], p: DVec3) -> [f64; 3] {
    let normal = (b - a).cross(c - a);
    let parts = [(b, c), (c, a), (a, b)].map(|(from, to)| (to - from).cross(p - from).dot(normal));
    let square = normal.length_squared();
    if square > 0.0 && parts.iter().all(|&part| part >= 0.0) {
        return parts.map(|part| part / square);
    }
    let mut nearest = (f64::INFINITY, [1.0, 0.0, 0.0]);
    for (i, (from, to)) in [(a, b), (b, c), (c, a)].into_iter().enumerate() {
        let along = to - from;
        let share = ((p - from).dot(along) / along.length_squared()).clamp(0.0, 1.0);
        let distance = (from + share * along).distance_squared(p);
        if distance < nearest.0 {
            let mut weights = [0.0; 3];
            weights[i] = 1.0 - share;
            weights[(i + 1) % 3] = share;
            nearest = (distance, weights);
        }
    }
    nearest.1
}
