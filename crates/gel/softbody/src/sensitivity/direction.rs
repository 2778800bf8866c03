//! What a press is differentiated with respect to.

use glam::DVec3;

use crate::Material;

/// A parameter of a press, given by the material and the indenter's pose a step below and a step above its value.
#[derive(Clone, Debug, PartialEq)]
pub struct Direction {
    /// The material where the parameter is less by a step, and where it is more; with as many Prony terms as the body's.
    pub materials: [Material; 2],
    /// The step, in the unit of the parameter: about 1e-4 of its scale, so that neither curvature nor round-off matters.
    pub step: f64,
    /// Rate at which all poses of the indenter move, mm over the unit of the parameter.
    pub indenter_mm: DVec3,
}

impl Direction {
    /// Difference quotient of something that materials have.
    pub(super) fn rate(&self, of: impl Fn(&Material) -> f64) -> f64 {
        let [before, after] = &self.materials;
        (of(after) - of(before)) / (2.0 * self.step)
    }

    /// The materials, and how far from the body's own they are, in the unit of the parameter.
    pub(crate) fn sides(&self) -> [(&Material, f64); 2] {
        let [before, after] = &self.materials;
        [(before, -self.step), (after, self.step)]
    }
}
