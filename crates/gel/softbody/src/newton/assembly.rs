//! The tangent: the matrix of the fine system, and the factors of the coarse one.

use glam::{DMat3, DVec3, Mat3, Vec3};

use super::step::{Failure, Step, Unknowns};
use super::workspace::{Buffers, Workspace};
use crate::body::SoftBody;
use crate::clock::Instant;
use crate::contact::ContactPoint;
use crate::element::{CoarseSink, Response, Sink};
use crate::linear::block::Vector;
use crate::linear::coarse::Factors;
use crate::relaxation::History;
use crate::wide::LANES;

/// Factors of a body at rest, with which all of its presses start.
pub(crate) fn rest_factors(body: &SoftBody) -> Option<Factors> {
    let history = History::new(body.elements.n_points(), &body.material.prony);
    let step = Step {
        response: Response::new(&body.material, 0.0, &history),
        shapes: &[],
    };
    let x = Unknowns {
        displacements_mm: &mut vec![DVec3::ZERO; body.mesh.nodes_mm.len()],
        pressures_mpa: &mut vec![0.0; body.volume_stiffness.len()],
        contacts: &mut Vec::new(),
    };
    let mut workspace = Workspace::default();
    let buffers = workspace.buffers(body);
    buffers.factorise(body, &step, &x).ok()?;
    buffers.factors.take()
}

impl Buffers {
    /// Factorizes the coarse tangent: the true one if it is convex, otherwise one that is made
    /// stiffer until it is.
    pub(super) fn factorise(&mut self, body: &SoftBody, step: &Step, x: &Unknowns) -> Result<(), Failure> {
        let started = Instant::now();
        self.factors = None;
        self.assemble_coarse(body, step, x);
        let tangent = self
            .tangent
            .get_or_insert_with(|| Box::new(body.coarse.tangent()));
        for extra in [0.0, 0.02, 0.1, 0.5, 2.0, 10.0] {
            let slots = body.elements.slots.iter();
            let of_elements = slots.map(|&slot| &self.coarse_tangents[slot as usize]);
            body.coarse.fill(tangent, of_elements);
            for_each_touch(body, step, x, &mut |_, point, stiffness| {
                let ends = point.parts().flat_map(|(node, part)| {
                    let ends = body.ends[node as usize];
                    ends.map(|end| (end, 0.5 * part as f32))
                });
                body.coarse.add_at(tangent, ends, &stiffness.as_mat3());
            });
            let damping = self.damping + extra;
            if damping > 0.0 {
                for (ends, stiffness) in body.ends.iter().zip(&body.node_stiffness) {
                    if ends[0] == ends[1] {
                        let own = Mat3::from_diagonal(Vec3::splat((damping * stiffness) as f32));
                        body.coarse.add_to_node(tangent, ends[0], &own);
                    }
                }
            }
            self.factors = body.coarse.factorise(tangent).map_err(|_| Failure::Singular)?;
            if self.factors.is_some() {
                self.cost.factorisation_s += started.elapsed().as_secs_f64();
                self.cost.factorisations += 1;
                return Ok(());
            }
        }
        Err(Failure::Singular)
    }

    fn assemble_coarse(&mut self, body: &SoftBody, step: &Step, x: &Unknowns) {
        body.corner_pressures(&self.foreseen_mpa, &mut self.corners);
        let (elements, u) = (&body.elements, &*x.displacements_mm);
        let [first, second] = elements.halves.map(|pack| pack * LANES);
        let (tangents, between) = self.coarse_tangents.split_at_mut(second);
        let halves = tangents.split_at_mut(first);
        let sink = |first, tangents| CoarseSink { first, tangents };
        let sinks: [&mut dyn Sink; 2] = [&mut sink(0, halves.0), &mut sink(first, halves.1)];
        elements.tangents(&step.response, u, &self.corners, sinks);
        elements.tangents_between(&step.response, u, &self.corners, &mut sink(second, between));
    }

    /// Assembles the part of the elements in the fine matrix.
    pub(crate) fn assemble(&mut self, body: &SoftBody, step: &Step, x: &Unknowns) {
        body.corner_pressures(&self.foreseen_mpa, &mut self.corners);
        let (elements, u) = (&body.elements, &*x.displacements_mm);
        let halves = &mut self.matrix.halves(&body.pattern);
        let [first, second] = halves;
        elements.tangents(&step.response, u, &self.corners, [first, second]);
        let between = &mut self.matrix.between(&body.pattern);
        elements.tangents_between(&step.response, u, &self.corners, between);
        self.matrix.scale_slopes(&body.pattern);
    }

    /// The product of the matrix and a vector at the free nodes.
    pub(crate) fn product(&self, body: &SoftBody, x: &[Vector]) -> Vec<Vector> {
        self.matrix.product(&body.pattern, x)
    }

    /// Adds contact and damping to the matrix.
    pub(crate) fn add_contact(&mut self, body: &SoftBody, step: &Step, x: &Unknowns) {
        self.matrix.take_back(self.damping, &body.node_stiffness);
        for_each_touch(body, step, x, &mut |_, point, stiffness| {
            self.matrix
                .add_at(&body.pattern, point.parts(), &stiffness.as_mat3());
        });
        self.matrix.complete(&body.pattern);
    }
}

/// Calls `add` with the stiffness of every point in contact, and with that of friction, N/mm, and
/// the index of the shape.
pub(super) fn for_each_touch(
    body: &SoftBody,
    step: &Step,
    x: &Unknowns,
    add: &mut dyn FnMut(usize, &ContactPoint, &DMat3),
) {
    for (of, (shape, contact)) in step.shapes.iter().zip(x.contacts.iter()).enumerate() {
        for (point, touch) in contact.each(&body.boundary) {
            if touch.force_n > 0.0 {
                let at_mm = body.point_mm(point, x.displacements_mm);
                add(of, point, &shape.stiffness(touch, point, at_mm));
            }
        }
        let Some(friction) = contact.friction() else {
            continue;
        };
        for (index, (point, at_mm)) in body.boundary_mm(x.displacements_mm).enumerate() {
            if let Some(stiffness) = friction.stiffness(index, shape, at_mm, point.stiffness) {
                add(of, point, &stiffness);
            }
        }
    }
}
