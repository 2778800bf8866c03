//! The state of the material that a step starts from.

use twintac_material::Material;

use crate::relaxation::{History, Relaxation, Symmetric};

/// What the stress at a point depends on over a step besides the displacements.
pub(crate) struct Response<'a> {
    pub(crate) material: &'a Material,
    pub(crate) relaxation: Relaxation,
    pub(crate) history: &'a History,
    /// The constant part of the stress at each point, MPa; empty for an elastic material. `[n_points]`
    offsets: Vec<Symmetric<f64>>,
}

impl<'a> Response<'a> {
    /// Over a step of so long, from the history variables at its start.
    pub(crate) fn new(material: &'a Material, time_step_s: f64, history: &'a History) -> Self {
        let relaxation = Relaxation::new(&material.prony, time_step_s);
        Self {
            material,
            offsets: relaxation.offsets(history),
            relaxation,
            history,
        }
    }

    /// That of the same material without history variables.
    pub(crate) fn instantaneous(material: &'a Material, no_history: &'a History) -> Self {
        Self {
            material,
            relaxation: Relaxation::new(&[], 0.0),
            history: no_history,
            offsets: Vec::new(),
        }
    }

    /// The constant part of the stress at a point over this step, MPa; none for an elastic material.
    #[inline(always)]
    pub(super) fn offset(&self, point: usize) -> Option<&Symmetric<f64>> {
        self.offsets.get(point)
    }
}
