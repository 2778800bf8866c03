//! A check of the derivatives that Newton's method uses, for any mesh, element and material.

use glam::DVec3;

use crate::body::SoftBody;
use crate::element::Response;
use crate::linear::block::Vector;
use crate::newton::{Step, Unknowns};
use crate::nodal::dot;
use crate::state::State;

/// Weights of a central difference of fourth order, at these multiples of the step.
const STENCIL: [(f64, f64); 4] = [
    (-2.0, 1.0 / 12.0),
    (-1.0, -2.0 / 3.0),
    (1.0, 2.0 / 3.0),
    (2.0, -1.0 / 12.0),
];

/// Errors of the derivatives compared with differences, relative to their size.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DerivativeErrors {
    /// Of the nodal forces from differences of the energy, along the direction.
    pub force: f64,
    /// Of the tangent, times the direction, from differences of the nodal forces. The tangent is kept in single precision.
    pub tangent: f64,
}

impl SoftBody {
    /// Compares derivatives with differences at these displacements, along a direction in which bonded nodes stay where they are; the
    /// differences take steps of that length. Both `[n_nodes]`, mm. A body without a past and without contact. `None` where a tetrahedron
    /// is inside out.
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
        // The last of them was where the derivatives are wanted.
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
