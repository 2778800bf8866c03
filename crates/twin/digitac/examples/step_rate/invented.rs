//! A twin of an invented sensor, trained briefly on invented presses.

use std::collections::BTreeSet;
use std::ops::ControlFlow;

use digitac::{DigitacError, Features, PairedPress, Scale, Split, TrainSettings, Twin, Variant, Warp, train};

/// Number of frames of a press.
const N_FRAMES: usize = 60;

/// Inputs of the twin at a frame, kPa or kPa/mm; `[n_taxels]`.
pub(crate) fn seen(press: usize, frame: usize, n_taxels: usize) -> Vec<f64> {
    let depth = (0.05 * frame as f64).sin().max(0.0);
    (0..n_taxels)
        .map(|taxel| 40.0 * depth * (1.0 + (1.3 * taxel as f64 + 0.7 * press as f64).sin()))
        .collect()
}

/// A press along which readings are proportional to pressures.
pub(crate) fn features(press: usize, n_frames: usize, n_taxels: usize) -> Features {
    let rows: Vec<Vec<f64>> = (0..n_frames).map(|frame| seen(press, frame, n_taxels)).collect();
    Features {
        time_s: (0..n_frames).map(|frame| 0.02 * frame as f64).collect(),
        depth_mm: vec![1.0; n_frames],
        force_n: vec![1.0; n_frames],
        pressure_kpa: rows.clone(),
        stress_kpa_per_mm: rows,
        simulated: vec![true; n_frames],
        since_previous_s: None,
        zero_frames: 0..0,
    }
}

/// A twin of `n_taxels` taxels, with layers of the usual width.
pub(crate) fn twin(variant: Variant, n_taxels: usize) -> Result<Twin, DigitacError> {
    let press = |number: usize| {
        let features = features(number, N_FRAMES, n_taxels);
        let halved = |row: &Vec<f64>| row.iter().map(|kpa| 0.5 * kpa).collect();
        PairedPress {
            name: format!("press {number}"),
            mounting: "invented".to_owned(),
            indenter: "invented".to_owned(),
            place_mm: [number as f64, 0.0],
            measured_force_n: None,
            readings_kpa: features.pressure_kpa.iter().map(halved).collect(),
            valid: vec![vec![true; n_taxels]; N_FRAMES],
            warp: Warp {
                measured_index: (0..N_FRAMES).map(|frame| frame as f64).collect(),
                cost: 0.0,
                largest_shift_s: 0.0,
            },
            features,
        }
    };
    let presses: Vec<PairedPress> = (0..6).map(press).collect();
    let split = Split {
        train: vec![0, 1, 2, 3],
        validation: vec![4, 5],
        test: Vec::new(),
    };
    let settings = TrainSettings {
        variants: Some(vec![variant]),
        epochs: 2,
        ..TrainSettings::default()
    };
    let taxels: Vec<String> = (0..n_taxels).map(|taxel| format!("t{taxel}")).collect();
    let scale = Scale::of(&presses, BTreeSet::new());
    let trained = train(&presses, &taxels, &split, &scale, &settings, 1, &mut |_| {
        ControlFlow::Continue(())
    })?;
    trained
        .into_iter()
        .next()
        .map(|trained| trained.twin)
        .ok_or(DigitacError::TooFew {
            expected: "a trained variant".to_owned(),
            found: "none".to_owned(),
        })
}
