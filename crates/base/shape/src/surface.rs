//! Closed triangle surfaces.

use std::collections::BTreeMap;
use std::sync::Arc;

use glam::{DVec2, DVec3};
use serde::{Serialize, Serializer};

use crate::bvh::Bvh;
use crate::surface_error::SurfaceError;
use crate::{Distance, SignedDistance, stl};

/// Triangle surfaces by the path that names them.
pub type Surfaces = BTreeMap<String, Arc<TriangleSurface>>;

/// A closed surface of triangles with an inside.
///
/// The sign of the distance comes from angle-weighted pseudonormals (Bærentzen and Aanæs, Signed Distance
/// Computation Using the Angle Weighted Pseudonormal, IEEE TVCG 2005), which is exact for any closed surface.
#[derive(Clone, Debug)]
pub struct TriangleSurface {
    vertices_mm: Vec<DVec3>,
    triangles: Vec<[u32; 3]>,
    face_normals: Vec<DVec3>,
    /// Of the edges from corner 0 to 1, 1 to 2 and 2 to 0.
    edge_normals: Vec<[DVec3; 3]>,
    vertex_normals: Vec<DVec3>,
    bvh: Bvh,
    volume_mm3: f64,
}

/// A surface is written as its vertices and triangles, from which all else follows.
impl Serialize for TriangleSurface {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        (&self.vertices_mm, &self.triangles).serialize(serializer)
    }
}

/// What part of a triangle is closest.
#[derive(Clone, Copy)]
enum Part {
    Face,
    Edge(usize),
    Corner(usize),
}

impl TriangleSurface {
    /// Reads an STL file's bytes, binary or ASCII, in mm. Equal corners become one vertex; triangles that
    /// have lost a corner by that are left out.
    ///
    /// # Errors
    /// Truncated files, text that is no STL, and surfaces that are not closed or face inwards.
    pub fn from_stl(bytes: &[u8]) -> Result<Self, SurfaceError> {
        Self::from_triangles(&stl::read(bytes)?)
    }

    /// A surface from the corners of its triangles, mm, counterclockwise seen from outside.
    ///
    /// # Errors
    /// Surfaces that are not closed or face inwards.
    pub fn from_triangles(corners_mm: &[[DVec3; 3]]) -> Result<Self, SurfaceError> {
        let (vertices_mm, triangles) = weld(corners_mm);
        if triangles.len() < 4 {
            return Err(SurfaceError::Empty {
                triangles: triangles.len(),
            });
        }
        let neighbours = neighbours(&vertices_mm, &triangles)?;
        let corners = |triangle: &[u32; 3]| triangle.map(|vertex| vertices_mm[vertex as usize]);
        let volume_mm3 = triangles.iter().map(|triangle| {
            // About one corner, so that a small body far from the origin keeps its digits.
            let [a, b, c] = corners(triangle).map(|corner| corner - vertices_mm[0]);
            a.dot(b.cross(c)) / 6.0
        });
        let volume_mm3 = volume_mm3.sum();
        if volume_mm3 <= 0.0 {
            return Err(SurfaceError::InsideOut { volume_mm3 });
        }
        let face_normals: Vec<DVec3> = triangles
            .iter()
            .map(|triangle| {
                let [a, b, c] = corners(triangle);
                (b - a).cross(c - a).normalize_or_zero()
            })
            .collect();
        let edge_normals = (0..triangles.len())
            .map(|face| {
                neighbours[face].map(|other| (face_normals[face] + face_normals[other]).normalize_or_zero())
            })
            .collect();
        let mut vertex_normals = vec![DVec3::ZERO; vertices_mm.len()];
        for (triangle, normal) in triangles.iter().zip(&face_normals) {
            let at = corners(triangle);
            for corner in 0..3 {
                let (next, last) = (
                    at[(corner + 1) % 3] - at[corner],
                    at[(corner + 2) % 3] - at[corner],
                );
                vertex_normals[triangle[corner] as usize] += *normal * next.angle_between(last);
            }
        }
        for normal in &mut vertex_normals {
            *normal = normal.normalize_or_zero();
        }
        let boxes = triangles.iter().map(|triangle| {
            let [a, b, c] = corners(triangle);
            (a.min(b).min(c), a.max(b).max(c))
        });
        let bvh = Bvh::new(&boxes.collect::<Vec<_>>());
        Ok(Self {
            vertices_mm,
            triangles,
            face_normals,
            edge_normals,
            vertex_normals,
            bvh,
            volume_mm3,
        })
    }

