//! The median.

/// The middle one of numbers, the upper one of two; `None` if there is none.
pub(super) fn median(mut numbers: Vec<f64>) -> Option<f64> {
    let middle = numbers.len() / 2;
    if numbers.is_empty() {
        return None;
    }
    let (_, value, _) = numbers.select_nth_unstable_by(middle, f64::total_cmp);
    Some(*value)
}
