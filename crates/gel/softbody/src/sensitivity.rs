//! How a press changes with its material: direct differentiation of every equilibrium on the way.
//!
//! At an equilibrium the unbalanced forces `g(u, θ)` are zero whatever the parameter `θ` is, so that `K du/dθ = -∂g/∂θ` with the tangent `K`
//! (Haftka and Gürdal, Elements of Structural Optimization, 1992, chapter 7; for materials and contacts that remember: Michaleris, Tortorelli
//! and Vidal, Int. J. Numer. Methods Eng. 37, 1994). `∂g/∂θ` at fixed displacements is a central difference between two materials, whatever
//! their law, and what one step hands to the next, the fading stresses and the contacts' carried depths, is differentiated along. The solver's
//! own tangent, in single precision, only leads the way: residuals are differences of the forces along one direction, in double precision.

mod tangent;

use std::ops::{AddAssign, Mul};

use glam::DVec3;

use crate::body::SoftBody;
use crate::contact::Contact;
use crate::element::{self, Forces, Response};
use crate::newton::{Buffers, Failure, Step, Unknowns};
use crate::relaxation::{Memory, Relaxation};
use crate::state::State;
use crate::{Material, SoftBodyError, SolverSettings};
use tangent::{Solution, Tangent};

/// Farthest that a node moves in a difference of forces, mm: very little of the depth over which a contact's force starts.
const DIFFERENCE_MM: f64 = 1e-8;

/// A rate is known when the 2-norm of what is left unbalanced is below this part of what the parameter unbalances.
const ACCURACY: f64 = 1e-5;

/// A way to change a press: what it depends on a little before and a little after, as one parameter grows.
#[derive(Clone, Debug, PartialEq)]
pub struct Direction {
    /// The material where the parameter is less by a step, and where it is more; with as many Prony terms as the body's.
    pub materials: [Material; 2],
    /// The step, in the unit of the parameter: about 1e-4 of what changes much, so that neither curvature nor round-off counts.
    pub step: f64,
    /// Rate at which all poses of the indenter move, mm over the unit of the parameter.
    pub indenter_mm: DVec3,
}

impl Direction {
    /// Difference quotient of something that materials have.
    fn rate(&self, of: impl Fn(&Material) -> f64) -> f64 {
        let [before, after] = &self.materials;
        (of(after) - of(before)) / (2.0 * self.step)
    }

    /// The materials, and how far from the body's own they are, in the unit of the parameter.
    fn sides(&self) -> [(&Material, f64); 2] {
        let [before, after] = &self.materials;
        [(before, -self.step), (after, self.step)]
    }
}

/// An equilibrium that a step passed, and its contacts before they were carried over.
pub(crate) struct Passed {
    pub(crate) displacements_mm: Vec<DVec3>,
    pub(crate) pressures_mpa: Vec<f64>,
    pub(crate) contacts: Vec<Contact>,
}

/// The rates of a state along one direction.
#[derive(Clone)]
pub(crate) struct Sensitivity {
    direction: Direction,
    displacements_mm: Vec<DVec3>,
    pressures_mpa: Vec<f64>,
    memory: Memory,
    /// Of the depths that contacts carry, and of their gaps at the last equilibrium. `[n_shapes][n_boundary_nodes]`
    carried_mm: Vec<Vec<f64>>,
    gaps_mm: Vec<Vec<f64>>,
    indenter_force_n: DVec3,
}

impl SoftBody {
    /// The body at rest, to be pressed with the rates of all results along some directions kept up to date.
    ///
    /// # Errors
    /// A direction with a step that is not above zero, impossible materials, or another number of Prony terms; a body with friction, whose
    /// rates are not followed.
    pub fn rest_with_sensitivities(&self, directions: &[Direction]) -> Result<State, SoftBodyError> {
        let mut state = self.rest();
        let SolverSettings {
            friction,
            obstacle_friction,
            ..
        } = self.settings;
        for (field, found) in [("friction", friction), ("obstacle_friction", obstacle_friction)] {
            if found > 0.0 {
                let expected = "0 where a press is to be differentiated";
                return Err(SoftBodyError::Setting {
                    field,
                    expected,
                    found,
                });
            }
        }
        for direction in directions {
            for material in &direction.materials {
                material.check()?;
                if material.prony.len() != self.material().prony.len() {
                    return Err(SoftBodyError::Direction);
                }
            }
            if !(direction.step.is_finite() && direction.step > 0.0) {
                return Err(SoftBodyError::Direction);
            }
            let of_touches = vec![vec![0.0; self.boundary.nodes.len()]; state.contacts.len()];
            state.sensitivities.push(Sensitivity {
                direction: direction.clone(),
                displacements_mm: vec![DVec3::ZERO; self.mesh().nodes_mm.len()],
                pressures_mpa: vec![0.0; state.pressures_mpa.len()],
                memory: state.memory.clone(),
                carried_mm: of_touches.clone(),
                gaps_mm: of_touches,
                indenter_force_n: DVec3::ZERO,
            });
        }
        Ok(state)
    }

