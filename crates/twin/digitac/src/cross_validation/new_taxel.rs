//! A held-out taxel: its gain comes from one press, all other values are the means of the other
//! taxels.

use std::collections::BTreeSet;

use twintac_recording::Recording;

use crate::numerics::minimize;
use crate::{DigitacError, Features, PairedPress, Twin};

/// Largest ratio of the gain to the mean of the other taxels, and of that mean to the gain.
const REACH: f64 = 20.0;
/// Tolerance of ln gain.
const TOLERANCE: f64 = 1e-4;

/// A recording without the readings of a taxel.
pub(super) fn without(recording: &Recording, taxel: usize) -> Recording {
    let mut recording = recording.clone();
    for press in &mut recording.presses {
        press.valid.iter_mut().for_each(|row| row[taxel] = false);
    }
    recording
}

/// The twin with the taxel's gain from the training press with the taxel's largest reading, by
/// least absolute deviations.
pub(super) fn with_gain(
    twin: &Twin,
    taxel: usize,
    pairs: &[PairedPress],
    training_presses: &[usize],
    left_out: &BTreeSet<usize>,
) -> Result<Twin, DigitacError> {
    let Some(press) = largest(pairs, training_presses, taxel) else {
        return Err(DigitacError::TooFew {
            expected: format!("a press with readings of {}", twin.taxels()[taxel]),
            found: "none".into(),
        });
    };
    let press = &pairs[press];
    let mut gains = twin.gains().clone();
    let mean_of_others = |of: &dyn Fn(usize) -> f64| {
        let others = (0..gains.gain.len()).filter(|other| *other != taxel && !left_out.contains(other));
        others.clone().map(of).sum::<f64>() / others.count().max(1) as f64
    };
    let start = mean_of_others(&|k| gains.gain[k]);
    // The gel's part of the static nonlinearity depends on the port pressure.
    let stiffening = mean_of_others(&|k| gains.stiffening_per_kpa[k] * gains.gain[k]);
    let memory: Vec<f64> = (0..gains.memory.first().map_or(0, Vec::len))
        .map(|j| mean_of_others(&|k| gains.memory[k][j]))
        .collect();
    gains.memory[taxel] = memory;
    let features = Features {
        since_previous_s: None,
        ..press.features.clone()
    };
    let mut deviation_kpa = |ln_gain: f64| {
        gains.gain[taxel] = ln_gain.exp();
        gains.stiffening_per_kpa[taxel] = stiffening / gains.gain[taxel];
        let predicted = gains.readings_kpa(&[&features]).swap_remove(0);
        let rows = predicted.iter().zip(&press.readings_kpa).zip(&press.valid);
        rows.filter(|(_, valid)| valid[taxel])
            .map(|((predicted, measured), _)| (predicted[taxel] - measured[taxel]).abs())
            .sum()
    };
    let middle = start.max(f64::MIN_POSITIVE).ln();
    let reach = REACH.ln();
    let (ln_gain, _) = minimize(middle - reach, middle + reach, TOLERANCE, &mut deviation_kpa);
    gains.gain[taxel] = ln_gain.exp();
    gains.stiffening_per_kpa[taxel] = stiffening / gains.gain[taxel];
    Ok(twin.with_gains(gains))
}

/// The press with the largest reading of a taxel, among some.
fn largest(pairs: &[PairedPress], among: &[usize], taxel: usize) -> Option<usize> {
    let peak = |press: &PairedPress| {
        let rows = press.readings_kpa.iter().zip(&press.valid);
        rows.filter(|(_, valid)| valid[taxel])
            .map(|(row, _)| row[taxel])
            .fold(f64::NEG_INFINITY, f64::max)
    };
    let best = among
        .iter()
        .copied()
        .max_by(|a, b| peak(&pairs[*a]).total_cmp(&peak(&pairs[*b])));
    best.filter(|&press| peak(&pairs[press]) > 0.0)
}
