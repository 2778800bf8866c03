//! Texts of devices and people: the force sensor's page, calibrations, recorded wrenches.

use twintac_rig::netft::Configuration;
use twintac_rig::{AnalogCalibration, Replay};

/// Checks a text. The first byte chooses its kind.
pub(crate) fn texts(bytes: &[u8]) {
    let Some((kind, text)) = bytes.split_first() else {
        return;
    };
    let Ok(text) = std::str::from_utf8(text) else {
        return;
    };
    match kind % 4 {
        0 => page(text),
        1 => check(AnalogCalibration::parse_cal("FT.cal", text).ok()),
        2 => check(AnalogCalibration::parse_toml("cal.toml", text).ok()),
        _ => rows(text),
    }
}

fn page(text: &str) {
    if let Ok(configuration) = Configuration::parse("page", text) {
        assert!(configuration.counts_per_force > 0.0 && configuration.counts_per_torque > 0.0);
        let wrench = configuration.wrench([1, -1, i32::MIN, i32::MAX, 0, 1]);
        assert!(!wrench.force_n.is_nan() && !wrench.torque_n_mm.is_nan());
        let again = Configuration::parse("page", &configuration.to_xml()).unwrap();
        assert_eq!(again, configuration);
    }
}

fn check(calibration: Option<AnalogCalibration>) {
    let Some(calibration) = calibration else { return };
    let mut numbers = calibration.matrix.iter().flatten().chain(&calibration.bias_v);
    assert!(numbers.all(|number| number.is_finite()));
    assert!(calibration.range_v > 0.0);
    assert!(calibration.wrench([f64::NAN; 6]).is_err());
    let _ = calibration.wrench([0.1; 6]);
}

fn rows(text: &str) {
    if let Ok(rows) = Replay::rows("file.csv", text) {
        assert!(rows.windows(2).all(|pair| pair[1].0 > pair[0].0));
        assert!(rows.len() < text.len(), "a row has bytes");
        for (time_s, wrench) in rows {
            assert!(time_s.is_finite() && wrench.force_n.is_finite() && wrench.torque_n_mm.is_finite());
        }
    }
}
