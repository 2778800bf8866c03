//! Sums over nodal fields.

use std::ops::{AddAssign, Mul};

use glam::DVec3;

/// The scalar product.
pub(crate) fn dot(a: &[DVec3], b: &[DVec3]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a.dot(*b)).sum()
}

/// `sums += other times`
pub(crate) fn add<T: Copy + AddAssign + Mul<f64, Output = T>>(sums: &mut [T], other: &[T], times: f64) {
    for (sum, other) in sums.iter_mut().zip(other) {
        *sum += *other * times;
    }
}

/// `from + other times`
pub(crate) fn moved<T: Copy + AddAssign + Mul<f64, Output = T>>(
    from: &[T],
    other: &[T],
    times: f64,
) -> Vec<T> {
    let mut sums = from.to_vec();
    add(&mut sums, other, times);
    sums
}
