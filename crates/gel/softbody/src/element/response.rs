//! The state of the material that a step starts from.

use twintac_material::Material;

use crate::relaxation::{History, Relaxation, Symmetric};

/// What the stress at a point depends on besides the displacements.
#[derive(Clone, Copy)]
pub(crate) struct Response<'a> {
    pub(crate) material: &'a Material,
    pub(crate) relaxation: &'a Relaxation,
    pub(crate) history: &'a History,
}

impl Response<'_> {
    /// The constant part of the stress at a point over this step, MPa; none for an elastic material.
    #[inline(always)]
    pub(super) fn offset(&self, point: usize) -> Option<Symmetric<f64>> {
        if self.history.is_empty() {
            None
        } else {
            self.relaxation.offset(self.history.point(point))
        }
    }
}
