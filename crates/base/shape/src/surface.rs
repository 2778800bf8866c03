//! Closed triangle surfaces.

use std::collections::BTreeMap;
use std::sync::Arc;

use glam::{DVec2, DVec3};
use serde::{Serialize, Serializer};

use crate::bvh::Bvh;
use crate::manifold::{Manifold, join};
use crate::nesting::{Shell, roles};
use crate::overlap::Places;
use crate::surface_error::SurfaceError;
use crate::weld::weld;
use crate::{Distance, ExtentError, SignedDistance, stl};

/// Largest fraction of its area with which a connected surface may run through itself, as 3D scans
/// do in their creases.
const CREASES: f64 = 1e-3;

/// Triangle surfaces by their names; see [`crate::SurfaceFile::name`].
pub type Surfaces = BTreeMap<String, Arc<TriangleSurface>>;

/// A closed triangle surface with an interior: one body or more, which may have cavities.
///
/// Several bodies form a union, also where they overlap. Outside, the distance is exact; inside, it
/// is that to the nearest surface of one of them, as for [`crate::Shape::Union`]. The sign comes
/// from angle-weighted pseudonormals (Bærentzen and Aanæs, Signed Distance Computation Using the
/// Angle Weighted Pseudonormal, IEEE TVCG 2005), and is exact for every closed surface.
#[derive(Clone, Debug)]
pub struct TriangleSurface {
    vertices_mm: Vec<DVec3>,
    triangles: Vec<[u32; 3]>,
    face_normals: Vec<DVec3>,
    /// Normals of the edges from corner 0 to 1, 1 to 2 and 2 to 0.
    edge_normals: Vec<[DVec3; 3]>,
    vertex_normals: Vec<DVec3>,
    /// The triangles of each body, including those of its cavities.
    pub(crate) bodies: Vec<Bvh>,
    /// Whether each triangle belongs to a cavity.
    pub(crate) is_cavity: Vec<bool>,
    bounds_mm: (DVec3, DVec3),
    volume_mm3: f64,
}

/// A surface is serialized as its vertices and triangles; everything else follows from these.
impl Serialize for TriangleSurface {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        (&self.vertices_mm, &self.triangles).serialize(serializer)
    }
}

/// The part of a triangle that is closest to a point.
#[derive(Clone, Copy)]
enum Part {
    Face,
    Edge(usize),
    Corner(usize),
}

impl TriangleSurface {
    /// Reads the bytes of an STL file, binary or text, in which a length of 1 is `mm_per_unit` mm.
    ///
    /// # Errors
    /// Bytes that are not a complete STL file; sizes and positions that are not plausible
    /// ([`ExtentError`]); those of [`TriangleSurface::from_triangles`].
    pub fn from_stl(bytes: &[u8], mm_per_unit: f64) -> Result<Self, SurfaceError> {
        let triangles = stl::read(bytes)?.into_iter();
        let triangles: Vec<[DVec3; 3]> = triangles
            .map(|corners| corners.map(|corner| mm_per_unit * corner))
            .collect();
        if let Some((low, high)) = bounds(triangles.iter().flatten()) {
            ExtentError::check(low, high)?;
        }
        Self::from_triangles(&triangles)
    }

