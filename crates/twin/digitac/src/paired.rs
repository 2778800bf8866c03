//! What was measured, beside what the simulation says about the same moment.

use serde::{Deserialize, Serialize};
use twintac_depth_table::{DepthCurves, DepthTable};
use twintac_recording::{Control, Press, Recording};

use crate::places::deepest_pose;
use crate::{Bench, DigitacError, Places, Warp, WarpSettings};

/// How far beyond its end a table is still trusted, mm or N.
const BEYOND: f64 = 1e-6;

/// The simulated gel along a press. All vectors have the same length, `n_frames`.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Features {
    /// Time stamps, s.
    pub time_s: Vec<f64>,
    /// Depth below first touch, mm; negative above the gel.
    pub depth_mm: Vec<f64>,
    /// Force of the indenter on the gel along -z, N.
    pub force_n: Vec<f64>,
    /// Elastic hydrostatic pressure at each taxel's port, kPa; `[n_frames][n_taxels]`.
    pub pressure_kpa: Vec<Vec<f64>>,
    /// Stress feature of the TwinTac paper (arXiv 2509.10063, equation 6), kPa/mm; `[n_frames][n_taxels]`.
    pub stress_kpa_per_mm: Vec<Vec<f64>>,
    /// Whether the frame was simulated: not deeper than the last frame of the place's table.
    pub simulated: Vec<bool>,
}

/// A press, measured and simulated, on one clock.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct PairedPress {
    /// Name of the press in its recording.
    pub name: String,
    /// The file that it was read from.
    pub file: String,
    /// The indenter's name.
    pub indenter: String,
    /// Place in the gel's plane, mm.
    pub place_mm: [f64; 2],
    /// The simulated side.
    pub features: Features,
    /// Measured force, N; `[n_frames]`, if there was one.
    pub measured_force_n: Option<Vec<f64>>,
    /// Readings above the unloaded baseline, warped to the simulation's clock, kPa; `[n_frames][n_taxels]`.
    pub readings_kpa: Vec<Vec<f64>>,
    /// Whether the reading counts: usable, and simulated; `[n_frames][n_taxels]`.
    pub valid: Vec<Vec<bool>>,
    /// How the readings were warped.
    pub warp: Warp,
}

/// How measured and simulated frames are brought together.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct PairSettings {
    /// How far clocks may differ.
    pub warp: WarpSettings,
}

impl Features {
    /// Reads a place's table along a press.
    pub(crate) fn along(
        curves: &DepthCurves,
        press: &Press,
        touch_z_mm: f64,
        bench: &Bench,
    ) -> Result<Self, DigitacError> {
        let n_frames = press.time_s.len();
        let n_forces = press.force_n.as_ref().map_or(n_frames, Vec::len);
        if press.gel_from_indenter.len() != n_frames || n_forces != n_frames {
            let problem = format!(
                "has {n_frames} time stamps, {} poses and {n_forces} forces",
                press.gel_from_indenter.len()
            );
            return Err(DigitacError::press(&press.name, problem));
        }
        let stiffness = match press.control {
            Control::Pose => 1.0,
            Control::Force => bench.stiffness(),
        };
        let depth_mm = match press.control {
            Control::Pose => depths_mm(press, touch_z_mm, bench.contact_offset_mm(&press.mounting)),
            Control::Force => {
                let force_n = press.force_n.as_ref();
                let force_n = force_n
                    .ok_or_else(|| DigitacError::press(&press.name, "prescribes a force but has none"))?;
                force_n
                    .iter()
                    .map(|f| {
                        if *f > 0.0 {
                            curves.depth_mm(f / stiffness)
                        } else {
                            0.0
                        }
                    })
                    .collect()
            }
        };
        let simulated = match (press.control, &press.force_n) {
            (Control::Force, Some(force_n)) => force_n
                .iter()
                .map(|f| f / stiffness <= curves.max_force_n() + BEYOND)
                .collect(),
            _ => depth_mm
                .iter()
                .map(|depth| *depth <= curves.max_depth_mm() + BEYOND)
                .collect(),
        };
        let scaled = |mut row: Vec<f64>| {
            row.iter_mut().for_each(|value| *value *= stiffness);
            row
        };
        Ok(Self {
            time_s: press.time_s.clone(),
            force_n: depth_mm
                .iter()
                .map(|depth| stiffness * curves.force_n(*depth))
                .collect(),
            pressure_kpa: depth_mm
                .iter()
                .map(|depth| scaled(curves.pressure_kpa(*depth)))
                .collect(),
            stress_kpa_per_mm: depth_mm
                .iter()
                .map(|depth| scaled(curves.stress_kpa_per_mm(*depth)))
                .collect(),
            depth_mm,
            simulated,
        })
    }

