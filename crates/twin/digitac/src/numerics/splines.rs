//! Smooth functions of a distance.

/// Cubic B-splines at a position, with knots at 0, 1, …, mirrored at 0, so that the slope of a sum
/// of them is zero there.
pub(crate) fn mirrored_splines<const N: usize>(position: f64) -> [f64; N] {
    let bell = |x: f64| {
        let x = x.abs();
        if x < 1.0 {
            2.0 / 3.0 - x * x + 0.5 * x.powi(3)
        } else if x < 2.0 {
            (2.0 - x).powi(3) / 6.0
        } else {
            0.0
        }
    };
    std::array::from_fn(|j| bell(position - j as f64) + if j > 0 { bell(position + j as f64) } else { 0.0 })
}
