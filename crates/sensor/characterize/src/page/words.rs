//! Figures as text.

use crate::Finding;

/// The first words of the text for a missing figure.
pub(super) const NOT_GIVEN: &str = "not given";

/// A number with `digits` significant digits and a typographic minus sign.
pub(super) fn number(value: f64, digits: i32) -> String {
    if !value.is_finite() {
        return "–".into();
    }
    if value == 0.0 {
        return "0".into();
    }
    let power = value.abs().log10().floor() as i32;
    let scale = 10f64.powi(digits - 1 - power);
    let rounded = (value * scale).round() / scale;
    let decimals = (digits - 1 - power).max(0) as usize;
    format!("{rounded:.decimals$}").replace('-', "−")
}

/// The smallest and the largest value as `a to b`, or a single number if both have the same text.
pub(super) fn span(values: impl Iterator<Item = f64> + Clone, digits: i32) -> String {
    let low = number(values.clone().fold(f64::INFINITY, f64::min), digits);
    let high = number(values.fold(f64::NEG_INFINITY, f64::max), digits);
    if low == high {
        low
    } else {
        format!("{low} to {high}")
    }
}

/// The text of a figure; for a missing one, a text that says so.
pub(super) fn or_not<T>(finding: &Finding<T>, words: impl FnOnce(&T) -> String) -> String {
    match finding {
        Finding::Found(figure) => words(figure),
        Finding::NotGiven(why) => format!("{NOT_GIVEN}: {why}"),
    }
}

/// The text of a figure; empty for a missing one.
pub(super) fn if_found<T>(finding: &Finding<T>, words: impl FnOnce(&T) -> String) -> String {
    finding.found().map_or(String::new(), words)
}

/// Name, value and condition of a figure. A figure that is not given has no condition.
pub(super) fn row(name: &str, value: String, condition: String) -> [String; 3] {
    let is_missing = value.starts_with(NOT_GIVEN);
    let condition = if is_missing { String::new() } else { condition };
    [name.to_owned(), value, condition]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_keep_their_digits() {
        assert_eq!(number(7.2412, 3), "7.24");
        assert_eq!(number(0.006_78, 2), "0.0068");
        assert_eq!(number(-212.4, 3), "−212");
        assert_eq!(number(9.996, 3), "10.00");
        assert_eq!(span([1.0, 2.0, 1.5].into_iter(), 2), "1.0 to 2.0");
    }
}
