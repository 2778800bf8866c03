//! Checks the derivatives that Newton's method uses, for any mesh, element and material.

use glam::DVec3;

use crate::body::SoftBody;
use crate::element::Response;
use crate::linear::block::Vector;
use crate::newton::{Step, Unknowns};
use crate::nodal::dot;
use crate::state::State;

/// Weights of a fourth-order central difference, at these multiples of the step.
const STENCIL: [(f64, f64); 4] = [
    (-2.0, 1.0 / 12.0),
    (-1.0, -2.0 / 3.0),
    (1.0, 2.0 / 3.0),
    (2.0, -1.0 / 12.0),
];

/// Errors of the derivatives, compared with difference quotients, relative to their size.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DerivativeErrors {
    /// Error of the nodal forces along the direction, compared with differences of the energy.
    pub force: f64,
    /// Error of the tangent times the direction, compared with differences of the nodal forces. The
    /// tangent is stored in single precision.
    pub tangent: f64,
}

impl SoftBody {
    /// Compares derivatives with difference quotients at these displacements, along a direction
    /// that leaves bonded nodes where they are. The steps of the differences have the length of the
    /// direction. Both are in mm, `[n_nodes]`. The body has no history and no contact. `None` if a
    /// tetrahedron is inverted.
    #[must_use]
    pub fn derivative_errors(
        &self,
        displacements_mm: &[DVec3],
        direction_mm: &[DVec3],
    ) -> Option<DerivativeErrors> {
        let State {
            history,
            mut contacts,
            mut pressures_mpa,
            mut workspace,
            ..
        } = self.rest();
        let step = Step {
            response: Response::new(self.material(), 0.0, &history),
            shapes: &[],
        };
        let buffers = workspace.buffers(self);
        let n_free = self.pattern.halves.free;
        let mut moved = displacements_mm.to_vec();
        let direction = &direction_mm[..n_free];
        let mut slope = 0.0;
        let mut change_n = vec![DVec3::ZERO; n_free];
        for (multiple, weight) in STENCIL.into_iter().chain([(0.0, 0.0)]) {
            for ((moved, from), way) in moved.iter_mut().zip(displacements_mm).zip(direction) {
                *moved = *from + *way * multiple;
            }
            let mut x = Unknowns {
                displacements_mm: &mut moved,
                pressures_mpa: &mut pressures_mpa,
                contacts: &mut contacts,
            };
            slope += weight * buffers.evaluate(self, &step, &mut x)?.energy;
            for (sum, gradient) in change_n.iter_mut().zip(&buffers.gradient_n) {
                *sum += *gradient * weight;
            }
        }
        // The last evaluation, with the multiple 0, was at the given displacements.
        let x = Unknowns {
            displacements_mm: &mut moved,
            pressures_mpa: &mut pressures_mpa,
            contacts: &mut contacts,
        };
        buffers.stand_at(&x);
        buffers.assemble(self, &step, &x);
        buffers.add_contact(self, &step, &x);
        let way: Vec<Vector> = direction.iter().map(|way| Vector::from_dvec3(*way)).collect();
        let product = buffers.product(self, &way);

        let force: f64 = dot(&buffers.gradient_n[..n_free], direction);
        let (mut wrong, mut whole) = (0.0, 0.0);
        for (product, change) in product.iter().zip(&change_n) {
            wrong += (product.to_dvec3() - *change).length_squared();
            whole += change.length_squared();
        }
        Some(DerivativeErrors {
            force: (slope / force - 1.0).abs(),
            tangent: (wrong / whole).sqrt(),
        })
    }
}
