//! Viscoelastic relaxation of a reading: overstresses that follow each change of the elastic
//! reading and fade (quasi-linear viscoelasticity).
//!
//! With the elastic reading r(t), each time constant τ has dq/dt = dr/dt - q/τ, and a barometer
//! reads r + Σ c q (a generalized Maxwell solid, Simo and Hughes, Computational Inelasticity,
//! section 10.3). A relaxation of this form is linear, stable and fading, so it cannot overfit the
//! sequence of presses.

/// The remaining share of the old overstress, and the share of a change that becomes overstress,
/// over a time step in which r changes linearly (exact).
pub(crate) fn step(duration_s: f64, time_constant_s: f64) -> (f64, f64) {
    let ratio = duration_s / time_constant_s;
    let kept = (-ratio).exp();
    let arrived = if ratio > 1e-8 {
        -(-ratio).exp_m1() / ratio
    } else {
        1.0
    };
    (kept, arrived)
}

/// The overstress of each frame, from zero; `[n_frames]`.
#[cfg(test)]
fn of(time_s: &[f64], elastic: &[f64], time_constant_s: f64) -> Vec<f64> {
    let mut q = vec![0.0; elastic.len()];
    for i in 1..elastic.len() {
        let (kept, arrived) = step(time_s[i] - time_s[i - 1], time_constant_s);
        q[i] = kept * q[i - 1] + arrived * (elastic[i] - elastic[i - 1]);
    }
    q
}

/// The overstresses of a press from rest as a matrix, row by row: the overstress of frame i is Σ
/// over j of `matrix[i * n_frames + j]` × elastic reading j.
pub(crate) fn matrix(time_s: &[f64], time_constant_s: f64) -> Vec<f64> {
    let n = time_s.len();
    let mut matrix = vec![0.0; n * n];
    for i in 1..n {
        let (kept, arrived) = step(time_s[i] - time_s[i - 1], time_constant_s);
        let (before, row) = matrix.split_at_mut(i * n);
        for (now, then) in row[..i].iter_mut().zip(&before[(i - 1) * n..]) {
            *now = kept * then;
        }
        row[i] += arrived;
        row[i - 1] -= arrived;
    }
    matrix
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_ramp_and_hold_meets_the_closed_form() {
        let tau = 1.7;
        let time_s: Vec<f64> = (0..80)
            .map(|i| 0.05 * f64::from(i) + 0.01 * f64::from(i % 3))
            .collect();
        let ramp_s = time_s[30];
        let elastic: Vec<f64> = time_s.iter().map(|t| 2.0 * t.min(ramp_s)).collect();
        let q = of(&time_s, &elastic, tau);
        for (t, q) in time_s.iter().zip(&q) {
            let loaded = 2.0 * tau * (1.0 - (-t.min(ramp_s) / tau).exp());
            let expected = loaded * (-(t - ramp_s).max(0.0) / tau).exp();
            assert!((q - expected).abs() < 1e-12, "at {t} s: {q}, expected {expected}");
        }
    }

    #[test]
    fn the_matrix_is_the_recurrence() {
        let time_s: Vec<f64> = (0..40).map(|i| f64::from(i * i) * 0.003).collect();
        let elastic: Vec<f64> = time_s.iter().map(|t| (3.0 * t).sin()).collect();
        let matrix = matrix(&time_s, 0.8);
        let q = of(&time_s, &elastic, 0.8);
        for (row, q) in matrix.chunks(40).zip(q) {
            let product: f64 = row.iter().zip(&elastic).map(|(m, r)| m * r).sum();
            assert!((product - q).abs() < 1e-12);
        }
    }
}
