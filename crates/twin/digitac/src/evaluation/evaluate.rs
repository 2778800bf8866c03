//! A twin's predictions compared with the measurement, press by press.

use serde::{Deserialize, Serialize};

use super::{Errors, Scale, Score, StaticPolynomial, baseline, score};
use crate::{PairedPress, Twin, Variant};

/// A press, measured and predicted. Per-frame vectors have the same length, `n_frames`.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct PressEvaluation {
    /// Name of the press in its recording.
    pub name: String,
    /// The mounting of the indenter that it belongs to.
    #[serde(rename = "file")]
    pub mounting: String,
    /// The indenter's name.
    pub indenter: String,
    /// Place in the gel's plane, mm.
    pub place_mm: [f64; 2],
    /// Time stamps, s.
    pub time_s: Vec<f64>,
    /// Depth below first touch, mm.
    pub depth_mm: Vec<f64>,
    /// Readings, kPa; `[n_frames][n_taxels]`.
    pub measured_kpa: Vec<Vec<f64>>,
    /// Predictions of the twin, kPa; `[n_frames][n_taxels]`.
    pub predicted_kpa: Vec<Vec<f64>>,
    /// Whether the reading counts; `[n_frames][n_taxels]`.
    pub valid: Vec<Vec<bool>>,
    /// Largest time by which readings were warped, s.
    pub largest_shift_s: f64,
    /// Errors of this press alone.
    pub errors: Errors,
}

/// The errors of a twin, and of the baselines, on a set of presses.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Evaluation {
    /// The variant of the model.
    pub variant: Variant,
    /// Names of the taxels.
    pub taxels: Vec<String>,
    /// The twin's errors.
    pub twin: Score,
    /// Errors of predicting zero.
    pub zero: Score,
    /// Errors of a polynomial in depth and position, if one was fitted.
    pub polynomial: Option<Score>,
    /// The presses.
    pub presses: Vec<PressEvaluation>,
}

/// Evaluates a twin on presses. The polynomial should have been fitted to the twin's training presses.
#[must_use]
pub fn evaluate(
    twin: &Twin,
    presses: &[&PairedPress],
    scale: &Scale,
    polynomial: Option<&StaticPolynomial>,
) -> Evaluation {
    let all = |predict: &dyn Fn(&PairedPress) -> Vec<Vec<f64>>| -> Vec<Vec<Vec<f64>>> {
        presses.iter().map(|press| predict(press)).collect()
    };
    let predictions = all(&|press| twin.predict(&press.features));
    let judge = |predictions: &[Vec<Vec<f64>>]| score(presses.iter().copied(), predictions, scale);
    Evaluation {
        variant: twin.variant(),
        taxels: twin.taxels().to_vec(),
        twin: judge(&predictions),
        zero: judge(&all(&baseline::zero)),
        polynomial: polynomial.map(|polynomial| judge(&all(&|press| polynomial.predict(press)))),
        presses: presses
            .iter()
            .zip(&predictions)
            .map(|(press, prediction)| PressEvaluation {
                name: press.name.clone(),
                mounting: press.mounting.clone(),
                indenter: press.indenter.clone(),
                place_mm: press.place_mm,
                time_s: press.features.time_s.clone(),
                depth_mm: press.features.depth_mm.clone(),
                measured_kpa: press.readings_kpa.clone(),
                predicted_kpa: prediction.clone(),
                valid: press.valid.clone(),
                largest_shift_s: press.warp.largest_shift_s,
                errors: score([*press], std::slice::from_ref(prediction), scale).overall,
            })
            .collect(),
    }
}