    /// Rates of the hydrostatic pressure at each node along a state's direction, kPa over the unit of the parameter. `[n_nodes]`
    #[must_use]
    pub fn pressure_sensitivity_kpa(&self, state: &State, direction: usize) -> Vec<f64> {
        let rates = &state.sensitivities[direction];
        let [before, after] = rates.direction.sides().map(|(material, times)| {
            let now = Relaxation::new(&material.prony, 0.0);
            let response = Response {
                material,
                ..self.response(&now, state)
            };
            let displacements_mm = moved(&state.displacements_mm, &rates.displacements_mm, times);
            let pressures_mpa = moved(&state.pressures_mpa, &rates.pressures_mpa, times);
            self.nodal_pressure_kpa(response, &displacements_mm, &pressures_mpa)
        });
        let over = 2.0 * rates.direction.step;
        after
            .iter()
            .zip(before)
            .map(|(after, before)| (after - before) / over)
            .collect()
    }
}

impl State {
    /// Rate of [`crate::Frame::indenter_force_n`] after the last step along each direction, N over the unit of the parameter.
    #[must_use]
    pub fn force_sensitivities_n(&self) -> Vec<DVec3> {
        let rates = self.sensitivities.iter();
        rates.map(|sensitivity| sensitivity.indenter_force_n).collect()
    }
}

/// Takes the rates to the end of a step that has found its equilibrium.
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
    // The buffers hold the forces of the step again.
    buffers
        .evaluate(body, step, x)
        .map(|_| ())
        .ok_or(Failure::Inverted)
}

/// Finds the rates of one equilibrium.
fn differentiate(
    body: &SoftBody,
    buffers: &mut Buffers,
    step: &Step,
    x: &mut Unknowns,
    before: &[Contact],
    sensitivities: &mut [Sensitivity],
) -> Result<(), Failure> {
    buffers.evaluate(body, step, x).ok_or(Failure::Inverted)?;
    buffers.stand_at(x);
    let mut tangent = Tangent::new(body, buffers, step, x);
    for sensitivity in sensitivities {
        sensitivity.carry(before, x.contacts);
        sensitivity.solve(buffers, &mut tangent)?;
    }
    Ok(())
}

impl Sensitivity {
    /// Follows the depths that contacts carry from one equilibrium to the next.
    fn carry(&mut self, before: &[Contact], now: &[Contact]) {
        let rates = self.carried_mm.iter_mut().zip(&self.gaps_mm);
        for ((carried_mm, gaps_mm), (before, now)) in rates.zip(before.iter().zip(now)) {
            let touches = before.touches.iter().zip(&now.touches);
            for ((carried, gap), (before, now)) in carried_mm.iter_mut().zip(gaps_mm).zip(touches) {
                if now.carried_mm == 0.0 || before.carried_mm == 0.0 {
                    *carried = 0.0;
                }
                if now.carried_mm > 0.0 && now.carried_mm != before.carried_mm {
                    *carried = (*carried - *gap) * before.stiffening / now.stiffening;
                }
            }
        }
    }