    /// A surface from the corners of its triangles, mm, counterclockwise seen from outside.
    ///
    /// Faults that are corrected:
    ///
    /// - Equal corners become one vertex. At edges that would otherwise stay open, corners that
    ///   differ by less than 1e-5 of the diagonal become one as well.
    /// - Triangles without area are left out, and duplicate triangles: those of a body that is
    ///   listed twice, or of a face that two bodies share.
    /// - Triangles that face another way than their neighbours are turned, and so are whole bodies:
    ///   a body that is inside of no other body faces outwards. A surface inside of a body that
    ///   faces against it is a cavity.
    ///
    /// Edges may have more than two triangles.
    ///
    /// # Errors
    /// The surface is not closed, has one side only, encloses nothing, or runs through itself with
    /// more than 0.1 % of its area (tested at points 4 % of the diagonal apart); a cavity is inside
    /// of a cavity; a corner is not finite.
    pub fn from_triangles(corners_mm: &[[DVec3; 3]]) -> Result<Self, SurfaceError> {
        let is_finite = |corners: &[DVec3; 3]| corners.iter().all(|corner| corner.is_finite());
        if let Some(triangle) = corners_mm.iter().position(|corners| !is_finite(corners)) {
            return Err(SurfaceError::NotFinite { triangle });
        }
        let welded = weld(corners_mm);
        if welded.triangles.len() < 4 {
            return Err(SurfaceError::Empty {
                triangles: welded.triangles.len(),
            });
        }
        let mut manifold = join(&welded.vertices_mm, welded.triangles)?;
        let (vertices_mm, of_component) = part_vertices(&welded.vertices_mm, &mut manifold);
        let boxes: Vec<(DVec3, DVec3)> = manifold
            .triangles
            .iter()
            .map(|triangle| bounds_of(triangle.map(|vertex| vertices_mm[vertex as usize])))
            .collect();
        let shells: Vec<Shell> = members(&manifold.component, manifold.n_components)
            .into_iter()
            .zip(of_component)
            .map(|(triangles, vertices)| {
                shell(&vertices_mm, &manifold.triangles, &boxes, triangles, vertices)
            })
            .collect();
        let unturned = manifold.triangles.clone();
        let corners = |triangle: usize| unturned[triangle].map(|vertex| vertices_mm[vertex as usize]);
        let roles = roles(&shells, &vertices_mm, &corners)?;
        for triangle in 0..manifold.triangles.len() {
            if roles[manifold.component[triangle]].is_turned {
                manifold.triangles[triangle].swap(1, 2);
                manifold.neighbours[triangle].swap(0, 2);
            }
        }
        let corners =
            |triangle: usize| manifold.triangles[triangle].map(|vertex| vertices_mm[vertex as usize]);
        for (body, (shell, role)) in shells.iter().zip(&roles).enumerate() {
            let places = Places::on(&shell.triangles, &corners);
            let of_material = i32::from(!role.is_cavity);
            match places.without_material(&shell.triangles, &corners, of_material) {
                Some((share, at_mm)) if share > CREASES => {
                    let at_mm = at_mm.to_array();
                    return Err(SurfaceError::SelfOverlap { body, share, at_mm });
                }
                _ => {}
            }
        }
        let volumes_mm3 = shells.iter().zip(&roles).map(|(shell, role)| {
            if role.is_turned {
                -shell.volume_mm3
            } else {
                shell.volume_mm3
            }
        });
        let volume_mm3 = volumes_mm3.sum();
        let body_of: Vec<usize> = manifold
            .component
            .iter()
            .map(|&component| roles[component].body)
            .collect();
        let n_bodies = 1 + body_of.iter().copied().max().expect("four triangles at least");
        let bodies = members(&body_of, n_bodies)
            .into_iter()
            .map(|triangles| Bvh::new(&boxes, triangles));
        let bodies = bodies.collect();
        let of_component = manifold.component.iter();
        let is_cavity = of_component
            .map(|&component| roles[component].is_cavity)
            .collect();
        Ok(Self {
            is_cavity,
            bounds_mm: bounds(&vertices_mm).expect("four triangles at least"),
            bodies,
            volume_mm3,
            ..Self::with_normals(vertices_mm, manifold)
        })
    }

    /// The surface with its normals, still without bodies.
    fn with_normals(vertices_mm: Vec<DVec3>, manifold: Manifold) -> Self {
        let Manifold {
            triangles,
            neighbours,
            ..
        } = manifold;
        let corners = |triangle: &[u32; 3]| triangle.map(|vertex| vertices_mm[vertex as usize]);
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
        Self {
            vertices_mm,
            triangles,
            face_normals,
            edge_normals,
            vertex_normals,
            bodies: Vec::new(),
            is_cavity: Vec::new(),
            bounds_mm: (DVec3::ZERO, DVec3::ZERO),
            volume_mm3: 0.0,
        }
    }

