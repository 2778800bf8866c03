//! Finds which connected surfaces are bodies and which are cavities in them.

use glam::DVec3;

use crate::bvh::Bvh;
use crate::surface_error::SurfaceError;
use crate::winding::Winding;

/// Smallest volume of a body, divided by its area and its diagonal.
const LEAST_THICKNESS: f64 = 1e-8;
/// Largest number of corners of a surface that are tested for being inside of another one.
const MOST_CORNERS: usize = 200;

/// A connected closed surface.
pub(crate) struct Shell {
    pub(crate) triangles: Bvh,
    /// Its corners.
    pub(crate) vertices: std::ops::Range<usize>,
    /// Enclosed volume, negative where triangles face inwards, mm³.
    pub(crate) volume_mm3: f64,
    pub(crate) area_mm2: f64,
}

/// What a shell bounds.
#[derive(Clone, Copy)]
pub(crate) struct Role {
    /// Index of the body that the shell bounds, from 0.
    pub(crate) body: usize,
    /// Whether its triangles have to be turned, so that they face away from the material.
    pub(crate) is_turned: bool,
    /// Whether the material is around the shell and not inside of it.
    pub(crate) is_cavity: bool,
}

/// Classifies shells as bodies or cavities.
///
/// A shell inside of no other shell is a body, whichever way it faces. A shell inside of a body
/// that faces the opposite way is a cavity of that body; one that faces the same way is a body
/// within a body. A shell inside of a cavity that faces the opposite way is again a body.
pub(crate) fn roles(
    shells: &[Shell],
    vertices_mm: &[DVec3],
    corners: &dyn Fn(usize) -> [DVec3; 3],
) -> Result<Vec<Role>, SurfaceError> {
    let place = |shell: usize| vertices_mm[shells[shell].vertices.start].to_array();
    for (index, shell) in shells.iter().enumerate() {
        let (low, high) = shell.triangles.bounds_mm();
        if shell.volume_mm3.abs() <= LEAST_THICKNESS * shell.area_mm2 * low.distance(high) {
            return Err(SurfaceError::Flat {
                body: index,
                at_mm: place(index),
            });
        }
    }
    let mut largest_first: Vec<usize> = (0..shells.len()).collect();
    let volume = |shell: usize| shells[shell].volume_mm3.abs();
    largest_first.sort_by(|&one, &other| volume(other).total_cmp(&volume(one)));
    let winding = Winding::new();
    let lies_in = |inner: usize, outer: usize| {
        let (inner, outer) = (&shells[inner], &shells[outer].triangles);
        let step = inner.vertices.len().div_ceil(MOST_CORNERS);
        let mut some = vertices_mm[inner.vertices.clone()].iter().step_by(step);
        some.all(|&corner| {
            outer.box_distance_mm(corner) == 0.0 && winding.number(outer, corners, corner) != 0
        })
    };
    let mut roles: Vec<Option<Role>> = vec![None; shells.len()];
    let mut n_bodies = 0;
    for (place_in_order, &shell) in largest_first.iter().enumerate() {
        let mut larger = largest_first[..place_in_order].iter().rev();
        let around = larger.find(|&&outer| lies_in(shell, outer));
        let faces_out = |shell: usize| shells[shell].volume_mm3 > 0.0;
        let of_outer = around.and_then(|&outer| Some((roles[outer]?, faces_out(outer))));
        let (is_cavity, body) = match of_outer {
            None => (false, None),
            Some((outer, outer_faces_out)) if outer_faces_out == faces_out(shell) => {
                if outer.is_cavity {
                    return Err(SurfaceError::Nested {
                        body: shell,
                        at_mm: place(shell),
                    });
                }
                (false, None)
            }
            Some((outer, _)) => (!outer.is_cavity, (!outer.is_cavity).then_some(outer.body)),
        };
        let body = body.unwrap_or_else(|| {
            n_bodies += 1;
            n_bodies - 1
        });
        roles[shell] = Some(Role {
            body,
            is_cavity,
            is_turned: faces_out(shell) == is_cavity,
        });
    }
    let roles = roles.into_iter();
    Ok(roles
        .map(|role| role.expect("each shell has a place in the order"))
        .collect())
}
