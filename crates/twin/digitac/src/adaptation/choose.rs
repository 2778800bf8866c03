//! Selection of the presses for an adaptation: the most informative ones.
//!
//! The selection uses poses and the available twin, not measurements. The selected presses should
//! leave as little uncertainty as possible in the predictions of all presses: each next press is
//! the one after which the sum of the variances of all predictions is the smallest (I-optimal
//! design, Atkinson, Donev and Tobias 2007, chapter 10; one press after another). This spreads the
//! presses over files, whose contact heights differ, over taxels, and over distances from these.

use rand::seq::SliceRandom;

use super::NewSensor;
use crate::numerics::inverse_symmetric;
use crate::{DigitacError, seed};

/// If there are more candidates than this, this many are drawn at random.
const MAX_CANDIDATES: usize = 120;
/// At each step, one in this many candidates is randomly left out.
const ASIDE: usize = 5;

/// Presses among `candidates` for the adaptation of a twin, `n_presses` at most, in the order of
/// their selection. At each step, a random fifth of the candidates is left out.
///
/// # Errors
/// No press that touches the gel; tables that do not belong to the locations; damaged presses.
pub fn choose_presses(
    sensor: &NewSensor<'_>,
    candidates: &[usize],
    n_presses: usize,
    seed_number: u64,
) -> Result<Vec<usize>, DigitacError> {
    let mut random = seed::stream(seed_number, "adaptation");
    let mut left = candidates.to_vec();
    left.shuffle(&mut random);
    left.truncate(MAX_CANDIDATES.max(n_presses));
    let features = sensor.features(sensor.bench)?;
    sensor.refuse_untouched(&features, left.iter().copied())?;
    let predicted_kpa = sensor.twin.predict(&features.iter().collect::<Vec<_>>());
    let (told, known) = sensor
        .learned()
        .information(&left.iter().copied().collect(), &predicted_kpa)?;
    let n = known.len();
    let mut all = vec![0.0; n * n];
    told.values().for_each(|matrix| add(&mut all, matrix));
    let mut sum = vec![0.0; n * n];
    for (i, known) in known.iter().enumerate() {
        sum[i * n + i] = *known;
    }
    let is_free: Vec<bool> = known.iter().map(|known| *known > 0.0).collect();
    let unknown_after = |sum: &[f64], press: &usize| {
        let mut sum = sum.to_vec();
        add(&mut sum, &told[press]);
        trace_of_product(&inverse_symmetric(&sum, &is_free), &all, n)
    };
    let mut chosen = Vec::new();
    while chosen.len() < n_presses && !left.is_empty() {
        left.shuffle(&mut random);
        let considered = left[..left.len() - left.len() / ASIDE].iter().enumerate();
        let unknown = considered.map(|(index, press)| (index, unknown_after(&sum, press)));
        let Some((index, _)) = unknown.min_by(|a, b| a.1.total_cmp(&b.1)) else {
            break;
        };
        let press = left.swap_remove(index);
        add(&mut sum, &told[&press]);
        chosen.push(press);
    }
    Ok(chosen)
}

fn add(to: &mut [f64], matrix: &[f64]) {
    to.iter_mut().zip(matrix).for_each(|(to, value)| *to += value);
}

/// Trace of the product of a symmetric matrix with one of which only the lower triangle counts.
fn trace_of_product(symmetric: &[f64], lower: &[f64], n: usize) -> f64 {
    let row = |i: usize| -> f64 {
        let below: f64 = (0..i).map(|j| symmetric[i * n + j] * lower[i * n + j]).sum();
        2.0 * below + symmetric[i * n + i] * lower[i * n + i]
    };
    (0..n).map(row).sum()
}
