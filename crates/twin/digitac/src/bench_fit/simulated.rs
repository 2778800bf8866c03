//! Tables over depth, read along presses for an estimated test setup.

use twintac_depth_table::{DepthCurves, DepthTable};
use twintac_recording::{Control, Press, Recording};

use super::{BenchEstimate, Places, deepest_pose};
use crate::features::zero_frames;
use crate::{DigitacError, Features};

/// Distance beyond its end up to which a table counts as valid, mm or N.
const BEYOND: f64 = 1e-6;

/// The simulated side of every press of a recording. `tables` answer `places.requests`, for any tip
/// radius.
pub fn features(
    recording: &Recording,
    places: &Places,
    tables: &[DepthTable],
    bench: &BenchEstimate,
) -> Result<Vec<Features>, DigitacError> {
    let curves = curves(places, tables, recording.taxels.len())?;
    let mut features: Vec<Features> = recording
        .presses
        .iter()
        .zip(&places.of_press)
        .map(|(press, &place)| {
            let touch_z_mm = places.requests[place].gel_from_indenter_at_touch.position_mm.z;
            features_along(&curves[place], press, touch_z_mm, bench)
        })
        .collect::<Result<_, _>>()?;
    if bench.has_history && !features.is_empty() {
        follow_each_other(&recording.presses, &mut features);
    }
    Ok(features)
}

/// Interpolates the table of each location.
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

/// Reads the curves of a location along a press.
pub(crate) fn features_along(
    curves: &DepthCurves,
    press: &Press,
    touch_z_mm: f64,
    bench: &BenchEstimate,
) -> Result<Features, DigitacError> {
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
            let force_n =
                force_n.ok_or_else(|| DigitacError::press(&press.name, "prescribes a force but has none"))?;
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
    let place_mm = deepest_pose(press)?.position_mm.truncate().to_array();
    let correction = bench.correction_at(place_mm);
    let pressure_kpa = |depth_mm: f64| {
        let mut row = curves.pressure_kpa(depth_mm);
        correction.apply(depth_mm, curves.slopes_kpa_per_mm(depth_mm), &mut row);
        scaled(row)
    };
    Ok(Features {
        time_s: press.time_s.clone(),
        force_n: depth_mm
            .iter()
            .map(|depth| stiffness * curves.force_n(*depth))
            .collect(),
        pressure_kpa: depth_mm.iter().map(|depth| pressure_kpa(*depth)).collect(),
        stress_kpa_per_mm: depth_mm
            .iter()
            .map(|depth| scaled(curves.stress_kpa_per_mm(*depth)))
            .collect(),
        since_previous_s: None,
        zero_frames: zero_frames(&press.time_s, &depth_mm),
        depth_mm,
        simulated,
    })
}

/// A press without simulated values: enough to know when it was in contact.
pub(crate) fn bare_features(press: &Press, touch_z_mm: f64) -> Features {
    let depth_mm = match press.control {
        Control::Pose => depths_mm(press, touch_z_mm, 0.0),
        Control::Force => press.force_n.clone().unwrap_or_default(),
    };
    Features {
        time_s: press.time_s.clone(),
        force_n: Vec::new(),
        pressure_kpa: Vec::new(),
        stress_kpa_per_mm: Vec::new(),
        simulated: Vec::new(),
        since_previous_s: None,
        zero_frames: zero_frames(&press.time_s, &depth_mm),
        depth_mm,
    }
}

/// Writes into the features of each press the time since the end of the press before it, if that
/// was one of the same installation on the same clock.
pub(crate) fn follow_each_other(presses: &[Press], features: &mut [Features]) {
    for (pair, features) in presses.windows(2).zip(&mut features[1..]) {
        let [before, press] = pair else { continue };
        if let (Some(ended_s), Some(started_s)) = (before.time_s.last(), press.time_s.first())
            && before.mounting == press.mounting
            && started_s > ended_s
        {
            features.since_previous_s = Some(started_s - ended_s);
        }
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
