//! Port pressures, and their derivatives with respect to the unknowns of the test setup.

use std::ops::Range;

use crate::DigitacError;
use crate::numerics::Unknown;

/// Derivatives of port pressures with respect to one unknown.
pub(crate) struct Slope {
    pub(crate) unknown: usize,
    /// The taxel that it belongs to; `None` if it belongs to all.
    pub(crate) taxel: Option<usize>,
    /// Frames on which it acts; they are those of whole installations.
    pub(crate) frames: Range<usize>,
    /// Derivatives, kPa per unit of the unknown; `[n_taxels][frames.len()]`, or one row for a
    /// single taxel.
    pub(crate) kpa: Vec<Vec<f64>>,
}

/// Port pressures of all frames.
pub(crate) struct Pressures {
    /// Pressures, kPa; `[n_taxels][n_frames]`.
    pub(crate) kpa: Vec<Vec<f64>>,
    pub(crate) slopes: Vec<Slope>,
}

/// A model of port pressures.
pub(crate) trait Elastic {
    /// Its unknowns.
    fn unknowns(&self) -> Vec<Unknown>;

    /// Port pressures for values of the unknowns. Derivatives are computed only with `with_slopes`.
    fn pressures(&self, values: &[f64], with_slopes: bool) -> Result<Pressures, DigitacError>;
}

/// Port pressures that are known.
pub(crate) struct Known {
    /// Pressures, kPa; `[n_taxels][n_frames]`.
    pub(crate) kpa: Vec<Vec<f64>>,
}

impl Elastic for Known {
    fn unknowns(&self) -> Vec<Unknown> {
        Vec::new()
    }

    fn pressures(&self, _values: &[f64], _with_slopes: bool) -> Result<Pressures, DigitacError> {
        Ok(Pressures {
            kpa: self.kpa.clone(),
            slopes: Vec::new(),
        })
    }
}
