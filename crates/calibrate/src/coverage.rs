//! How often the confidence intervals of a fit hold the truth.

use crate::matrix::solve;
use crate::statistics::student_quantile;

/// Part of the repetitions in which the 95 % interval of each unknown holds the truth, for a model that is linear with this Jacobian and
/// noise of one variance, drawn by `noise` (standard normal). None if the Jacobian's unknowns can't be told apart. `[n_unknowns]`
///
/// Each repetition estimates the unknowns and the variance anew, as a fit does.
pub fn coverage_95(
    jacobian: &[Vec<f64>],
    repetitions: u32,
    noise: &mut dyn FnMut() -> f64,
) -> Option<Vec<f64>> {
    let n = jacobian.first()?.len();
    let column = |i: usize| jacobian.iter().map(move |row| row[i]);
    let products = |i: usize, j: usize| column(i).zip(column(j)).map(|(a, b)| a * b).sum::<f64>();
    let normal: Vec<Vec<f64>> = (0..n).map(|i| (0..n).map(|j| products(i, j)).collect()).collect();
    let unit = |i: usize| (0..n).map(|j| f64::from(u8::from(i == j))).collect::<Vec<f64>>();
    let inverse: Vec<Vec<f64>> = (0..n).map(|i| solve(&normal, &unit(i))).collect::<Option<_>>()?;
    let freedom = (jacobian.len() - n) as f64;
    let quantile = student_quantile(0.975, freedom);
    let mut held = vec![0_u32; n];
    for _ in 0..repetitions {
        let errors: Vec<f64> = jacobian.iter().map(|_| noise()).collect();
        let right: Vec<f64> = (0..n)
            .map(|i| column(i).zip(&errors).map(|(a, e)| a * e).sum())
            .collect();
        let off = solve(&normal, &right)?;
        let left = jacobian.iter().zip(&errors).map(|(row, error)| {
            let fitted: f64 = row.iter().zip(&off).map(|(a, x)| a * x).sum();
            (error - fitted).powi(2)
        });
        let deviation = (left.sum::<f64>() / freedom).sqrt();
        for i in 0..n {
            held[i] += u32::from(off[i].abs() <= quantile * deviation * inverse[i][i].sqrt());
        }
    }
    Some(
        held.iter()
            .map(|&count| f64::from(count) / f64::from(repetitions))
            .collect(),
    )
}
