//! The derivatives of a state ("rates"), and their update by a step.

use std::collections::BTreeSet;

use glam::DVec3;

use super::direction::Direction;
use super::tangent::{ACCURACY, DIFFERENCE_MM, Solution, Tangent};
use crate::Material;
use crate::body::SoftBody;
use crate::contact::Contact;
use crate::element::{self, Forces, Response};
use crate::newton::{Buffers, Failure, Step, Unknowns};
use crate::nodal::{dot, moved};
use crate::relaxation::{History, Relaxation};

/// The derivatives of a state along one direction.
#[derive(Clone)]
pub(crate) struct Sensitivity {
    direction: Direction,
    displacements_mm: Vec<DVec3>,
    pressures_mpa: Vec<f64>,
    history: History,
    /// Derivatives of the contacts' multipliers; and of their gaps at the last equilibrium.
    /// `[n_shapes][n_boundary_nodes]`
    multipliers_mm: Vec<Vec<f64>>,
    gaps_mm: Vec<Vec<f64>>,
    indenter_force_n: DVec3,
}

/// Updates the derivatives to the end of a step that has found its equilibrium.
pub(crate) fn follow(
    body: &SoftBody,
    buffers: &mut Buffers,
    step: &Step,
    x: &mut Unknowns,
    sensitivities: &mut [Sensitivity],
) -> Result<(), Failure> {
    if sensitivities.is_empty() {
        return Ok(());
    }
    let mut before = buffers.old.contacts.clone();
    for mut passed in std::mem::take(&mut buffers.passed) {
        let mut at = Unknowns {
            displacements_mm: &mut passed.displacements_mm,
            pressures_mpa: &mut passed.pressures_mpa,
            contacts: &mut passed.contacts,
        };
        differentiate(body, buffers, step, &mut at, &before, sensitivities)?;
        before = passed.contacts;
    }
    differentiate(body, buffers, step, x, &before, sensitivities)?;
    for sensitivity in sensitivities {
        sensitivity.finish(body, step, x);
    }
    // After this, the buffers again contain the forces of the step.
    buffers
        .evaluate(body, step, x)
        .map(|_| ())
        .ok_or(Failure::Inverted)
}

/// Computes the derivatives of one equilibrium.
fn differentiate(
    body: &SoftBody,
    buffers: &mut Buffers,
    step: &Step,
    x: &mut Unknowns,
    before: &[Contact],
    sensitivities: &mut [Sensitivity],
) -> Result<(), Failure> {
    for sensitivity in &mut *sensitivities {
        sensitivity.follow_multipliers(before, x.contacts);
    }
    buffers.evaluate(body, step, x).ok_or(Failure::Inverted)?;
    buffers.stand_at(x);
    let mut tangent = Tangent::new(body, buffers, step, x);
    sensitivities
        .iter_mut()
        .try_for_each(|sensitivity| sensitivity.solve(buffers, &mut tangent))
}

impl Sensitivity {
    /// Derivatives of zero, for a body at rest with these numbers of nodes and pressures.
    /// `of_touches` are zeros for each shape and node of the boundary.
    pub(crate) fn zero(
        direction: Direction,
        [n_nodes, n_pressures]: [usize; 2],
        history: History,
        of_touches: Vec<Vec<f64>>,
    ) -> Self {
        Self {
            direction,
            displacements_mm: vec![DVec3::ZERO; n_nodes],
            pressures_mpa: vec![0.0; n_pressures],
            history,
            multipliers_mm: of_touches.clone(),
            gaps_mm: of_touches,
            indenter_force_n: DVec3::ZERO,
        }
    }

    /// Prepares for an indenter of `n_parts` parts instead of `n_before`; nothing is in contact
    /// with it yet.
    pub(crate) fn take_parts(&mut self, n_before: usize, n_parts: usize, n_boundary_nodes: usize) {
        for of_touches in [&mut self.multipliers_mm, &mut self.gaps_mm] {
            of_touches.splice(..n_before, vec![vec![0.0; n_boundary_nodes]; n_parts]);
        }
    }

    /// The direction of these derivatives.
    pub(crate) fn direction(&self) -> &Direction {
        &self.direction
    }

