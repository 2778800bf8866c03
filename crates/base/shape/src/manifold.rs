//! Joins triangles across their edges, and makes them face the same way.

use std::collections::VecDeque;

use glam::{DVec2, DVec3};

use crate::surface_error::SurfaceError;

/// Steps of a full turn about an edge: faces whose angles differ by less than a step lie upon each
/// other.
const TURN_STEPS: i64 = 1 << 24;

/// A side of a triangle: the index of the triangle, and which of its edges (0: corner 0 to 1, 1: 1
/// to 2, 2: 2 to 0).
type Side = (usize, usize);

/// Triangles that are joined across every edge and face the same way as their neighbours.
pub(crate) struct Manifold {
    pub(crate) triangles: Vec<[u32; 3]>,
    /// The triangle across each edge of each triangle.
    pub(crate) neighbours: Vec<[usize; 3]>,
    /// Index of the connected surface of each triangle, in order of appearance.
    pub(crate) component: Vec<usize>,
    pub(crate) n_components: usize,
}

/// Joins triangles across their edges. Where more than two meet at an edge, each is joined to the
/// next one around the edge that bounds the same body.
pub(crate) fn join(vertices_mm: &[DVec3], mut triangles: Vec<[u32; 3]>) -> Result<Manifold, SurfaceError> {
    let middle = |[from, to]: [u32; 2]| {
        let sum = vertices_mm[from as usize] + vertices_mm[to as usize];
        (0.5 * sum).to_array()
    };
    let edges = edges(&triangles);
    face_alike(&mut triangles, &edges).map_err(|edge| SurfaceError::OneSided { at_mm: middle(edge) })?;
    let mut neighbours = vec![[usize::MAX; 3]; triangles.len()];
    let mut open = Vec::new();
    for (edge, sides) in &edges {
        let pairs = match sides[..] {
            [one, other] => vec![(one, other)],
            _ => pairs_around(vertices_mm, &triangles, *edge, sides),
        };
        open.extend(std::iter::repeat_n(*edge, sides.len() - 2 * pairs.len()));
        for (one, other) in pairs {
            neighbours[one.0][one.1] = other.0;
            neighbours[other.0][other.1] = one.0;
        }
    }
    if let Some(&edge) = open.first() {
        return Err(SurfaceError::NotClosed {
            edges: open.len(),
            at_mm: middle(edge),
        });
    }
    let mut component = vec![usize::MAX; triangles.len()];
    let mut n_components = 0;
    for first in 0..triangles.len() {
        if component[first] != usize::MAX {
            continue;
        }
        component[first] = n_components;
        let mut pending = vec![first];
        while let Some(triangle) = pending.pop() {
            for other in neighbours[triangle] {
                if component[other] == usize::MAX {
                    component[other] = n_components;
                    pending.push(other);
                }
            }
        }
        n_components += 1;
    }
    Ok(Manifold {
        triangles,
        neighbours,
        component,
        n_components,
    })
}

/// Edges that belong to an odd number of triangles, each listed once for every side without a
/// partner.
pub(crate) fn open_edges(triangles: &[[u32; 3]]) -> Vec<[u32; 2]> {
    let edges = edges(triangles).into_iter();
    edges
        .filter(|(_, sides)| sides.len() % 2 == 1)
        .map(|(edge, _)| edge)
        .collect()
}

/// All edges, smaller vertex first, with the sides of triangles that lie there.
fn edges(triangles: &[[u32; 3]]) -> Vec<([u32; 2], Vec<Side>)> {
    let mut sides: Vec<([u32; 2], Side)> = Vec::with_capacity(3 * triangles.len());
    for index in 0..triangles.len() {
        for corner in 0..3 {
            let [from, to] = ends(triangles, (index, corner));
            sides.push(([from.min(to), from.max(to)], (index, corner)));
        }
    }
    sides.sort_unstable();
    let same = sides.chunk_by(|one, other| one.0 == other.0);
    same.map(|sides| (sides[0].0, sides.iter().map(|(_, side)| *side).collect()))
        .collect()
}

