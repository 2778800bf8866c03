//! Predictions of a twin compared with measurements, press by press.

use std::collections::BTreeSet;

use serde::{Deserialize, Serialize};
use twintac_recording::null_as_nan;

use super::{Errors, Kernel, Scale, Score, StaticPolynomial, baseline, score};
use crate::{DigitacError, Features, PairedPress, Twin, Variant};

/// A press, measured and predicted. Per-frame vectors have the same length, `n_frames`.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct PressEvaluation {
    /// Name of the press in its recording.
    pub name: String,
    /// The installation (mounting) of the indenter that it belongs to.
    #[serde(rename = "file")]
    pub mounting: String,
    /// The indenter's name.
    pub indenter: String,
    /// Location in the gel's plane, mm.
    pub place_mm: [f64; 2],
    /// Time stamps, s.
    pub time_s: Vec<f64>,
    /// Depth below first touch, mm.
    pub depth_mm: Vec<f64>,
    /// Readings, kPa; NaN where one is missing; `[n_frames][n_taxels]`.
    #[serde(deserialize_with = "null_as_nan")]
    pub measured_kpa: Vec<Vec<f64>>,
    /// Predictions of the twin, kPa; `[n_frames][n_taxels]`.
    pub predicted_kpa: Vec<Vec<f64>>,
    /// Whether the reading counts; `[n_frames][n_taxels]`.
    pub valid: Vec<Vec<bool>>,
    /// Largest time shift that a warp of the readings would need, s.
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
    /// Errors of the twin if readings are warped onto the simulation's clock before they are
    /// compared.
    pub warped: Errors,
    /// Errors of predicting zero.
    pub zero: Score,
    /// Errors of a polynomial in depth and position, if one was fitted.
    pub polynomial: Option<Score>,
    /// Errors of the parametric baseline (a power of depth times a function of distance), if it was
    /// fitted.
    #[serde(default)]
    pub kernel: Option<Score>,
    /// The presses.
    pub presses: Vec<PressEvaluation>,
}

/// Baselines without physics for comparison with a twin.
pub struct Baselines {
    polynomial: StaticPolynomial,
    kernel: Kernel,
}

impl Baselines {
    /// Fits the baselines to training presses among recorded ones. `ports_mm` are the ports'
    /// locations in the gel's plane, `[n_taxels]`. Excluded taxels, in `left_out`, do not influence
    /// values that all taxels share.
    ///
    /// # Errors
    /// No recording causes an error.
    pub fn fit(
        recorded: &[PairedPress],
        training_presses: &[usize],
        ports_mm: &[[f64; 2]],
        left_out: &BTreeSet<usize>,
    ) -> Result<Self, DigitacError> {
        let presses: Vec<&PairedPress> = training_presses.iter().map(|&index| &recorded[index]).collect();
        Ok(Self {
            polynomial: StaticPolynomial::fit(&presses),
            kernel: Kernel::fit(recorded, training_presses, ports_mm, left_out)?,
        })
    }
}

/// Evaluates a twin on some presses of a recording; relaxation after the other presses is taken
/// into account. The baselines should have been fitted to the twin's training presses.
#[must_use]
pub fn evaluate(
    twin: &Twin,
    recorded: &[PairedPress],
    chosen: &[usize],
    scale: &Scale,
    baselines: Option<&Baselines>,
) -> Evaluation {
    let presses: Vec<&PairedPress> = chosen.iter().map(|&index| &recorded[index]).collect();
    let all = |predict: &dyn Fn(&PairedPress) -> Vec<Vec<f64>>| -> Vec<Vec<Vec<f64>>> {
        presses.iter().map(|press| predict(press)).collect()
    };
    let predictions = predict_some(twin, recorded, chosen);
    let score_all = |predictions: &[Vec<Vec<f64>>]| score(presses.iter().copied(), predictions, scale);
    let warped: Vec<PairedPress> = presses.iter().map(|press| press.warped()).collect();
    Evaluation {
        variant: twin.variant(),
        taxels: twin.taxels().to_vec(),
        twin: score_all(&predictions),
        warped: score(&warped, &predictions, scale).overall,
        zero: score_all(&all(&baseline::zero)),
        polynomial: baselines.map(|b| score_all(&all(&|press| b.polynomial.predict(press)))),
        kernel: baselines.map(|b| score_all(&all(&|press| b.kernel.predict(press)))),
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

/// Predictions of a twin for some presses of a recording, kPa; `[n_chosen][n_frames][n_taxels]`.
pub(crate) fn predict_some(twin: &Twin, recorded: &[PairedPress], chosen: &[usize]) -> Vec<Vec<Vec<f64>>> {
    let all: Vec<&Features> = recorded.iter().map(|press| &press.features).collect();
    let mut predictions = twin.predict(&all);
    chosen
        .iter()
        .map(|&index| std::mem::take(&mut predictions[index]))
        .collect()
}

/// The errors of a twin on some presses of a recording.
pub(crate) fn score_some(twin: &Twin, recorded: &[PairedPress], chosen: &[usize], scale: &Scale) -> Score {
    let presses = chosen.iter().map(|&index| &recorded[index]);
    score(presses, &predict_some(twin, recorded, chosen), scale)
}
