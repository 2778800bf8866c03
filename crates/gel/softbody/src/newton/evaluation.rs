//! The energy of a step, and its gradient.

use glam::DVec3;

use super::step::{Evaluation, Step, Unknowns};
use super::workspace::Buffers;
use crate::body::SoftBody;
use crate::clock::Instant;
use crate::contact::for_each_contact;
use crate::parallel::join_halves;

impl Buffers {
    /// Computes pressures, contact, the energy and its gradient; `None` if a tetrahedron is
    /// inverted and the material is not defined for that.
    pub(crate) fn evaluate(&mut self, body: &SoftBody, step: &Step, x: &mut Unknowns) -> Option<Evaluation> {
        self.evaluate_elements(body, step, x)?;
        self.evaluate_again(body, step, x)
    }

    /// Computes pressures, and the energy and the forces of the elements.
    fn evaluate_elements(&mut self, body: &SoftBody, step: &Step, x: &mut Unknowns) -> Option<()> {
        let started = Instant::now();
        let mut evaluation = Evaluation {
            smallest_volume_ratio: body.elements.volumes(x.displacements_mm, &mut self.volumes),
            ..Evaluation::default()
        };
        if !is_admissible(body, evaluation.smallest_volume_ratio) {
            return None;
        }
        let changes = self.volumes.changes_mm3.as_flattened();
        let half = x.pressures_mpa.len() / 2;
        let (first, second) = x.pressures_mpa.split_at_mut(half);
        let squeeze = |first: usize, pressures_mpa: &mut [f64]| -> f64 {
            let stiffness = &body.volume_stiffness[first..];
            let nodes = pressures_mpa
                .iter_mut()
                .zip(stiffness)
                .zip(body.volume_sources.from(first));
            let energies = nodes.map(|((pressure, stiffness), sources)| {
                let change: f64 = sources.iter().map(|&source| changes[source as usize]).sum();
                *pressure = -stiffness * change;
                0.5 * stiffness * change * change
            });
            energies.sum()
        };
        let energies = join_halves(|| squeeze(0, first), || squeeze(half, second));
        evaluation.energy += energies.0 + energies.1;

        body.corner_pressures(x.pressures_mpa, &mut self.corners);
        body.elements.forces(
            &step.response,
            x.displacements_mm,
            &self.corners,
            &mut self.forces,
        );
        evaluation.energy += self.forces.energies.iter().sum::<f64>();
        self.of_elements = evaluation;
        self.cost.forces_s += started.elapsed().as_secs_f64();
        Some(())
    }

    /// Like [`Self::evaluate`], at the displacements of the last evaluation, where only contacts
    /// have changed since.
    pub(super) fn evaluate_again(
        &mut self,
        body: &SoftBody,
        step: &Step,
        x: &mut Unknowns,
    ) -> Option<Evaluation> {
        let started = Instant::now();
        let mut evaluation = self.of_elements;
        let forces = self.forces.forces_n.as_flattened();
        let half = self.gradient_n.len() / 2;
        let (first, second) = self.gradient_n.split_at_mut(half);
        let gather = |first: usize, gradients: &mut [DVec3]| {
            for (gradient, sources) in gradients.iter_mut().zip(body.force_sources.from(first)) {
                *gradient = sources.iter().map(|&source| forces[source as usize]).sum();
            }
        };
        join_halves(|| gather(0, first), || gather(half, second));
        self.cost.forces_s += started.elapsed().as_secs_f64();

        let started = Instant::now();
        let nodes_mm = &body.mesh.nodes_mm;
        let before_mm = |node: u32| nodes_mm[node as usize] + self.old.displacements_mm[node as usize];
        let now_mm = |node: u32| nodes_mm[node as usize] + x.displacements_mm[node as usize];
        self.boundary_mm.clear();
        self.boundary_mm
            .extend(body.boundary_mm(x.displacements_mm).map(|(_, at_mm)| at_mm));
        let (boundary_mm, displacements_mm) = (&self.boundary_mm, &*x.displacements_mm);
        let energies = for_each_contact(step.shapes, x.contacts, |_, shape, contact| {
            contact.check_room(shape, &body.boundary, [&before_mm, &now_mm]);
            // The nodes of the boundary are the first points.
            let points = contact.each_mut(&body.boundary).enumerate();
            let energies = points.map(|(index, (point, touch))| {
                let of_node_mm = boundary_mm.get(index).copied();
                let at_mm = of_node_mm.unwrap_or_else(|| body.point_mm(point, displacements_mm));
                shape.touch(touch, point, at_mm)
            });
            energies.sum::<f64>()
        });
        evaluation.energy += energies.iter().sum::<f64>();
        for (shape, contact) in step.shapes.iter().zip(x.contacts.iter_mut()) {
            for (point, touch) in contact.each(&body.boundary) {
                if touch.force_n > 0.0 {
                    for (node, part) in point.parts() {
                        self.gradient_n[node as usize] -= touch.normal * (part * touch.force_n);
                    }
                    evaluation.load_n += touch.force_n;
                }
            }
            if let Some((friction, _)) = contact.friction_mut() {
                let nodes = body.boundary_mm(x.displacements_mm);
                evaluation.energy += friction.pull(shape, nodes, |point, force_n| {
                    for (node, part) in point.parts() {
                        self.gradient_n[node as usize] -= force_n * part;
                    }
                });
            }
        }
        self.cost.contact_s += started.elapsed().as_secs_f64();
        for &(node, force) in &body.loads_n {
            evaluation.energy -= force.dot(x.displacements_mm[node as usize]);
            self.gradient_n[node as usize] -= force;
            evaluation.load_n += force.length();
        }
        let (free, bonded) = self.gradient_n.split_at(body.pattern.halves.free);
        let largest = bonded.iter().map(|force| force.length()).fold(0.0, f64::max);
        evaluation.load_n = evaluation.load_n.max(largest);
        evaluation.unbalanced_n = free
            .iter()
            .map(|force| force.length_squared())
            .sum::<f64>()
            .sqrt();
        evaluation.energy.is_finite().then_some(evaluation)
    }
}

/// Whether the energy is defined for this smallest volume ratio.
fn is_admissible(body: &SoftBody, smallest_volume_ratio: f64) -> bool {
    smallest_volume_ratio > 0.0
        || (body.material.model.properties().bears_inversion && !smallest_volume_ratio.is_nan())
}
