//! Contact of the whole boundary with one shape.

use std::collections::BTreeSet;

use glam::DVec3;

use super::boundary::Boundary;
use super::friction::Friction;
use super::point::ContactPoint;
use super::rigid_body::RigidBody;
use super::room::Room;
use super::touch::Touch;
use super::triangle::{BoundaryTriangle, SIDES};

/// Factor by which a contact is made stiffer if an update of its multiplier does not push it out.
const STIFFENING: f64 = 4.0;

/// An update has not pushed a node out if more than this fraction of the depth remains.
const STUCK: f64 = 0.5;

/// Difference of the normals at two corners, as unit vectors, above which a shape turns sharply.
const SHARP: f64 = 0.5;

/// Difference of the normals at two corners, as unit vectors, above which they are on sides that
/// face away from each other.
const TURNED_AWAY: f64 = 1.6;

/// Contact of the boundary with one shape.
#[derive(Debug)]
pub(crate) struct Contact {
    /// Contact of its nodes; `[n_boundary_nodes]`.
    pub(crate) touches: Vec<Touch>,
    /// Distance to the shape. As long as there is one, nothing of the contact is computed.
    pub(super) room: Option<Room>,
    /// Number of steps before the distance is measured again.
    pub(super) steps_until_look: u32,
    /// The quadrature points inside of its triangles that are in use.
    inside: Vec<Inside>,
    /// Those for the displacements at the end of the step, if the step ended with a look at them.
    inside_next: Option<Vec<Inside>>,
    /// Depth of the deepest node when nodes were last pushed out in this step, mm.
    pushed_mm: f64,
    /// `None` if the coefficient is zero.
    pub(super) friction: Option<Friction>,
}

/// A quadrature point inside a triangle, and its contact.
#[derive(Clone, Debug)]
struct Inside {
    point: ContactPoint,
    /// Longest edge of its undeformed triangle, mm.
    edge_mm: f64,
    touch: Touch,
}

impl Clone for Contact {
    fn clone(&self) -> Self {
        Self {
            touches: self.touches.clone(),
            room: self.room.clone(),
            steps_until_look: self.steps_until_look,
            inside: self.inside.clone(),
            inside_next: None,
            pushed_mm: self.pushed_mm,
            friction: self.friction.clone(),
        }
    }

    /// Reuses the memory, because every step begins with this copy.
    fn clone_from(&mut self, source: &Self) {
        // Nothing of a contact changes as long as its distance is valid.
        if let (Some(room), Some(other)) = (&self.room, &source.room)
            && room.is_same(other)
        {
            return;
        }
        self.room.clone_from(&source.room);
        self.steps_until_look = source.steps_until_look;
        self.touches.clone_from(&source.touches);
        self.inside.clone_from(&source.inside);
        self.inside_next = None;
        self.pushed_mm = source.pushed_mm;
        self.friction.clone_from(&source.friction);
    }
}

impl Contact {
    /// No contact yet.
    pub(crate) fn new(n_boundary_nodes: usize, friction: f64) -> Self {
        Self {
            touches: vec![Touch::OFF; n_boundary_nodes],
            room: None,
            steps_until_look: 0,
            inside: Vec::new(),
            inside_next: None,
            pushed_mm: f64::INFINITY,
            friction: (friction > 0.0).then(|| Friction::new(friction, n_boundary_nodes)),
        }
    }