    /// The vertices, mm.
    #[must_use]
    pub fn vertices_mm(&self) -> &[DVec3] {
        &self.vertices_mm
    }

    /// The triangles as indices of vertices, counterclockwise seen from outside; `[n][3]`.
    #[must_use]
    pub fn triangles(&self) -> &[[u32; 3]] {
        &self.triangles
    }

    /// Enclosed volume, mm³. Where bodies overlap it counts more than once.
    #[must_use]
    pub fn volume_mm3(&self) -> f64 {
        self.volume_mm3
    }

    /// A point where two bodies overlap or touch, mm; `None` if they are apart from each other, or
    /// if there is only one body.
    #[must_use]
    pub fn bodies_meet_at_mm(&self) -> Option<DVec3> {
        if self.bodies.len() < 2 {
            return None;
        }
        let corners = |triangle: usize| self.corners(triangle);
        self.bodies.iter().enumerate().find_map(|(index, body)| {
            let places = Places::on(body, &corners);
            let mut others = self
                .bodies
                .iter()
                .enumerate()
                .filter(|(other, _)| *other != index);
            others.find_map(|(_, other)| places.in_other(other, &corners))
        })
    }

    /// Height of the highest point of the surface on the vertical line through a location of the xy
    /// plane, mm; `None` beside the surface.
    #[must_use]
    pub fn top_height_mm(&self, at_mm: DVec2) -> Option<f64> {
        let mut highest: Option<f64> = None;
        for body in &self.bodies {
            body.over(at_mm, &mut |triangle| {
                if let Some(height_mm) = height_in(self.corners(triangle), at_mm) {
                    highest = Some(highest.map_or(height_mm, |found| found.max(height_mm)));
                }
            });
        }
        highest
    }

    pub(crate) fn corners(&self, triangle: usize) -> [DVec3; 3] {
        self.triangles[triangle].map(|vertex| self.vertices_mm[vertex as usize])
    }

    fn pseudonormal(&self, triangle: usize, part: Part) -> DVec3 {
        match part {
            Part::Face => self.face_normals[triangle],
            Part::Edge(edge) => self.edge_normals[triangle][edge],
            Part::Corner(corner) => self.vertex_normals[self.triangles[triangle][corner] as usize],
        }
    }

    /// Signed distance to one of the bodies.
    pub(crate) fn distance_to_body(&self, body: usize, point_mm: DVec3) -> Distance {
        self.distance_to(&self.bodies[body], point_mm)
    }

    /// Number of bodies.
    pub(crate) fn n_bodies(&self) -> usize {
        self.bodies.len()
    }

    /// Box around one of the bodies, as (minimum, maximum) corners, mm.
    pub(crate) fn bounds_of_body_mm(&self, body: usize) -> (DVec3, DVec3) {
        self.bodies[body].bounds_mm()
    }