    /// Derivatives of the displacements, mm per unit of the parameter; `[n_nodes]`.
    pub(crate) fn displacements_mm(&self) -> &[DVec3] {
        &self.displacements_mm
    }

    /// Derivatives of the pressures, MPa per unit of the parameter; `[n_coarse]`.
    pub(crate) fn history(&self) -> &History {
        &self.history
    }

    pub(crate) fn pressures_mpa(&self) -> &[f64] {
        &self.pressures_mpa
    }

    /// Derivative of the indenter's force, N per unit of the parameter.
    pub(crate) fn indenter_force_n(&self) -> DVec3 {
        self.indenter_force_n
    }

    /// Updates the derivatives of the multipliers from one equilibrium to the next.
    fn follow_multipliers(&mut self, before: &[Contact], now: &[Contact]) {
        let rates = self.multipliers_mm.iter_mut().zip(&self.gaps_mm);
        for ((multiplier_mm, gaps_mm), (before, now)) in rates.zip(before.iter().zip(now)) {
            let touches = before.touches.iter().zip(&now.touches);
            for ((multiplier, gap), (before, now)) in multiplier_mm.iter_mut().zip(gaps_mm).zip(touches) {
                if now.multiplier_mm == 0.0 || before.multiplier_mm == 0.0 {
                    *multiplier = 0.0;
                }
                if now.multiplier_mm > 0.0 && now.multiplier_mm != before.multiplier_mm {
                    *multiplier = (*multiplier - *gap) * before.stiffening / now.stiffening;
                }
            }
        }
    }

    /// Computes the derivatives of displacements, pressures, gaps and the indenter's force.
    fn solve(&mut self, buffers: &mut Buffers, tangent: &mut Tangent) -> Result<(), Failure> {
        let (body, step, x) = (tangent.body, tangent.step, tangent.x);
        let n_free = body.pattern.halves.free;
        let mut unbalanced_n = self.element_forces_n(body, step, x);
        let mut scale_n = dot(&unbalanced_n[..n_free], &unbalanced_n[..n_free]).sqrt();
        let still = vec![DVec3::ZERO; unbalanced_n.len()];
        let mut pushed = still.clone();
        for shape in 0..step.shapes.len() {
            let forces = self.contact_forces_n(body, step, x, shape, &still);
            for ((point, _), force) in x.contacts[shape].each(&body.boundary).zip(forces) {
                for (node, part) in point.parts() {
                    pushed[node as usize] += force * part;
                }
            }
        }
        scale_n += dot(&pushed, &pushed).sqrt();
        for (force, pushed) in unbalanced_n.iter_mut().zip(&pushed) {
            *force = *pushed - *force;
        }
        // In a body at rest, a parameter unbalances nothing but round-off.
        let enough_n = ACCURACY * scale_n.max(body.negligible_load_n());
        let Solution {
            rates_mm,
            rates_mpa,
            left_n,
        } = tangent.solve(buffers, unbalanced_n, enough_n)?;
        let stiffening =
            self.direction.rate(Material::volume_modulus_kpa) / body.material().volume_modulus_kpa();
        self.pressures_mpa = moved(&rates_mpa, x.pressures_mpa, stiffening);
        // As in a frame, the force that is unbalanced at a node in contact is the error of the
        // contact.
        let n_parts = body.n_indenter_parts(x.contacts.len());
        let pushes = (0..n_parts).flat_map(|part| self.contact_forces_n(body, step, x, part, &rates_mm));
        let pushes: DVec3 = pushes.sum();
        let parts = x.contacts[..n_parts].iter();
        let pressed: BTreeSet<u32> = parts
            .flat_map(|contact| contact.pressed_nodes(&body.boundary, n_free))
            .collect();
        let left: DVec3 = pressed.iter().map(|&node| left_n[node as usize]).sum();
        self.indenter_force_n = pushes - left;
        let indenter_mm = self.direction.indenter_mm;
        for (shape, (gaps_mm, contact)) in self.gaps_mm.iter_mut().zip(x.contacts.iter()).enumerate() {
            let shape_mm = if shape < n_parts { indenter_mm } else { DVec3::ZERO };
            for (gap, (point, touch)) in gaps_mm.iter_mut().zip(contact.each(&body.boundary)) {
                *gap = touch.normal.dot(point.value(&rates_mm) - shape_mm);
            }
        }
        self.displacements_mm = rates_mm;
        Ok(())
    }