fn ends(triangles: &[[u32; 3]], (triangle, corner): Side) -> [u32; 2] {
    let corners = triangles[triangle];
    [corners[corner], corners[(corner + 1) % 3]]
}

/// Turns triangles that face another way than most of the triangles that they share an edge with,
/// at edges of exactly two triangles. Fails with an edge where this is impossible.
fn face_alike(triangles: &mut [[u32; 3]], edges: &[([u32; 2], Vec<Side>)]) -> Result<(), [u32; 2]> {
    // For each triangle: the triangles across edges of exactly two triangles, and whether they face
    // the same way.
    let mut across: Vec<Vec<(usize, bool, [u32; 2])>> = vec![Vec::new(); triangles.len()];
    for (edge, sides) in edges {
        if let [one, other] = sides[..] {
            let is_alike = ends(triangles, one) != ends(triangles, other);
            across[one.0].push((other.0, is_alike, *edge));
            across[other.0].push((one.0, is_alike, *edge));
        }
    }
    if across.iter().flatten().all(|(_, is_alike, _)| *is_alike) {
        return Ok(());
    }
    let mut turned: Vec<Option<bool>> = vec![None; triangles.len()];
    for first in 0..triangles.len() {
        if turned[first].is_some() {
            continue;
        }
        turned[first] = Some(false);
        let (mut patch, mut pending) = (Vec::new(), VecDeque::from([(first, false)]));
        while let Some((triangle, is_turned)) = pending.pop_front() {
            patch.push((triangle, is_turned));
            for &(other, is_alike, edge) in &across[triangle] {
                let wanted = is_turned == is_alike;
                match turned[other] {
                    None => {
                        turned[other] = Some(wanted);
                        pending.push_back((other, wanted));
                    }
                    Some(found) if found != wanted => return Err(edge),
                    Some(_) => {}
                }
            }
        }
        let n_turned = patch.iter().filter(|(_, is_turned)| *is_turned).count();
        let most = 2 * n_turned > patch.len();
        for (triangle, is_turned) in patch {
            if is_turned != most {
                triangles[triangle].swap(1, 2);
            }
        }
    }
    Ok(())
}

/// Pairs of sides that bound the same body, at an edge of more than two triangles. Around the edge,
/// material begins behind one face and ends at the next. Sides without a partner are left out.
fn pairs_around(
    vertices_mm: &[DVec3],
    triangles: &[[u32; 3]],
    edge: [u32; 2],
    sides: &[Side],
) -> Vec<(Side, Side)> {
    let [from, to] = edge.map(|vertex| vertices_mm[vertex as usize]);
    let along = (to - from).normalize_or_zero();
    let (right, up) = along.any_orthonormal_pair();
    let mut first_turn = None;
    let mut around: Vec<(i64, bool, Side)> = sides
        .iter()
        .map(|&(triangle, corner)| {
            let apex = vertices_mm[triangles[triangle][(corner + 2) % 3] as usize] - from;
            let turn = DVec2::new(apex.dot(right), apex.dot(up)).to_angle() / std::f64::consts::TAU;
            let first = *first_turn.get_or_insert(turn);
            let steps = ((first - turn) * TURN_STEPS as f64).round() as i64;
            // Material lies behind a face, which is clockwise of a triangle that runs along the
            // edge. Where two faces lie upon each other, the end of material comes before its
            // beginning.
            let begins = ends(triangles, (triangle, corner)) == edge;
            (steps.rem_euclid(TURN_STEPS), begins, (triangle, corner))
        })
        .collect();
    around.sort_unstable();
    let (mut begun, mut pairs): (Vec<Side>, Vec<(Side, Side)>) = (Vec::new(), Vec::new());
    // Goes around twice, because material may extend across the start.
    let mut is_done = vec![false; around.len()];
    for round in 0..2 {
        for (place, &(_, begins, side)) in around.iter().enumerate() {
            if is_done[place] {
                continue;
            }
            if begins {
                if round == 0 {
                    begun.push(side);
                }
            } else if let Some(start) = begun.pop() {
                pairs.push((start, side));
                is_done[place] = true;
            }
        }
    }
    pairs
}
