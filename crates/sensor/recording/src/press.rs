//! Presses and recordings in memory.

use serde::{Deserialize, Serialize};
use twintac_shape::Pose;

use crate::Provenance;

/// Presses of one sensor, with one provenance.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Recording {
    /// Name of the sensor description that the presses belong to.
    pub sensor: String,
    /// Provenance of the numbers.
    pub provenance: Provenance,
    /// Taxel names, in the order of every row of readings; the order of the sensor description.
    pub taxels: Vec<String>,
    /// The presses in chronological order.
    pub presses: Vec<Press>,
}

/// The controlled quantity of a press.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Control {
    /// The pose was controlled and is known.
    Pose,
    /// The force was controlled and is known. z is not known; it is the height at which the tip
    /// touches the gel.
    Force,
}

impl std::fmt::Display for Control {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(match self {
            Self::Pose => "pose",
            Self::Force => "force",
        })
    }
}

/// One press. All vectors of frames have the same length, `n_frames`.
///
/// A missing reading is NaN and not valid in memory, and null in JSON and Parquet. Nothing else is
/// NaN. Two presses with the same missing readings can be equal.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct Press {
    /// Unique in its recording: `<file stem>#<number>`, the number from 1.
    pub name: String,
    /// The installation of gel and indenter. Presses of one installation were made with the gel at
    /// one height. For presses of a CSV file: the file's name without its folder. For presses that
    /// a test setup recorded: the name of the installed indenter.
    pub mounting: String,
    /// Name of the indenter in the sensor description.
    pub indenter: String,
    /// The controlled quantity.
    pub control: Control,
    /// Time stamps, s, strictly increasing; `[n_frames]`.
    pub time_s: Vec<f64>,
    /// Pose of the indenter in the gel's frame; `[n_frames]`.
    pub gel_from_indenter: Vec<Pose>,
    /// Force of the indenter on the gel along -z, N; `[n_frames]`, if it was measured or
    /// controlled.
    pub force_n: Option<Vec<f64>>,
    /// Readings above the unloaded baseline, kPa. NaN if a reading or the baseline is missing;
    /// `[n_frames][n_taxels]`.
    #[serde(deserialize_with = "crate::null_as_nan")]
    pub taxels_kpa: Vec<Vec<f64>>,
    /// Readings as in the source, in its unit. NaN if missing; `[n_frames][n_taxels]`.
    #[serde(deserialize_with = "crate::null_as_nan")]
    pub taxels_raw: Vec<Vec<f64>>,
    /// Temperatures of the chips, °C. NaN if missing; `[n_frames][n_taxels]`, if the source has
    /// any.
    #[serde(
        default,
        skip_serializing_if = "Option::is_none",
        deserialize_with = "crate::missing::some_null_as_nan"
    )]
    pub temperature_c: Option<Vec<Vec<f64>>>,
    /// Whether the reading is usable (neither clipped nor missing); `[n_frames][n_taxels]`.
    pub valid: Vec<Vec<bool>>,
}

impl PartialEq for Press {
    fn eq(&self, other: &Self) -> bool {
        let Self {
            name,
            mounting,
            indenter,
            control,
            time_s,
            gel_from_indenter,
            force_n,
            taxels_kpa,
            taxels_raw,
            temperature_c,
            valid,
        } = self;
        (name, mounting, indenter) == (&other.name, &other.mounting, &other.indenter)
            && (control, time_s, gel_from_indenter)
                == (&other.control, &other.time_s, &other.gel_from_indenter)
            && (force_n, valid) == (&other.force_n, &other.valid)
            && are_same(taxels_kpa, &other.taxels_kpa)
            && are_same(taxels_raw, &other.taxels_raw)
            && match (temperature_c, &other.temperature_c) {
                (Some(rows), Some(others)) => are_same(rows, others),
                (rows, others) => rows.is_none() && others.is_none(),
            }
    }
}

/// Whether readings are equal; missing readings equal each other.
fn are_same(readings: &[Vec<f64>], others: &[Vec<f64>]) -> bool {
    let is_same = |(a, b): (&f64, &f64)| a == b || a.is_nan() && b.is_nan();
    let of_frame =
        |(row, other): (&Vec<f64>, &Vec<f64>)| row.len() == other.len() && row.iter().zip(other).all(is_same);
    readings.len() == others.len() && readings.iter().zip(others).all(of_frame)
}
