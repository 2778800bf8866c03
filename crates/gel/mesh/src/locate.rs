//! Finds the tetrahedron that contains a point.

use glam::DVec3;

use crate::TetMesh;
use crate::boundary::FACES;
use crate::tet_mesh::signed_volume_mm3;

/// Smallest tolerance, mm: because of round-off, a point on a face may be outside of both of its
/// tetrahedra.
const SMALLEST_TOLERANCE_MM: f64 = 1e-9;

impl TetMesh {
    /// The tetrahedron that contains a point, and the barycentric coordinates of the point, which
    /// interpolate a nodal field.
    ///
    /// A point outside of the mesh, but within `tolerance_mm`, is moved to the nearest point of the
    /// mesh. `None` if it is farther away. On a shared face, edge or node the tetrahedron with the
    /// lowest index is taken.
    #[must_use]
    pub fn locate(&self, point_mm: DVec3, tolerance_mm: f64) -> Option<(usize, [f64; 4])> {
        self.neighbourhood(point_mm, tolerance_mm)
            .locate(point_mm, tolerance_mm)
    }

    /// The tetrahedra that touch a box, which extends by `reach_mm` from its centre along each
    /// axis. Points inside of the box can be located among them.
    #[must_use]
    pub fn neighbourhood(&self, center_mm: DVec3, reach_mm: f64) -> Neighbourhood<'_> {
        let reach = DVec3::splat(reach_mm.max(SMALLEST_TOLERANCE_MM));
        let (low, high) = (center_mm - reach, center_mm + reach);
        let is_reached = |tet: &usize| {
            let [a, b, c, d] = self.corners_mm(*tet);
            a.min(b).min(c.min(d)).cmple(high).all() && a.max(b).max(c.max(d)).cmpge(low).all()
        };
        Neighbourhood {
            mesh: self,
            tets: (0..self.tets.len()).filter(is_reached).collect(),
        }
    }
}

/// Tetrahedra of a mesh near a location. Points are located faster among them than in the whole
/// mesh.
#[derive(Clone, Debug)]
pub struct Neighbourhood<'a> {
    mesh: &'a TetMesh,
    /// In increasing order.
    tets: Vec<usize>,
}

impl Neighbourhood<'_> {
    /// Like [`TetMesh::locate`], for points whose distance to the sides of the box is larger than
    /// the tolerance.
    #[must_use]
    pub fn locate(&self, point_mm: DVec3, tolerance_mm: f64) -> Option<(usize, [f64; 4])> {
        let tolerance_mm = tolerance_mm.max(SMALLEST_TOLERANCE_MM);
        let tolerance = DVec3::splat(tolerance_mm);
        let mut nearest: Option<(f64, usize, [f64; 4])> = None;
        for &tet in &self.tets {
            let corners = self.mesh.corners_mm(tet);
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

/// Distance from a point to the surface of a tetrahedron, and the barycentric coordinates of the
/// nearest point there.
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

/// Barycentric coordinates of the point of a triangle that is nearest to `p`: its projection, or
/// the nearest point of the edges.
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

#[cfg(test)]
mod tests {
    use glam::DVec3;
    use twintac_shape::{Solid, Surfaces};

    use crate::{MeshSettings, generate};

    #[test]
    fn a_neighbourhood_finds_what_the_whole_mesh_finds() {
        let solid = Solid::Block {
            size_mm: [6.0, 5.0, 4.0],
            center_mm: [0.0, 0.0],
            edge_radius_mm: 0.0,
        };
        let mesh = generate(&solid, &Surfaces::new(), &[], &MeshSettings::default()).unwrap();
        let center_mm = DVec3::new(0.3, -0.2, 0.0);
        let near = mesh.neighbourhood(center_mm, 1.1);
        assert!(near.tets.len() < mesh.tets.len());
        for i in 0..200 {
            let angle = 0.3 * f64::from(i);
            let offset_mm = DVec3::new(angle.cos(), angle.sin(), 0.2 * (3.0 * angle).sin());
            let point_mm = center_mm + (f64::from(i) / 200.0) * offset_mm;
            assert_eq!(near.locate(point_mm, 0.05), mesh.locate(point_mm, 0.05));
        }
    }
}
