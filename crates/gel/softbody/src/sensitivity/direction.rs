//! The parameters by which a press can be differentiated.

use glam::DVec3;

use crate::Material;

/// A parameter of a press. It is given by the material one step below and one step above its value,
/// and by the motion of the indenter.
#[derive(Clone, Debug, PartialEq)]
pub struct Direction {
    /// The material where the parameter is smaller by a step, and where it is larger; with as many
    /// Prony terms as that of the body.
    pub materials: [Material; 2],
    /// The step, in the unit of the parameter: about 1e-4 of its scale, so that neither curvature
    /// nor round-off matters.
    pub step: f64,
    /// Derivative of the position of all poses of the indenter by the parameter, mm per unit of the
    /// parameter.
    pub indenter_mm: DVec3,
}

impl Direction {
    /// Difference quotient of a property of the materials.
    pub(super) fn rate(&self, of: impl Fn(&Material) -> f64) -> f64 {
        let [before, after] = &self.materials;
        (of(after) - of(before)) / (2.0 * self.step)
    }

    /// The materials, and their distances from the body's own material, in the unit of the
    /// parameter.
    pub(crate) fn sides(&self) -> [(&Material, f64); 2] {
        let [before, after] = &self.materials;
        [(before, -self.step), (after, self.step)]
    }
}
