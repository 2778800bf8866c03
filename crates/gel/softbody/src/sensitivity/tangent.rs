//! The tangent at an equilibrium, accurate to double precision.

use glam::DVec3;

use crate::body::SoftBody;
use crate::contact::Contact;
use crate::newton::{Buffers, Failure, Step, Unknowns};
use crate::nodal::{add, dot};

/// Largest motion of a node in a difference of forces, mm: a very small fraction of the depth over
/// which the force of a contact starts.
pub(super) const DIFFERENCE_MM: f64 = 1e-8;

/// A derivative is accurate enough when the 2-norm of the forces that it leaves unbalanced is below
/// this fraction of those that the parameter unbalances.
pub(super) const ACCURACY: f64 = 1e-6;

/// Accuracy of the linear system in single precision, like that of a Newton direction.
const FORCING: f64 = 0.03;

/// Largest number of linear systems for one derivative.
const MAX_ROUNDS: u32 = 60;

/// Derivatives of the unbalanced forces, and of the pressures.
struct Rates {
    forces_n: Vec<DVec3>,
    pressures_mpa: Vec<f64>,
}

/// Derivatives of displacements and pressures, and the forces that they leave unbalanced.
pub(super) struct Solution {
    pub(super) rates_mm: Vec<DVec3>,
    pub(super) rates_mpa: Vec<f64>,
    pub(super) left_n: Vec<DVec3>,
}

/// The tangent at an equilibrium.
pub(super) struct Tangent<'a, 'b> {
    pub(super) body: &'a SoftBody,
    pub(super) step: &'a Step<'a>,
    pub(super) x: &'a Unknowns<'b>,
    unbalanced_n: Vec<DVec3>,
    /// The displacements at which differences are taken.
    displacements_mm: Vec<DVec3>,
    pressures_mpa: Vec<f64>,
    contacts: Vec<Contact>,
}

impl<'a, 'b> Tangent<'a, 'b> {
    /// The tangent where the buffers have just been evaluated.
    pub(super) fn new(
        body: &'a SoftBody,
        buffers: &mut Buffers,
        step: &'a Step<'a>,
        x: &'a Unknowns<'b>,
    ) -> Self {
        // The tangent of Newton's method may be outdated.
        buffers.has_matrix = false;
        Self {
            body,
            step,
            x,
            unbalanced_n: buffers.gradient_n.clone(),
            displacements_mm: x.displacements_mm.clone(),
            pressures_mpa: x.pressures_mpa.clone(),
            contacts: x.contacts.clone(),
        }
    }

    /// Derivatives of the unbalanced forces, N, and of the pressures, MPa, as the nodes move.
    fn product(&mut self, buffers: &mut Buffers, rates_mm: &[DVec3]) -> Result<Rates, Failure> {
        let farthest = rates_mm.iter().map(|rate| rate.length()).fold(0.0, f64::max);
        if farthest == 0.0 {
            return Err(Failure::Singular);
        }
        let length = DIFFERENCE_MM / farthest;
        self.displacements_mm.copy_from_slice(self.x.displacements_mm);
        for (u, rate) in self.displacements_mm.iter_mut().zip(rates_mm) {
            *u += *rate * length;
        }
        let mut at = Unknowns {
            displacements_mm: &mut self.displacements_mm,
            pressures_mpa: &mut self.pressures_mpa,
            contacts: &mut self.contacts,
        };
        buffers
            .evaluate(self.body, self.step, &mut at)
            .ok_or(Failure::Inverted)?;
        let forces = buffers.gradient_n.iter().zip(&self.unbalanced_n);
        let pressures = self.pressures_mpa.iter().zip(self.x.pressures_mpa.iter());
        Ok(Rates {
            forces_n: forces
                .map(|(after, before)| (*after - *before) / length)
                .collect(),
            pressures_mpa: pressures
                .map(|(after, before)| (after - before) / length)
                .collect(),
        })
    }

    /// Solves `K rates = forces` by conjugate gradients with the single-precision solver as the
    /// preconditioner. The preconditioner varies, so each direction is made conjugate to the
    /// previous one explicitly.
    ///
    /// Where a coarse triangle cuts off a rim, a point inside of it can be as deep as the rim is
    /// round. The outward direction then turns about the centre of the rounding, which is a
    /// negative stiffness. Conjugate gradients continue through directions of such a stiffness; the
    /// forces that remain unbalanced show whether the derivatives are right.
    pub(super) fn solve(
        &mut self,
        buffers: &mut Buffers,
        mut forces_n: Vec<DVec3>,
        enough_n: f64,
    ) -> Result<Solution, Failure> {
        let n_free = self.body.pattern.halves.free;
        let mut rates_mm = vec![DVec3::ZERO; forces_n.len()];
        let mut rates_mpa = vec![0.0; self.pressures_mpa.len()];
        let mut last: Option<(Vec<DVec3>, Rates, f64)> = None;
        for _ in 0..MAX_ROUNDS {
            let left_n = dot(&forces_n[..n_free], &forces_n[..n_free]).sqrt();
            if left_n <= enough_n {
                return Ok(Solution {
                    rates_mm,
                    rates_mpa,
                    left_n: forces_n,
                });
            }
            for (gradient, force) in buffers.gradient_n.iter_mut().zip(&forces_n) {
                *gradient = -*force;
            }
            buffers.find_direction(self.body, self.step, self.x, FORCING)?;
            buffers.has_matrix = true;
            let mut direction = buffers.direction_mm.clone();
            let mut product = self.product(buffers, &direction)?;
            if let Some((last, last_product, curvature)) = &last {
                let ratio = dot(&direction, &last_product.forces_n) / curvature;
                add(&mut direction, last, -ratio);
                add(&mut product.forces_n, &last_product.forces_n, -ratio);
                add(&mut product.pressures_mpa, &last_product.pressures_mpa, -ratio);
            }
            let curvature = dot(&direction, &product.forces_n);
            if !curvature.is_normal() {
                return Err(Failure::Singular);
            }
            let length = dot(&direction, &forces_n) / curvature;
            add(&mut rates_mm, &direction, length);
            add(&mut rates_mpa, &product.pressures_mpa, length);
            add(&mut forces_n, &product.forces_n, -length);
            last = Some((direction, product, curvature));
        }
        let left_n = dot(&forces_n[..n_free], &forces_n[..n_free]).sqrt();
        Err(Failure::NotConverged {
            residual: left_n / enough_n * ACCURACY,
        })
    }
}
