//! How hard the solver tries.

use serde::{Deserialize, Serialize};

use crate::SoftBodyError;

/// Settings of the solver.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct SolverSettings {
    /// A step has converged when the 2-norm of the unbalanced nodal forces is below this part of the load. Default 1e-6.
    pub tolerance: f64,
    /// Newton iterations before a sub-step is given up and halved. Default 50.
    pub max_iterations: u32,
    /// Smallest sub-step as part of the step asked for. Default 1/64.
    pub min_substep: f64,
    /// Contact stiffness per area in units of shear modulus over the local edge length. Default 500.
    pub contact_stiffness: f64,
    /// Largest penetration left after a step, mm; deeper ones are pushed out by raising the contact's multipliers. Default 0.005.
    pub penetration_mm: f64,
    /// Weight of the pressure stabilisation; 1 is that of Dohrmann and Bochev (2004), 0 none. Default 0.25.
    pub stabilisation: f64,
}

impl Default for SolverSettings {
    fn default() -> Self {
        Self {
            tolerance: 1e-6,
            max_iterations: 50,
            min_substep: 1.0 / 64.0,
            contact_stiffness: 500.0,
            penetration_mm: 0.005,
            stabilisation: 0.25,
        }
    }
}

impl SolverSettings {
    pub(crate) fn check(&self) -> Result<(), SoftBodyError> {
        let positive = |field, found: f64| {
            if found.is_finite() && found > 0.0 {
                Ok(())
            } else {
                Err(SoftBodyError::Setting {
                    field,
                    expected: "a finite number above 0",
                    found,
                })
            }
        };
        positive("tolerance", self.tolerance)?;
        positive("max_iterations", f64::from(self.max_iterations))?;
        positive("min_substep", self.min_substep)?;
        positive("contact_stiffness", self.contact_stiffness)?;
        positive("penetration_mm", self.penetration_mm)?;
        if !(self.stabilisation.is_finite() && self.stabilisation >= 0.0) {
            let (field, expected) = ("stabilisation", "a finite number, 0 or above");
            return Err(SoftBodyError::Setting {
                field,
                expected,
                found: self.stabilisation,
            });
        }
        Ok(())
    }
}
