//! Which connected surfaces are bodies and which are cavities in them.

use glam::DVec3;

use crate::bvh::Bvh;
use crate::surface_error::SurfaceError;
use crate::winding::Winding;

/// Volume over area and diagonal that a body has at least.
const LEAST_THICKNESS: f64 = 1e-8;
/// Corners of a surface that are looked for in another one, at most.
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

/// What a shell is.
#[derive(Clone, Copy)]
pub(crate) struct Role {
    /// Which body it bounds, from 0.
    pub(crate) body: usize,
    /// Whether it has to be turned: triangles face away from the material.
    pub(crate) is_turned: bool,
    /// Whether material lies around it, not in it.
    pub(crate) is_cavity: bool,
}

/// Tells bodies from cavities.
///
/// A shell that lies in no other one is a body, whichever way it faces. One that lies in a body and faces the opposite way is a cavity of it. One
/// that faces the same way is a body within a body. What lies in a cavity and faces the opposite way is a body again.
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