    /// The vertices, mm.
    #[must_use]
    pub fn vertices_mm(&self) -> &[DVec3] {
        &self.vertices_mm
    }

    /// The triangles as indices of vertices, counterclockwise seen from outside.
    #[must_use]
    pub fn triangles(&self) -> &[[u32; 3]] {
        &self.triangles
    }

    /// Enclosed volume, mm³.
    #[must_use]
    pub fn volume_mm3(&self) -> f64 {
        self.volume_mm3
    }

    /// Height of the highest point of the surface above or below a place in the xy plane, mm; `None` beside
    /// the surface.
    #[must_use]
    pub fn top_height_mm(&self, at_mm: DVec2) -> Option<f64> {
        let mut highest: Option<f64> = None;
        self.bvh.over(at_mm, &mut |triangle| {
            if let Some(height_mm) = height_in(self.corners(triangle), at_mm) {
                highest = Some(highest.map_or(height_mm, |found| found.max(height_mm)));
            }
        });
        highest
    }

    fn corners(&self, triangle: usize) -> [DVec3; 3] {
        self.triangles[triangle].map(|vertex| self.vertices_mm[vertex as usize])
    }

    fn pseudonormal(&self, triangle: usize, part: Part) -> DVec3 {
        match part {
            Part::Face => self.face_normals[triangle],
            Part::Edge(edge) => self.edge_normals[triangle][edge],
            Part::Corner(corner) => self.vertex_normals[self.triangles[triangle][corner] as usize],
        }
    }
}

impl SignedDistance for TriangleSurface {
    fn signed_distance(&self, point_mm: DVec3) -> Distance {
        let mut best = (f64::INFINITY, DVec3::ZERO, 0, Part::Face);
        self.bvh.closest(point_mm, &mut |triangle| {
            let (closest, part) =
                closest_point(self.corners(triangle), self.face_normals[triangle], point_mm);
            let square_mm2 = closest.distance_squared(point_mm);
            if square_mm2 < best.0 {
                best = (square_mm2, closest, triangle, part);
            }
            best.0
        });
        let (square_mm2, closest, triangle, part) = best;
        let normal = self.pseudonormal(triangle, part);
        let away = point_mm - closest;
        let length_mm = square_mm2.sqrt();
        let sign = if away.dot(normal) < 0.0 { -1.0 } else { 1.0 };
        // Next to the surface rounding spoils the direction, but not the normal; a face's normal is exact
        // anyway.
        let near = length_mm < 1e-9 || matches!(part, Part::Face);
        let gradient = if near && normal != DVec3::ZERO {
            normal
        } else {
            sign * away / length_mm
        };
        let gradient = if gradient.is_finite() {
            gradient.normalize_or(DVec3::Z)
        } else {
            DVec3::Z
        };
        Distance {
            distance_mm: sign * length_mm,
            gradient,
        }
    }

    fn bounds_mm(&self) -> (DVec3, DVec3) {
        self.bvh.bounds_mm()
    }
}