    /// Finds how displacements, pressures, gaps and the indenter's force change.
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
        // At rest a parameter unbalances nothing but round-off.
        let enough_n = ACCURACY * scale_n.max(body.negligible_load_n());
        let Solution {
            rates_mm,
            rates_mpa,
            left_n,
        } = tangent.solve(buffers, unbalanced_n, enough_n)?;
        let stiffening =
            self.direction.rate(Material::volume_modulus_kpa) / body.material().volume_modulus_kpa();
        self.pressures_mpa = moved(&rates_mpa, x.pressures_mpa, stiffening);
        // As in a frame, what is left unbalanced at a node in touch is the contact's own error.
        let pushes = self.contact_forces_n(body, step, x, 0, &rates_mm);
        let pressed = x.contacts[0].pressed_nodes(&body.boundary, n_free);
        let left: DVec3 = pressed.iter().map(|&node| left_n[node as usize]).sum();
        self.indenter_force_n = pushes.into_iter().sum::<DVec3>() - left;
        for (shape, (gaps_mm, contact)) in self.gaps_mm.iter_mut().zip(x.contacts.iter()).enumerate() {
            let shape_mm = if shape == 0 {
                self.direction.indenter_mm
            } else {
                DVec3::ZERO
            };
            for (gap, (point, touch)) in gaps_mm.iter_mut().zip(contact.each(&body.boundary)) {
                *gap = touch.normal.dot(point.value(&rates_mm) - shape_mm);
            }
        }
        self.displacements_mm = rates_mm;
        Ok(())
    }

    /// Rates of the elements' forces at displacements that stay, N.
    fn element_forces_n(&self, body: &SoftBody, step: &Step, x: &Unknowns) -> Vec<DVec3> {
        let Response {
            relaxation, memory, ..
        } = step.response;
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
            let response = Response {
                material,
                relaxation: &Relaxation::new(&material.prony, relaxation.time_step_s),
                memory: &memory.combined(1.0, &self.memory, times),
            };
            body.elements
                .forces(response, x.displacements_mm, &corners, &mut forces);
            let forces = forces.forces_n.as_flattened();
            for (sum, range) in sums.iter_mut().zip(body.force_starts.windows(2)) {
                let sources = &body.force_sources[range[0] as usize..range[1] as usize];
                *sum += sources
                    .iter()
                    .map(|&source| forces[source as usize])
                    .sum::<DVec3>()
                    * (0.5 / times);
            }
        }
        sums
    }

    /// Rates of the forces with which a shape pushes each point of the boundary, N, as the nodes move. `[n_points]`
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
        let shape_mm = if shape == 0 {
            self.direction.indenter_mm
        } else {
            DVec3::ZERO
        };
        let rigid = &step.shapes[shape];
        // Places inside triangles carry nothing.
        let carried = self.carried_mm[shape].iter().chain(std::iter::repeat(&0.0));
        let touches = x.contacts[shape].each(&body.boundary).zip(carried);
        touches
            .map(|((point, touch), carried_mm)| {
                if touch.force_n <= 0.0 {
                    return DVec3::ZERO;
                }
                let at_mm = body.point_mm(point, x.displacements_mm);
                let way_mm = point.value(rates_mm) - shape_mm;
                let stiffened = touch.normal * touch.force_n * stiffening;
                let largest = way_mm.length().max(carried_mm.abs());
                if largest == 0.0 {
                    return stiffened;
                }
                let length = DIFFERENCE_MM / largest;
                let push = |times: f64| {
                    let carried_mm = touch.carried_mm + carried_mm * times;
                    rigid.push_n(touch, point, at_mm + way_mm * times, carried_mm)
                };
                stiffened + (push(length) - push(-length)) * (0.5 / length)
            })
            .collect()
    }

    /// Takes the rates of the memory to the end of the step.
    fn finish(&mut self, body: &SoftBody, step: &Step, x: &Unknowns) {
        let Response {
            relaxation, memory, ..
        } = step.response;
        if memory.is_empty() {
            return;
        }
        let [before, after] = self.direction.sides().map(|(material, times)| {
            let mut memory = memory.combined(1.0, &self.memory, times);
            let relaxation = Relaxation::new(&material.prony, relaxation.time_step_s);
            let displacements_mm = moved(x.displacements_mm, &self.displacements_mm, times);
            element::remember(
                &body.elements,
                material,
                &relaxation,
                &displacements_mm,
                &mut memory,
            );
            memory
        });
        let half = 0.5 / self.direction.step;
        self.memory = after.combined(half, &before, -half);
    }
}

/// So many times the other added.
fn moved<T: Copy + AddAssign + Mul<f64, Output = T>>(from: &[T], other: &[T], times: f64) -> Vec<T> {
    let mut sums = from.to_vec();
    add(&mut sums, other, times);
    sums
}

/// Adds so many times the other.
fn add<T: Copy + AddAssign + Mul<f64, Output = T>>(sums: &mut [T], other: &[T], times: f64) {
    for (sum, other) in sums.iter_mut().zip(other) {
        *sum += *other * times;
    }
}

fn dot(a: &[DVec3], b: &[DVec3]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a.dot(*b)).sum()
}
