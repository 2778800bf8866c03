//! The state of the material from which a step starts.

use twintac_material::Material;

use crate::MPA_PER_KPA;
use crate::relaxation::{History, Relaxation, Symmetric};

/// Everything other than the displacements that the stress at a point depends on during a step.
#[derive(Clone)]
pub(crate) struct Response<'a> {
    pub(crate) material: &'a Material,
    pub(crate) relaxation: Relaxation,
    pub(crate) history: &'a History,
    /// The constant part of the stress at each point, MPa; empty for an elastic material;
    /// `[n_points]`.
    offsets: Vec<Symmetric<f64>>,
}

impl<'a> Response<'a> {
    /// The response during a step of this length, from the history variables at its start.
    pub(crate) fn new(material: &'a Material, time_step_s: f64, history: &'a History) -> Self {
        let relaxation = Relaxation::new(&material.prony, time_step_s);
        Self {
            material,
            offsets: relaxation.offsets(history),
            relaxation,
            history,
        }
    }

    /// The response of the same material without history variables.
    pub(crate) fn instantaneous(material: &'a Material, no_history: &'a History) -> Self {
        Self {
            material,
            relaxation: Relaxation::new(&[], 0.0),
            history: no_history,
            offsets: Vec::new(),
        }
    }

    /// Shear modulus at small strain, MPa.
    pub(super) fn shear_modulus_mpa(&self) -> f64 {
        MPA_PER_KPA * self.material.model.shear_modulus_kpa()
    }

    /// The constant part of the stress at a point in this step, MPa; `None` for an elastic
    /// material.
    #[inline(always)]
    pub(super) fn offset(&self, point: usize) -> Option<&Symmetric<f64>> {
        self.offsets.get(point)
    }
}
