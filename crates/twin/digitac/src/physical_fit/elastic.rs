//! Port pressures, and how they change with what is unknown about the bench.

use std::ops::Range;

use crate::DigitacError;
use crate::numerics::Unknown;

/// How port pressures change with one unknown.
pub(crate) struct Slope {
    pub(crate) unknown: usize,
    /// The taxel that it belongs to; `None` if it belongs to all.
    pub(crate) taxel: Option<usize>,
    /// Frames of whole mountings that it acts on.
    pub(crate) frames: Range<usize>,
    /// `[n_taxels][frames.len()]`, or of the one taxel.
    pub(crate) kpa: Vec<Vec<f64>>,
}

/// Port pressures of all frames.
pub(crate) struct Pressures {
    /// `[n_taxels][n_frames]`
    pub(crate) kpa: Vec<Vec<f64>>,
    pub(crate) slopes: Vec<Slope>,
}

/// What answers with port pressures.
pub(crate) trait Elastic {
    /// What is unknown about it.
    fn unknowns(&self) -> Vec<Unknown>;

    /// Port pressures for values of the unknowns; slopes only if they are asked for.
    fn pressures(&self, values: &[f64], with_slopes: bool) -> Result<Pressures, DigitacError>;
}

/// Port pressures that are known.
pub(crate) struct Known {
    /// `[n_taxels][n_frames]`
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