/// Makes equal corners one vertex, numbered in order of appearance, and leaves out triangles that lose a
/// corner by it.
fn weld(corners_mm: &[[DVec3; 3]]) -> (Vec<DVec3>, Vec<[u32; 3]>) {
    let mut numbers = BTreeMap::new();
    let mut vertices_mm = Vec::new();
    let mut triangles = Vec::new();
    for corners in corners_mm {
        let triangle = corners.map(|corner| {
            // Adding zero makes -0 the same as 0.
            let key = (corner + DVec3::ZERO).to_array().map(f64::to_bits);
            *numbers.entry(key).or_insert_with(|| {
                vertices_mm.push(corner);
                vertices_mm.len() as u32 - 1
            })
        });
        let [a, b, c] = triangle;
        if a != b && b != c && c != a {
            triangles.push(triangle);
        }
    }
    (vertices_mm, triangles)
}

/// The triangle across each edge of each triangle.
fn neighbours(vertices_mm: &[DVec3], triangles: &[[u32; 3]]) -> Result<Vec<[usize; 3]>, SurfaceError> {
    let edge = |triangle: &[u32; 3], corner: usize| (triangle[corner], triangle[(corner + 1) % 3]);
    let mut owners: BTreeMap<(u32, u32), Vec<usize>> = BTreeMap::new();
    for (index, triangle) in triangles.iter().enumerate() {
        for corner in 0..3 {
            owners.entry(edge(triangle, corner)).or_default().push(index);
        }
    }
    let mut open = Vec::new();
    let mut neighbours = vec![[0; 3]; triangles.len()];
    for (triangle, across) in triangles.iter().zip(&mut neighbours) {
        for (corner, neighbour) in across.iter_mut().enumerate() {
            let (from, to) = edge(triangle, corner);
            match (
                owners.get(&(from, to)).map(Vec::as_slice),
                owners.get(&(to, from)).map(Vec::as_slice),
            ) {
                (Some([_]), Some([other])) => *neighbour = *other,
                _ => open.push((from, to)),
            }
        }
    }
    match open.first() {
        Some(&(from, to)) => {
            let middle = 0.5 * (vertices_mm[from as usize] + vertices_mm[to as usize]);
            Err(SurfaceError::NotClosed {
                edges: open.len(),
                at_mm: middle.to_array(),
            })
        }
        None => Ok(neighbours),
    }
}

/// Closest point of a triangle and the part that it belongs to; sound for triangles of no area too.
fn closest_point(corners: [DVec3; 3], normal: DVec3, point: DVec3) -> (DVec3, Part) {
    let mut best = (f64::INFINITY, corners[0], Part::Corner(0));
    let mut beside_face = normal == DVec3::ZERO;
    for corner in 0..3 {
        let next = (corner + 1) % 3;
        let (from, edge) = (corners[corner], corners[next] - corners[corner]);
        let away = point - from;
        beside_face |= edge.cross(away).dot(normal) < 0.0;
        let along = away.dot(edge) / edge.length_squared();
        let (closest, part) = if along <= 0.0 {
            (from, Part::Corner(corner))
        } else if along >= 1.0 {
            (corners[next], Part::Corner(next))
        } else {
            (from + along * edge, Part::Edge(corner))
        };
        let square = closest.distance_squared(point);
        if square < best.0 {
            best = (square, closest, part);
        }
    }
    if beside_face {
        return (best.1, best.2);
    }
    (point - normal * (point - corners[0]).dot(normal), Part::Face)
}

/// Height at which a triangle stands over a place; upright triangles stand over nothing.
fn height_in([a, b, c]: [DVec3; 3], at: DVec2) -> Option<f64> {
    let area = |p: DVec2, q: DVec2, r: DVec2| (q - p).perp_dot(r - p);
    let (pa, pb, pc) = (a.truncate(), b.truncate(), c.truncate());
    let whole = area(pa, pb, pc);
    let shares = [
        area(pb, pc, at) / whole,
        area(pc, pa, at) / whole,
        area(pa, pb, at) / whole,
    ];
    // Points on an edge belong to both neighbours, whatever rounding says.
    let inside = whole != 0.0 && shares.iter().all(|share| *share >= -1e-12);
    inside.then(|| shares[0] * a.z + shares[1] * b.z + shares[2] * c.z)
}
