//! Pairs each measured frame with the simulated frame of the same instant.

use serde::{Deserialize, Serialize};
use twintac_config::{Checked, Ranges};
use twintac_depth_table::DepthTable;
use twintac_recording::{Control, Press, Recording, null_as_nan};

use super::{Warp, WarpSettings};
use crate::bench_fit::{BenchEstimate, Places, deepest_pose, features};
use crate::{DigitacError, Features};

/// A press, measured and simulated, on one clock.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct PairedPress {
    /// Name of the press in its recording.
    pub name: String,
    /// The installation (mounting) of the indenter that it belongs to.
    #[serde(alias = "file")]
    pub mounting: String,
    /// The indenter's name.
    pub indenter: String,
    /// Location in the gel's plane, mm.
    pub place_mm: [f64; 2],
    /// The simulated side.
    pub features: Features,
    /// Measured force, N; `[n_frames]`; `None` without a force sensor.
    pub measured_force_n: Option<Vec<f64>>,
    /// Readings above the unloaded baseline, on the recording's own clock, kPa; NaN where one is
    /// missing; `[n_frames][n_taxels]`.
    #[serde(deserialize_with = "null_as_nan")]
    pub readings_kpa: Vec<Vec<f64>>,
    /// Whether the reading is usable; `[n_frames][n_taxels]`.
    pub valid: Vec<Vec<bool>>,
    /// The time warp that makes the readings rise and fall together with the simulated gel.
    /// Training and headline figures use readings without it.
    pub warp: Warp,
}

impl PairedPress {
    /// The press with its readings warped onto the simulation's clock.
    pub(crate) fn warped(&self) -> Self {
        Self {
            readings_kpa: self.warp.apply(&self.readings_kpa),
            valid: self.warp.apply_valid(&self.valid),
            ..self.clone()
        }
    }
}

/// Settings of pairing measured and simulated frames.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct PairSettings {
    /// Limits of the difference between the clocks.
    pub warp: WarpSettings,
}

impl Checked for PairSettings {
    fn check(&self, ranges: &mut Ranges) {
        let Self { warp } = self;
        ranges.inside("warp", warp);
    }
}

/// Pairs every press of a recording with its simulation.
///
/// # Errors
/// Settings outside their ranges; tables that do not belong to the locations; an inconsistent
/// press.
pub fn pair(
    recording: &Recording,
    places: &Places,
    tables: &[DepthTable],
    bench: &BenchEstimate,
    settings: &PairSettings,
) -> Result<Vec<PairedPress>, DigitacError> {
    settings.checked()?;
    let features = features(recording, places, tables, bench)?;
    recording
        .presses
        .iter()
        .zip(features)
        .map(|(press, features)| pair_press(press, features, settings))
        .collect()
}

fn pair_press(
    press: &Press,
    features: Features,
    settings: &PairSettings,
) -> Result<PairedPress, DigitacError> {
    let n_frames = features.n_frames();
    if press.taxels_kpa.len() != n_frames || press.valid.len() != n_frames {
        let problem = format!(
            "has {n_frames} time stamps and {} rows of readings",
            press.taxels_kpa.len()
        );
        return Err(DigitacError::press(&press.name, problem));
    }
    let warp = match press.control {
        Control::Pose => warp(press, &features, &settings.warp),
        Control::Force => Warp::identity(n_frames),
    };
    let mut valid = press.valid.clone();
    for (row, readings) in valid.iter_mut().zip(&press.taxels_kpa) {
        for (valid, reading) in row.iter_mut().zip(readings) {
            *valid &= reading.is_finite();
        }
    }
    Ok(PairedPress {
        name: press.name.clone(),
        mounting: press.mounting.clone(),
        indenter: press.indenter.clone(),
        place_mm: deepest_pose(press)?.position_mm.truncate().to_array(),
        features,
        measured_force_n: press.force_n.clone(),
        readings_kpa: press.taxels_kpa.clone(),
        valid,
        warp,
    })
}

/// Compares the measured force with the simulated one; without a force sensor, the sum of the
/// positive readings with the sum of the positive port pressures.
fn warp(press: &Press, features: &Features, settings: &WarpSettings) -> Warp {
    match &press.force_n {
        Some(force_n) => Warp::between(&press.time_s, force_n, &features.force_n, settings),
        None => {
            let measured = press.taxels_kpa.iter().zip(&press.valid).map(|(row, valid)| {
                row.iter()
                    .zip(valid)
                    .map(|(p, valid)| if *valid { p.max(0.0) } else { 0.0 })
                    .sum()
            });
            let simulated = features
                .pressure_kpa
                .iter()
                .map(|row| row.iter().map(|p| p.max(0.0)).sum());
            let (measured, simulated): (Vec<f64>, Vec<f64>) = (measured.collect(), simulated.collect());
            Warp::between(&press.time_s, &measured, &simulated, settings)
        }
    }
}
