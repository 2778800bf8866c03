//! The iteration: directions, and steps along them, until the forces are balanced and no node is
//! too deep inside of a shape.

use super::step::{Equilibrium, Failure, Passed, Start, Step, Unknowns};
use super::workspace::Buffers;
use crate::body::SoftBody;
use crate::clock::Instant;
use crate::contact::Contact;

/// Accuracy of a direction: conjugate gradients end when an iteration adds less than the square of
/// this to the decrease of energy.
const FORCING: f64 = 0.25;

/// Fraction of the tolerance below which the start of a new step is accepted as its solution. It
/// is small, because errors must not accumulate over steps.
const UNTOUCHED: f64 = 0.1;

/// Unbalanced forces over the load below which a step that a deadline has ended is left as it is.
/// Otherwise it is continued to there: multipliers and extrapolations follow from the end of a
/// step, and would carry its errors on.
pub(crate) const ALMOST: f64 = 0.01;

/// If more than this fraction of the unbalanced forces remains after a step, a new matrix is
/// needed.
const SLOW: f64 = 0.4;

/// A step is short if its length is below this fraction of its direction.
const SHORT: f64 = 0.2;

/// Smallest nonzero damping.
const LEAST_DAMPING: f64 = 0.01;

impl Buffers {
    /// Finds the equilibrium of a step, starting from the given unknowns. `iterations` is
    /// increased. If the step has a deadline, it ends after the first iteration at which another
    /// iteration of the same duration would be late; a step that goes on, where the forces are
    /// almost balanced.
    pub(crate) fn solve(
        &mut self,
        body: &SoftBody,
        step: &Step,
        x: &mut Unknowns,
        start: Start,
        iterations: &mut u32,
    ) -> Result<Equilibrium, Failure> {
        self.damping = 0.0;
        let settings = &body.settings;
        let mut now = match start {
            Start::Anew | Start::GoOn => self.evaluate(body, step, x),
            Start::Again => self.evaluate_again(body, step, x),
        }
        .ok_or(Failure::Inverted)?;
        let mut has_failed = false;
        let mut began = Instant::now();
        for iteration in 0..=settings.max_iterations {
            let residual = now.unbalanced_n / now.load_n.max(body.least_load_n());
            let is_anew = iteration == 0 && start == Start::Anew;
            let goal = if is_anew { UNTOUCHED } else { 1.0 } * settings.tolerance;
            if residual <= goal {
                // Some materials can pass through inverted tetrahedra, but an equilibrium must have
                // none.
                if now.smallest_volume_ratio <= 0.0 {
                    return Err(Failure::Inverted);
                }
                let passed = self.keeps_passed.then(|| Passed {
                    displacements_mm: x.displacements_mm.clone(),
                    pressures_mpa: x.pressures_mpa.clone(),
                    contacts: x.contacts.clone(),
                });
                let moved_n = follow_friction(x.contacts);
                let has_pushed = push_out(body, x.contacts);
                if !has_pushed && moved_n <= settings.tolerance * now.load_n {
                    self.foreseen_mpa.copy_from_slice(x.pressures_mpa);
                    return Ok(Equilibrium {
                        residual,
                        smallest_volume_ratio: now.smallest_volume_ratio,
                        is_settled: true,
                    });
                }
                self.passed.extend(passed);
                now = self.evaluate_again(body, step, x).ok_or(Failure::Inverted)?;
                continue;
            }
            let last = std::mem::replace(&mut began, Instant::now());
            if iteration > 0 {
                self.iteration = began - last;
            }
            let is_enough = start == Start::GoOn && residual <= ALMOST;
            if (is_enough || iteration > 0 && self.is_late()) && now.smallest_volume_ratio > 0.0 {
                return Ok(Equilibrium {
                    residual,
                    smallest_volume_ratio: now.smallest_volume_ratio,
                    is_settled: false,
                });
            }
            *iterations += 1;
            self.find_direction(body, step, x, FORCING)?;
            match self.search(body, step, x, &now) {
                Ok((next, length)) => {
                    self.has_matrix = length == 1.0 && next.unbalanced_n <= SLOW * now.unbalanced_n;
                    now = next;
                    let changes = self.start_mpa.iter().zip(&self.gradients.solution_mpa);
                    for (foreseen, (start, change)) in self.foreseen_mpa.iter_mut().zip(changes) {
                        *foreseen += length * (start - f64::from(*change) - *foreseen);
                    }
                    has_failed = false;
                    self.adapt_damping(length);
                    if follow_friction(x.contacts) > 0.0 {
                        now = self.evaluate_again(body, step, x).ok_or(Failure::Inverted)?;
                    }
                }
                // The energy does not decrease along the direction: it is tried once more, with new
                // factors and damping.
                Err(_) if !has_failed => {
                    has_failed = true;
                    self.has_matrix = false;
                    self.factors = None;
                    self.adapt_damping(0.0);
                    now = self.evaluate(body, step, x).ok_or(Failure::Inverted)?;
                }
                Err(Failure::Inverted) => return Err(Failure::Inverted),
                Err(_) => break,
            }
        }
        self.has_matrix = false;
        Err(Failure::NotConverged {
            residual: now.unbalanced_n / now.load_n.max(body.least_load_n()),
        })
    }

    /// Whether another iteration, if it takes as long as the last, ends after the deadline.
    fn is_late(&self) -> bool {
        let after = Instant::now() + self.iteration;
        self.ends_at.is_some_and(|ends_at| after > ends_at)
    }

    /// Increases the damping after short steps, which show that the tangent is a poor guide
    /// (Levenberg, 1944), and decreases it after full steps.
    fn adapt_damping(&mut self, length: f64) {
        if length < SHORT {
            self.damping = (4.0 * self.damping).max(LEAST_DAMPING);
        } else if length >= 1.0 {
            self.damping *= 0.25;
        }
        if self.damping < LEAST_DAMPING {
            self.damping = 0.0;
        }
    }
}

/// Updates friction to the present normal forces; returns the sum of the changes of its limits, N.
fn follow_friction(contacts: &mut [Contact]) -> f64 {
    let frictions = contacts.iter_mut().filter_map(Contact::friction_mut);
    frictions
        .map(|(friction, touches)| friction.follow(touches))
        .sum()
}

/// Updates the multipliers of those shapes that a node is too deep in. Returns true if there are
/// any.
fn push_out(body: &SoftBody, contacts: &mut [Contact]) -> bool {
    let mut any = false;
    for contact in contacts {
        any |= contact.push_out(body.settings.penetration_mm);
    }
    any
}