    /// Distance to the surface of one body.
    fn distance_to(&self, body: &Bvh, point_mm: DVec3) -> Distance {
        let mut best = (f64::INFINITY, DVec3::ZERO, 0, Part::Face);
        body.closest(point_mm, &mut |triangle| {
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
        // Next to the surface, rounding spoils the direction but not the normal. The normal of a
        // face is exact in any case.
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
}

impl SignedDistance for TriangleSurface {
    fn signed_distance(&self, point_mm: DVec3) -> Distance {
        let mut nearest = self.distance_to(&self.bodies[0], point_mm);
        for body in &self.bodies[1..] {
            let away_mm = body.box_distance_mm(point_mm);
            if away_mm == 0.0 || away_mm < nearest.distance_mm {
                let found = self.distance_to(body, point_mm);
                if found.distance_mm < nearest.distance_mm {
                    nearest = found;
                }
            }
        }
        nearest
    }

    fn bounds_mm(&self) -> (DVec3, DVec3) {
        self.bounds_mm
    }
}

/// Box around points; `None` without points.
fn bounds<'a>(points: impl IntoIterator<Item = &'a DVec3>) -> Option<(DVec3, DVec3)> {
    let boxes = points.into_iter().map(|point| (*point, *point));
    boxes.reduce(|(low, high), (point, _)| (low.min(point), high.max(point)))
}

pub(crate) fn bounds_of([a, b, c]: [DVec3; 3]) -> (DVec3, DVec3) {
    (a.min(b).min(c), a.max(b).max(c))
}

/// Lists the triangles of each group, given the group of each triangle.
fn members(group_of: &[usize], n_groups: usize) -> Vec<Vec<usize>> {
    let mut members = vec![Vec::new(); n_groups];
    for (triangle, &group) in group_of.iter().enumerate() {
        members[group].push(triangle);
    }
    members
}

/// Gives each connected surface its own vertices, one surface after the other, also at points where
/// surfaces touch.
fn part_vertices(
    vertices_mm: &[DVec3],
    manifold: &mut Manifold,
) -> (Vec<DVec3>, Vec<std::ops::Range<usize>>) {
    let mut parted_mm = Vec::new();
    let mut ranges = Vec::new();
    let mut numbers = vec![u32::MAX; vertices_mm.len()];
    for triangles in members(&manifold.component, manifold.n_components) {
        let first = parted_mm.len();
        let mut used = Vec::new();
        for triangle in triangles {
            for vertex in &mut manifold.triangles[triangle] {
                let number = &mut numbers[*vertex as usize];
                if *number == u32::MAX {
                    *number = parted_mm.len() as u32;
                    parted_mm.push(vertices_mm[*vertex as usize]);
                    used.push(*vertex);
                }
                *vertex = *number;
            }
        }
        used.into_iter()
            .for_each(|vertex| numbers[vertex as usize] = u32::MAX);
        ranges.push(first..parted_mm.len());
    }
    (parted_mm, ranges)
}

fn shell(
    vertices_mm: &[DVec3],
    triangles: &[[u32; 3]],
    boxes: &[(DVec3, DVec3)],
    members: Vec<usize>,
    vertices: std::ops::Range<usize>,
) -> Shell {
    let (mut volume_mm3, mut area_mm2) = (0.0, 0.0);
    for &triangle in &members {
        // Relative to one corner, so that a small body far from the origin keeps its precision.
        let about = vertices_mm[vertices.start];
        let [a, b, c] = triangles[triangle].map(|vertex| vertices_mm[vertex as usize] - about);
        volume_mm3 += a.dot(b.cross(c)) / 6.0;
        area_mm2 += 0.5 * (b - a).cross(c - a).length();
    }
    Shell {
        triangles: Bvh::new(boxes, members),
        vertices,
        volume_mm3,
        area_mm2,
    }
}

/// Closest point of a triangle and the part that it belongs to; also valid for triangles without
/// area.
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

/// Height of a triangle above a location; `None` for upright triangles.
fn height_in([a, b, c]: [DVec3; 3], at: DVec2) -> Option<f64> {
    let area = |p: DVec2, q: DVec2, r: DVec2| (q - p).perp_dot(r - p);
    let (pa, pb, pc) = (a.truncate(), b.truncate(), c.truncate());
    let whole = area(pa, pb, pc);
    let shares = [
        area(pb, pc, at) / whole,
        area(pc, pa, at) / whole,
        area(pa, pb, at) / whole,
    ];
    // A point on an edge belongs to both triangles, independent of rounding.
    let inside = whole != 0.0 && shares.iter().all(|share| *share >= -1e-12);
    inside.then(|| shares[0] * a.z + shares[1] * b.z + shares[2] * c.z)
}
