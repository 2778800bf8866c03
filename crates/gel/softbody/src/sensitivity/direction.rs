//! What a press is differentiated with respect to.

use glam::DVec3;

use crate::Material;

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