    /// Derivatives of the elements' forces at fixed displacements, N.
    fn element_forces_n(&self, body: &SoftBody, step: &Step, x: &Unknowns) -> Vec<DVec3> {
        let Response {
            relaxation, history, ..
        } = &step.response;
        let modulus_kpa = body.material().volume_modulus_kpa();
        let mut sums = vec![DVec3::ZERO; x.displacements_mm.len()];
        let (mut forces, mut corners) = (Forces::default(), Vec::new());
        for (material, times) in self.direction.sides() {
            let stiffer = material.volume_modulus_kpa() / modulus_kpa;
            let pressures_mpa: Vec<f64> = x
                .pressures_mpa
                .iter()
                .map(|pressure| pressure * stiffer)
                .collect();
            body.corner_pressures(&pressures_mpa, &mut corners);
            let history = history.combined(1.0, &self.history, times);
            let response = Response::new(material, relaxation.time_step_s, &history);
            body.elements
                .forces(&response, x.displacements_mm, &corners, &mut forces);
            let forces = forces.forces_n.as_flattened();
            for (sum, sources) in sums.iter_mut().zip(body.force_sources.from(0)) {
                *sum += sources
                    .iter()
                    .map(|&source| forces[source as usize])
                    .sum::<DVec3>()
                    * (0.5 / times);
            }
        }
        sums
    }

    /// Derivatives of the forces with which a shape pushes each point of the boundary, N, as the
    /// nodes move; `[n_points]`.
    fn contact_forces_n(
        &self,
        body: &SoftBody,
        step: &Step,
        x: &Unknowns,
        shape: usize,
        rates_mm: &[DVec3],
    ) -> Vec<DVec3> {
        let shear_kpa = |material: &Material| material.model.shear_modulus_kpa();
        let stiffening = self.direction.rate(shear_kpa) / shear_kpa(body.material());
        let shape_mm = if shape < body.n_indenter_parts(step.shapes.len()) {
            self.direction.indenter_mm
        } else {
            DVec3::ZERO
        };
        let rigid = &step.shapes[shape];
        // Quadrature points inside of triangles have no multiplier.
        let multipliers = self.multipliers_mm[shape].iter().chain(std::iter::repeat(&0.0));
        let touches = x.contacts[shape].each(&body.boundary).zip(multipliers);
        touches
            .map(|((point, touch), multiplier_mm)| {
                if touch.force_n <= 0.0 {
                    return DVec3::ZERO;
                }
                let at_mm = body.point_mm(point, x.displacements_mm);
                let way_mm = point.value(rates_mm) - shape_mm;
                let stiffened = touch.normal * touch.force_n * stiffening;
                let largest = way_mm.length().max(multiplier_mm.abs());
                if largest == 0.0 {
                    return stiffened;
                }
                let length = DIFFERENCE_MM / largest;
                let push = |times: f64| {
                    let multiplier_mm = touch.multiplier_mm + multiplier_mm * times;
                    rigid.push_n(touch, point, at_mm + way_mm * times, multiplier_mm)
                };
                stiffened + (push(length) - push(-length)) * (0.5 / length)
            })
            .collect()
    }

    /// Updates the derivatives of the history variables to the end of the step.
    fn finish(&mut self, body: &SoftBody, step: &Step, x: &Unknowns) {
        let Response {
            relaxation, history, ..
        } = &step.response;
        if history.is_empty() {
            return;
        }
        let [before, after] = self.direction.sides().map(|(material, times)| {
            let mut history = history.combined(1.0, &self.history, times);
            let relaxation = Relaxation::new(&material.prony, relaxation.time_step_s);
            let displacements_mm = moved(x.displacements_mm, &self.displacements_mm, times);
            element::update_history(
                &body.elements,
                material,
                &relaxation,
                &displacements_mm,
                &mut history,
            );
            history
        });
        let half = 0.5 / self.direction.step;
        self.history = after.combined(half, &before, -half);
    }
}
