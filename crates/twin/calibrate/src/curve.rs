//! Measured presses.

use glam::DQuat;
use twintac_shape::Shape;

use crate::CalibrateError;

/// What a signal measures.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Quantity {
    /// Force of the indenter on the gel along -z, N.
    Force,
    /// Reading of a taxel above its baseline, kPa: the pressure at its port times the taxel's gain.
    /// By index.
    Taxel(usize),
}

impl Quantity {
    /// Index of the taxel; `None` for a force.
    #[must_use]
    pub fn taxel(self) -> Option<usize> {
        match self {
            Self::Force => None,
            Self::Taxel(taxel) => Some(taxel),
        }
    }
}

/// One quantity over a press.
#[derive(Clone, Debug, PartialEq)]
pub struct Signal {
    /// What was measured.
    pub quantity: Quantity,
    /// The values, in N or kPa; NaN where there is no usable value; `[n_samples]`.
    pub values: Vec<f64>,
}

/// One measured press.
#[derive(Clone, Debug, PartialEq)]
pub struct Curve {
    /// A name that no other curve has.
    pub name: String,
    /// Shape of the indenter.
    pub shape: Shape,
    /// Coulomb's coefficient of friction between gel and indenter, as described.
    pub friction: f64,
    /// x of the indenter's origin in the gel's plane, mm.
    pub x_mm: f64,
    /// y of the indenter's origin in the gel's plane, mm.
    pub y_mm: f64,
    /// Tilt and yaw of the indenter.
    pub rotation: DQuat,
    /// Time, s, increasing; `[n_samples]`. For an elastic gel only the order of the samples
    /// matters.
    pub time_s: Vec<f64>,
    /// Depth below first touch, mm, as recorded; negative above the gel; `[n_samples]`.
    pub depth_mm: Vec<f64>,
    /// The signals measured along the press.
    pub signals: Vec<Signal>,
}

impl Curve {
    pub(crate) fn check(&self) -> Result<(), CalibrateError> {
        let refuse = |problem: String| {
            Err(CalibrateError::Curve {
                curve: self.name.clone(),
                problem,
            })
        };
        let n = self.time_s.len();
        if n < 2 {
            return refuse(format!("has {n} samples, expected 2 or more"));
        }
        let lengths = self.signals.iter().map(|signal| signal.values.len());
        if let Some(other) = lengths.chain([self.depth_mm.len()]).find(|length| *length != n) {
            return refuse(format!("has {n} times but {other} values beside them"));
        }
        if let Some(row) =
            (0..n).find(|&row| !(self.time_s[row].is_finite() && self.depth_mm[row].is_finite()))
        {
            return refuse(format!(
                "sample {} has a time or depth that is not a number",
                row + 1
            ));
        }
        if let Some(row) = (1..n).find(|&row| self.time_s[row] <= self.time_s[row - 1]) {
            return refuse(format!(
                "the time of sample {} is {} s, expected more than the {} s before it",
                row + 1,
                self.time_s[row],
                self.time_s[row - 1]
            ));
        }
        if !self.depth_mm.iter().any(|depth_mm| *depth_mm > 0.0) {
            return refuse("never touches the gel: no depth is above 0 mm".into());
        }
        Ok(())
    }
}