    /// All points that the shape may touch, and their contact: all nodes first, or no points at
    /// all.
    pub(crate) fn each<'a>(
        &'a self,
        boundary: &'a Boundary,
    ) -> impl Iterator<Item = (&'a ContactPoint, &'a Touch)> {
        let inside = self.inside.iter().map(|inside| (&inside.point, &inside.touch));
        self.nodes(boundary).iter().zip(&self.touches).chain(inside)
    }

    /// The same, mutable.
    pub(crate) fn each_mut<'a>(
        &'a mut self,
        boundary: &'a Boundary,
    ) -> impl Iterator<Item = (&'a ContactPoint, &'a mut Touch)> {
        let nodes = self.nodes(boundary);
        let inside = self.inside.iter_mut();
        let inside = inside.map(|inside| (&inside.point, &mut inside.touch));
        nodes.iter().zip(&mut self.touches).chain(inside)
    }

    /// The boundary's nodes, if the shape may touch any.
    fn nodes<'a>(&self, boundary: &'a Boundary) -> &'a [ContactPoint] {
        if self.room.is_some() { &[] } else { &boundary.nodes }
    }

    /// Friction on the nodes, if there is any and the shape may touch them.
    pub(crate) fn friction(&self) -> Option<&Friction> {
        self.friction.as_ref().filter(|_| self.room.is_none())
    }

    /// The same, mutable, and the contact of the nodes.
    pub(crate) fn friction_mut(&mut self) -> Option<(&mut Friction, &[Touch])> {
        let friction = self.friction.as_mut().filter(|_| self.room.is_none())?;
        Some((friction, &self.touches))
    }

    /// All points, and the force of the shape on each, N.
    pub(crate) fn forces_n<'a>(
        &'a self,
        boundary: &'a Boundary,
    ) -> impl Iterator<Item = (&'a ContactPoint, DVec3)> {
        self.each(boundary).enumerate().map(|(index, (point, touch))| {
            let pushed_n = touch.normal * touch.force_n;
            let friction = self.friction.as_ref().filter(|_| index < boundary.nodes.len());
            let force_n = friction.map_or(pushed_n, |friction| pushed_n + friction.force_n(index));
            (point, force_n)
        })
    }

    /// Free nodes that the shape presses on, or that belong to a point that it presses on;
    /// ascending.
    pub(crate) fn pressed_nodes(&self, boundary: &Boundary, n_free: usize) -> BTreeSet<u32> {
        let pressed = self.each(boundary).filter(|(_, touch)| touch.force_n > 0.0);
        let nodes = pressed.flat_map(|(point, _)| point.parts().map(|(node, _)| node));
        nodes.filter(|&node| (node as usize) < n_free).collect()
    }

    /// Makes the present forces the multipliers of the next step.
    pub(crate) fn update_multipliers(&mut self) {
        if self.room.is_some() {
            return;
        }
        self.touches
            .iter_mut()
            .for_each(|touch| touch.update_multiplier(1.0));
        self.pushed_mm = f64::INFINITY;
    }

    /// Updates the multipliers within a step if nodes are deeper than allowed; returns whether
    /// there are any. Nodes that an update has not moved out are also made stiffer: otherwise
    /// neighbours on a convex edge could slip off it in turns, without end.
    pub(crate) fn push_out(&mut self, allowed_mm: f64) -> bool {
        let deepest_mm = self.penetration_mm();
        if deepest_mm <= allowed_mm {
            return false;
        }
        let is_stuck = deepest_mm > STUCK * self.pushed_mm;
        self.pushed_mm = deepest_mm;
        for touch in &mut self.touches {
            let is_deep = is_stuck && touch.gap_mm < -allowed_mm;
            touch.update_multiplier(touch.stiffening * if is_deep { STIFFENING } else { 1.0 });
        }
        true
    }

    /// The quadrature points inside of triangles, the longest edge of each one's undeformed
    /// triangle, mm, and their contact.
    pub(super) fn points_inside(&self) -> impl Iterator<Item = (&ContactPoint, f64, &Touch)> {
        let inside = self.inside.iter();
        inside.map(|inside| (&inside.point, inside.edge_mm, &inside.touch))
    }

    /// Whether no contact is left that is pushed or held by friction.
    pub(super) fn is_untouched(&self) -> bool {
        let is_off = |touch: &Touch| touch.force_n <= 0.0 && touch.multiplier_mm <= 0.0;
        self.touches.iter().all(is_off) && self.friction.as_ref().is_none_or(Friction::holds_nothing)
    }

    /// Sets all multipliers to zero.
    pub(crate) fn drop_multipliers(&mut self) {
        self.touches
            .iter_mut()
            .for_each(|touch| touch.multiplier_mm = 0.0);
    }

    /// Depth of the deepest node, mm.
    pub(crate) fn penetration_mm(&self) -> f64 {
        let touches = self
            .touches
            .iter()
            .take(if self.room.is_some() { 0 } else { usize::MAX });
        touches.fold(0.0, |deepest, touch| f64::max(deepest, -touch.gap_mm))
    }

    /// Invalidates the distances, because the shape may be another one now.
    pub(crate) fn forget_distances(&mut self) {
        self.touches.iter_mut().for_each(|touch| touch.measured_mm = 0.0);
    }

    /// Chooses the quadrature points again for the present deformation. Returns true if they are in
    /// other triangles than before; otherwise the previous ones are kept.
    pub(crate) fn look_again(
        &mut self,
        shape: &RigidBody,
        boundary: &Boundary,
        node_mm: &dyn Fn(u32) -> DVec3,
    ) -> bool {
        let before = std::mem::take(&mut self.inside);
        self.inside_next = None;
        self.look_inside(shape, boundary, node_mm);
        let triangles = |inside: &[Inside]| -> Vec<[u32; 3]> {
            inside.iter().map(|inside| inside.point.corners()).collect()
        };
        let is_other = triangles(&before) != triangles(&self.inside);
        if !is_other {
            let next = std::mem::replace(&mut self.inside, before);
            self.inside_next = self.room.is_none().then_some(next);
        }
        is_other
    }

    /// Chooses the quadrature points of a step for a shape that has not moved since the last step.
    pub(crate) fn look_inside_again(
        &mut self,
        shape: &RigidBody,
        boundary: &Boundary,
        node_mm: &dyn Fn(u32) -> DVec3,
    ) {
        match self.inside_next.take() {
            Some(inside) if self.room.is_none() => self.inside = inside,
            _ => self.look_inside(shape, boundary, node_mm),
        }
    }

    /// Chooses the quadrature points of a step: inside of triangles where the normal of the shape
    /// turns sharply.
    pub(crate) fn look_inside(
        &mut self,
        shape: &RigidBody,
        boundary: &Boundary,
        node_mm: &dyn Fn(u32) -> DVec3,
    ) {
        self.inside.clear();
        if self.room.is_some() {
            return;
        }
        let nodes = boundary.nodes.iter().zip(&mut self.touches);
        let mut normals: Vec<Option<DVec3>> = nodes
            .zip(&boundary.reach_mm)
            .map(|((point, touch), reach_mm)| {
                let at_mm = point.parts().map(|(node, _)| node_mm(node)).sum();
                shape.normal_within(touch, at_mm, *reach_mm)
            })
            .collect();
        let is_near: Vec<bool> = normals.iter().map(Option::is_some).collect();
        if !is_near.contains(&true) {
            return;
        }
        let mut normals_of = |triangle: &BoundaryTriangle| {
            [0, 1, 2].map(|corner| {
                let normal = || shape.normal(node_mm(triangle.nodes[corner]));
                match triangle.corners[corner] {
                    Some(index) => *normals[index as usize].get_or_insert_with(normal),
                    None => normal(),
                }
            })
        };
        // Where the shape turns sharply within a triangle, and beside that, because gel that slides
        // around a rim takes its neighbours there within the step.
        let mut is_at_rim = vec![false; boundary.nodes.len()];
        for triangle in &boundary.triangles {
            if triangle.free_corners().any(|corner| is_near[corner]) {
                let normals = normals_of(triangle);
                let is_sharp = |[a, b]: [usize; 2]| normals[a].distance(normals[b]) > SHARP;
                if SIDES.into_iter().any(is_sharp) {
                    triangle
                        .free_corners()
                        .for_each(|corner| is_at_rim[corner] = true);
                }
            }
        }
        for triangle in &boundary.triangles {
            if triangle.free_corners().any(|corner| is_at_rim[corner]) {
                let at_mm = triangle.nodes.map(node_mm);
                let normals = normals_of(triangle);
                let bends_mm =
                    SIDES.map(|[a, b]| shape.bend_mm([at_mm[a], at_mm[b]], [normals[a], normals[b]]));
                let is_across_wall = SIDES
                    .iter()
                    .any(|[a, b]| normals[*a].distance(normals[*b]) > TURNED_AWAY);
                let points = triangle.points(bends_mm, is_across_wall);
                self.inside.extend(points.map(|point| Inside {
                    point,
                    edge_mm: triangle.longest_mm,
                    touch: Touch::OFF,
                }));
            }
        }
    }
}
