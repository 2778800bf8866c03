//! How hard the solver tries.

use serde::{Deserialize, Serialize};

use crate::SoftBodyError;

/// Settings of the solver.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct SolverSettings {
    /// A step has converged when the 2-norm of the unbalanced nodal forces is below this part of the load. Default 1e-6.
    pub tolerance: f64,
    /// Newton iterations before a sub-step is given up and halved. Default 40.
    pub max_iterations: u32,
    /// Farthest the indenter moves in one sub-step, mm. Default 0.5.
    pub max_travel_mm: f64,
    /// Smallest sub-step as part of that or of the step asked for, whichever is smaller. Default 1/16.
    pub min_substep: f64,
    /// Contact stiffness per area in units of shear modulus over the local edge length. Default 1000.
    pub contact_stiffness: f64,
    /// Largest depth of a node inside a shape after a step, mm; contact is stiffened until it is reached. Default 0.005.
    pub penetration_mm: f64,
    /// Weight of the pressure stabilisation; 1 is that of Dohrmann and Bochev (2004), 0 none. Default 0.25: against converged results it halves the error
    /// of 1 in pressure, and the pressure stays smooth up to ν = 0.4999.
    pub stabilisation: f64,
}

impl Default for SolverSettings {
    fn default() -> Self {
        Self {
            tolerance: 1e-6,
            max_iterations: 40,
            max_travel_mm: 0.5,
            min_substep: 1.0 / 16.0,
            contact_stiffness: 1000.0,
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
        positive("max_travel_mm", self.max_travel_mm)?;
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
