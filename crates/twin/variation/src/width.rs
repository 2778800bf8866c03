//! Standard deviations from a few values, with their standard errors.

/// Number of values below which a text says that they are few.
const FEW: usize = 20;

/// A standard deviation, its standard error for normally distributed values, and the number of
/// values.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Width {
    pub value: f64,
    pub uncertainty: f64,
    pub n: usize,
}

impl Width {
    /// About the mean of the values; `None` for fewer than two.
    pub(crate) fn about_mean(values: &[f64]) -> Option<Self> {
        let middle = mean(values);
        let square: f64 = values.iter().map(|value| (value - middle).powi(2)).sum();
        (values.len() > 1).then(|| Self::of(square, values.len() - 1, values.len()))
    }

    /// About zero; `None` without values.
    pub(crate) fn about_zero(values: &[f64]) -> Option<Self> {
        let square: f64 = values.iter().map(|value| value.powi(2)).sum();
        (!values.is_empty()).then(|| Self::of(square, values.len(), values.len()))
    }

    fn of(square: f64, freedom: usize, n: usize) -> Self {
        let value = (square / freedom as f64).sqrt();
        Self {
            value,
            uncertainty: value / (2.0 * freedom as f64).sqrt(),
            n,
        }
    }

    /// The same in another unit.
    pub(crate) fn times(self, factor: f64) -> Self {
        Self {
            value: self.value * factor.abs(),
            uncertainty: self.uncertainty * factor.abs(),
            ..self
        }
    }

    /// Subtracts, in squares, the root mean square of the values' own errors; `None` if nothing is
    /// left.
    pub(crate) fn without(self, error: f64) -> Option<Self> {
        let square = self.value.powi(2) - error.powi(2);
        (square > 0.0).then(|| Self {
            value: square.sqrt(),
            uncertainty: self.uncertainty * self.value / square.sqrt(),
            ..self
        })
    }

    /// As text: `± 0.03, from 8 values only`.
    pub(crate) fn sureness(&self) -> String {
        let only = if self.n < FEW { " only" } else { "" };
        format!("± {}, from {} values{only}", digits(self.uncertainty, 2), self.n)
    }
}

/// The mean; zero without values.
pub(crate) fn mean(values: &[f64]) -> f64 {
    values.iter().sum::<f64>() / values.len().max(1) as f64
}

/// Probability of one of `n_fates` states, which `seen` of `n` taxels had: Laplace's rule of
/// succession for several outcomes.
pub(crate) fn succession(seen: usize, n: usize, n_fates: usize) -> f64 {
    (seen + 1) as f64 / (n + n_fates) as f64
}

/// A number with so many significant digits.
pub(crate) fn rounded(value: f64, n_digits: i32) -> f64 {
    if value == 0.0 || !value.is_finite() {
        return value;
    }
    // Conversion through text gives exactly 0.3 for 0.3.
    let n_digits = (n_digits - 1).max(0) as usize;
    format!("{value:.n_digits$e}").parse().unwrap_or(value)
}

/// The same as text.
pub(crate) fn digits(value: f64, n_digits: i32) -> String {
    format!("{}", rounded(value, n_digits))
}

#[cfg(test)]
mod tests {
    use twintac_random::{normal, stream};

    use super::*;

    #[test]
    fn a_width_is_recovered_within_its_error() {
        let mut random = stream(1, "widths");
        let mut off = 0.0;
        for _ in 0..400 {
            let values: Vec<f64> = (0..8).map(|_| 3.0 + normal(&mut random, 0.2)).collect();
            let found = Width::about_mean(&values).unwrap();
            assert_eq!(found.n, 8);
            off += ((found.value - 0.2) / (0.2 / 14.0_f64.sqrt())).powi(2);
            assert!((found.uncertainty - found.value / 14.0_f64.sqrt()).abs() < 1e-12);
        }
        // The standard error of a standard deviation of eight values is about a quarter of it. The
        // estimates must deviate by about that much.
        assert!((0.8..1.25).contains(&(off / 400.0)), "{off}");
        let many: Vec<f64> = (0..4000).map(|_| normal(&mut random, 0.2)).collect();
        let found = Width::about_zero(&many).unwrap();
        assert!((found.value - 0.2).abs() < 4.0 * found.uncertainty && found.uncertainty < 0.003);
    }

    #[test]
    fn what_values_are_off_by_themselves_is_taken_off() {
        let mut random = stream(1, "errors");
        let values: Vec<f64> = (0..4000)
            .map(|_| normal(&mut random, 0.3) + normal(&mut random, 0.4))
            .collect();
        let found = Width::about_mean(&values).unwrap();
        assert!((found.value - 0.5).abs() < 0.03);
        assert!((found.without(0.4).unwrap().value - 0.3).abs() < 0.03);
        assert_eq!(found.without(0.6), None);
        assert_eq!((Width::about_mean(&[1.0]), Width::about_zero(&[])), (None, None));
    }

    #[test]
    fn numbers_are_short() {
        assert_eq!((rounded(0.123_456, 3), rounded(117.49, 3)), (0.123, 117.0));
        assert_eq!(digits(3.051_757e-5, 3), "0.0000305");
        assert_eq!(succession(0, 8, 4), 1.0 / 12.0);
    }
}
