//! Settings of the solver.

use serde::{Deserialize, Serialize};

use crate::{Element, SoftBodyError};

/// Settings of the solver.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct SolverSettings {
    /// How displacements vary between nodes. Default layered.
    pub element: Element,
    /// How linear systems are solved. Default two-level.
    pub linear: LinearSolver,
    /// A step has converged when the 2-norm of the unbalanced nodal forces is below this fraction
    /// of the load. Default 1e-6.
    pub tolerance: f64,
    /// Number of Newton iterations after which a sub-step is halved. Default 100.
    pub max_iterations: u32,
    /// Largest motion of the indenter in one sub-step, mm. Default 0.5.
    pub max_travel_mm: f64,
    /// Smallest sub-step, as a fraction of that or of the requested step, whichever is smaller.
    /// Default 1/16.
    pub min_substep: f64,
    /// Contact stiffness per area, in units of shear modulus divided by local edge length.
    /// Default 100. At nodes, multipliers take over the contact forces, so that it affects how fast
    /// steps converge, but not their result. The quadrature points beside a shape's rim have no
    /// multipliers: there the result depends on it as it does on the mesh, by some percent of the
    /// force on a coarse mesh.
    pub contact_stiffness: f64,
    /// Largest depth of a node inside of a shape after a step, mm; contact is stiffened until it is
    /// reached. Default 0.005.
    pub penetration_mm: f64,
    /// Coulomb's coefficient of friction between the body and the indenter. Default 0. Before it
    /// slips, a node in contact moves elastically, by up to its friction divided by its contact
    /// stiffness: `μ p / (contact_stiffness G)` local edge lengths at a contact pressure `p` and a
    /// shear modulus `G`, which is far less than the deformation of the body itself.
    pub friction: f64,
    /// Coulomb's coefficient of friction between the body and its obstacles. Default 0.
    pub obstacle_friction: f64,
}

/// How linear systems are solved. The results agree within the tolerance.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum LinearSolver {
    /// Conjugate gradients with a two-level preconditioner, whose factors are kept as long as the
    /// iterations converge fast.
    #[default]
    TwoLevel,
    /// Factors of the whole system in double precision, computed again for every direction: slow,
    /// for comparison.
    Direct,
}

impl Default for SolverSettings {
    fn default() -> Self {
        Self {
            element: Element::default(),
            linear: LinearSolver::default(),
            tolerance: 1e-6,
            max_iterations: 100,
            max_travel_mm: 0.5,
            min_substep: 1.0 / 16.0,
            contact_stiffness: 100.0,
            penetration_mm: 0.005,
            friction: 0.0,
            obstacle_friction: 0.0,
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
        for (field, found) in [
            ("friction", self.friction),
            ("obstacle_friction", self.obstacle_friction),
        ] {
            if !(found.is_finite() && found >= 0.0) {
                return Err(SoftBodyError::Setting {
                    field,
                    expected: "a finite number, 0 or above",
                    found,
                });
            }
        }
        Ok(())
    }
}
