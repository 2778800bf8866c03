//! Contact inside the boundary's triangles, where a shape turns sharply within one, as at the rim of a punch.
//!
//! Nodes alone let a triangle cut such a corner, and what flows out from under a punch takes its short edges along: at depth, long ones lie
//! across the rim. So places inside triangles are pushed out too, but for the depth that a flat triangle has in an arc between the same normals:
//! where shapes are smooth nodes do alone. Exactly out the places can't be, as there are more of them than the nodes have freedoms: they are
//! softer than nodes, and carry nothing over.

use std::collections::BTreeMap;

use glam::DVec3;

use super::{Boundary, Contact, ContactPoint, RigidBody, Touch};

/// Parts along each side of a triangle into which it is cut; contact is asked about in the middle of each.
const CUTS: u32 = 3;

/// Corners of each side.
const SIDES: [[usize; 2]; 3] = [[0, 1], [1, 2], [2, 0]];

/// Difference of the normals at two corners, as unit vectors, above which a shape turns sharply.
const SHARP: f64 = 0.5;

/// How much deeper than in an arc places may be: none is to be in touch because of what an arc is not quite.
const MARGIN: f64 = 1.25;

/// Stiffness of the places inside as part of that of nodes.
const SOFTNESS: f64 = 0.5;

/// A triangle of the boundary.
pub(crate) struct BoundaryTriangle {
    nodes: [u32; 3],
    /// Places of its free corners among the boundary's nodes.
    free: Vec<u32>,
    /// Of all places inside together, N/mm.
    stiffness: f64,
    pub(super) longest_mm: f64,
}

/// A place inside a triangle, and what it feels.
#[derive(Clone, Debug)]
pub(crate) struct Inside {
    pub(crate) point: ContactPoint,
    pub(crate) touch: Touch,
}

impl BoundaryTriangle {
    /// A triangle that has such free corners; `stiffness` is that of contact per area and inverse edge, MPa.
    pub(crate) fn new(nodes: [u32; 3], at_mm: [DVec3; 3], free: Vec<u32>, stiffness: f64) -> Self {
        let [a, b, c] = at_mm;
        let area_mm2 = 0.5 * (b - a).cross(c - a).length();
        let size_mm = (2.0 * area_mm2).sqrt();
        Self {
            nodes,
            free,
            stiffness: SOFTNESS * stiffness * area_mm2 / size_mm,
            longest_mm: a.distance(b).max(b.distance(c)).max(c.distance(a)),
        }
    }

    /// Its free corners, by their places among the boundary's nodes.
    pub(super) fn free_corners(&self) -> impl Iterator<Item = usize> {
        self.free.iter().map(|&corner| corner as usize)
    }

    /// The places inside, where its corners are and the shape has such normals beside them.
    fn places(&self, at_mm: [DVec3; 3], normals: [DVec3; 3]) -> impl Iterator<Item = ContactPoint> {
        let stiffness = self.stiffness / f64::from(CUTS * CUTS);
        let bends_mm = SIDES.map(|[a, b]| at_mm[a].distance(at_mm[b]) * normals[a].distance(normals[b]));
        middles().map(move |weights| {
            // Of an arc of curvature c, whose normals differ by c l over a length l: c/2 times the sum of w w l² over the sides.
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
fn middles() -> impl Iterator<Item = [f64; 3]> {
    let part = |value: u32| f64::from(value) / f64::from(3 * CUTS);
    (0..CUTS).flat_map(move |row| {
        // From the first corner on, a row has parts that stand upright, and between them others upside down.
        (0..2 * row + 1).map(move |place| {
            let (away, along) = if place % 2 == 0 { (2, 1) } else { (1, 2) };
            let (away, along) = (3 * row + away, 3 * (place / 2) + along);
            [1.0 - part(away), part(away - along), part(along)]
        })
    })
}

impl Contact {
    /// Chooses the places inside triangles to watch during a step: where the shape turns sharply.
    pub(crate) fn look_inside(
        &mut self,
        shape: &RigidBody,
        boundary: &Boundary,
        node_mm: &dyn Fn(u32) -> DVec3,
    ) {
        self.inside.clear();
        let nodes = boundary.nodes.iter().zip(&mut self.touches);
        let is_near: Vec<bool> = nodes
            .zip(&boundary.reach_mm)
            .map(|((point, touch), reach_mm)| {
                let at_mm = point.parts().map(|(node, _)| node_mm(node)).sum();
                shape.is_within(touch, at_mm, *reach_mm)
            })
            .collect();
        if !is_near.contains(&true) {
            return;
        }
        let mut known = BTreeMap::new();
        for triangle in &boundary.triangles {
            if !triangle.free_corners().any(|corner| is_near[corner]) {
                continue;
            }
            let at_mm = triangle.nodes.map(node_mm);
            let normals = [0, 1, 2].map(|corner| {
                let normal = known.entry(triangle.nodes[corner]);
                *normal.or_insert_with(|| shape.normal(at_mm[corner]))
            });
            let is_sharp = |[a, b]: [usize; 2]| normals[a].distance(normals[b]) > SHARP;
            if SIDES.into_iter().any(is_sharp) {
                let places = triangle.places(at_mm, normals);
                self.inside.extend(places.map(|point| Inside {
                    point,
                    touch: Touch::OFF,
                }));
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn places_spread_evenly_over_a_triangle() {
        let places: Vec<DVec3> = middles().map(DVec3::from_array).collect();
        assert_eq!(places.len(), (CUTS * CUTS) as usize);
        let mean = places.iter().sum::<DVec3>() / places.len() as f64;
        assert!((mean - DVec3::splat(1.0 / 3.0)).length() < 1e-12);
        for (i, a) in places.iter().enumerate() {
            assert!(a.min_element() > 0.0 && (a.element_sum() - 1.0).abs() < 1e-12);
            for b in &places[i + 1..] {
                assert!(a.distance(*b) > 0.2, "{a} {b}");
            }
        }
    }
}