    /// Number of frames.
    #[must_use]
    pub fn n_frames(&self) -> usize {
        self.time_s.len()
    }
}

/// Depth of each frame below first touch, mm.
fn depths_mm(press: &Press, touch_z_mm: f64, contact_offset_mm: f64) -> Vec<f64> {
    press
        .gel_from_indenter
        .iter()
        .map(|pose| touch_z_mm - pose.position_mm.z + contact_offset_mm)
        .collect()
}

/// The simulated side of every press of a recording. `tables` answer `places.requests`, whatever their tip
/// radius.
pub fn features(
    recording: &Recording,
    places: &Places,
    tables: &[DepthTable],
    bench: &Bench,
) -> Result<Vec<Features>, DigitacError> {
    let curves = curves(places, tables, recording.taxels.len())?;
    recording
        .presses
        .iter()
        .zip(&places.of_press)
        .map(|(press, &place)| {
            let touch_z_mm = places.requests[place].gel_from_indenter_at_touch.position_mm.z;
            Features::along(&curves[place], press, touch_z_mm, bench)
        })
        .collect()
}

/// Pairs every press of a recording with its simulation.
pub fn pair(
    recording: &Recording,
    places: &Places,
    tables: &[DepthTable],
    bench: &Bench,
    settings: &PairSettings,
) -> Result<Vec<PairedPress>, DigitacError> {
    let features = features(recording, places, tables, bench)?;
    recording
        .presses
        .iter()
        .zip(features)
        .map(|(press, features)| pair_press(press, features, settings))
        .collect()
}

/// Interpolates the table of each place.
pub(crate) fn curves(
    places: &Places,
    tables: &[DepthTable],
    n_taxels: usize,
) -> Result<Vec<DepthCurves>, DigitacError> {
    if tables.len() != places.requests.len() {
        return Err(DigitacError::DepthTableCount {
            expected: places.requests.len(),
            found: tables.len(),
        });
    }
    tables
        .iter()
        .enumerate()
        .map(|(index, table)| {
            DepthCurves::new(table, n_taxels).map_err(|source| DigitacError::DepthTable { index, source })
        })
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
    let readings_kpa = warp.apply(&press.taxels_kpa);
    let mut valid = warp.apply_valid(&press.valid);
    for ((row, readings), simulated) in valid.iter_mut().zip(&readings_kpa).zip(&features.simulated) {
        for (valid, reading) in row.iter_mut().zip(readings) {
            *valid &= *simulated && reading.is_finite();
        }
    }
    let measured_force_n = press.force_n.as_ref().map(|force_n| {
        let rows: Vec<Vec<f64>> = force_n.iter().map(|f| vec![*f]).collect();
        warp.apply(&rows).into_iter().flatten().collect()
    });
    Ok(PairedPress {
        name: press.name.clone(),
        file: press.mounting.clone(),
        indenter: press.indenter.clone(),
        place_mm: deepest_pose(press)?.position_mm.truncate().to_array(),
        features,
        measured_force_n,
        readings_kpa,
        valid,
        warp,
    })
}

/// Compares force with force; without a force sensor, the sum of the positive readings with the sum of the
/// positive port pressures.
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
