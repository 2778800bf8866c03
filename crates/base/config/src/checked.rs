//! Allowed ranges of the numbers of settings, stated once for each type.

use std::fmt::{self, Display};
use std::ops::RangeInclusive;

use crate::{ConfigError, Document};

/// Settings that state the allowed range of each of their numbers.
///
/// Destructure `self` in [`check`](Self::check): then a field that was forgotten does not compile.
///
/// ```
/// use twintac_config::{Checked, Ranges};
///
/// struct Hold { depth_mm: f64, repeats: usize }
///
/// impl Checked for Hold {
///     fn check(&self, ranges: &mut Ranges) {
///         let Self { depth_mm, repeats } = self;
///         ranges.number("depth_mm", *depth_mm, 0.01..=50.0);
///         ranges.number("repeats", *repeats, 1.0..=1000.0);
///     }
/// }
///
/// let problem = Hold { depth_mm: 1e300, repeats: 1 }.checked().unwrap_err();
/// assert_eq!(problem.to_string(), "`depth_mm` is 1e300; give 0.01 to 50");
/// ```
pub trait Checked {
    /// Passes each number to `ranges` with its allowed range.
    fn check(&self, ranges: &mut Ranges);

    /// Checks that all numbers are within their ranges.
    ///
    /// # Errors
    /// The first number that is not.
    fn checked(&self) -> Result<(), Problem> {
        let mut ranges = Ranges::default();
        self.check(&mut ranges);
        ranges.finish()
    }
}

/// A field with a value that is not allowed.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("`{field}` {problem}; {hint}")]
pub struct Problem {
    /// Dotted path of the field, with array indices from 0.
    pub field: String,
    /// What is wrong: the end of a sentence that begins with the field's name.
    pub problem: String,
    /// What to do about it.
    pub hint: String,
}

impl Problem {
    /// What is wrong with a field, and what to do.
    pub fn new(field: impl Into<String>, problem: impl Into<String>, hint: impl Into<String>) -> Self {
        Self {
            field: field.into(),
            problem: problem.into(),
            hint: hint.into(),
        }
    }
}

/// Compares numbers with their ranges, and keeps the first number that is outside.
#[derive(Debug, Default)]
pub struct Ranges {
    inside: String,
    first: Option<Problem>,
}

impl Ranges {
    /// Checks a number against a range; both ends belong to it.
    pub fn number(&mut self, field: &str, value: impl Number, range: RangeInclusive<f64>) {
        let number = value.number();
        let hint = || format!("give {} to {}", Shown(*range.start()), Shown(*range.end()));
        self.that(
            field,
            range.contains(&number),
            || format!("is {}", Shown(number)),
            hint,
        );
    }

    /// Checks a number that may also be 0, which switches off what the number controls.
    pub fn zero_or(&mut self, field: &str, value: impl Number, range: RangeInclusive<f64>) {
        let number = value.number();
        let hint = || format!("give 0, or {} to {}", Shown(*range.start()), Shown(*range.end()));
        let is_right = number == 0.0 || range.contains(&number);
        self.that(field, is_right, || format!("is {}", Shown(number)), hint);
    }

    /// Checks a list: at most `most` numbers, each within a range.
    pub fn numbers<N: Number>(&mut self, field: &str, values: &[N], most: usize, range: RangeInclusive<f64>) {
        self.that(
            field,
            values.len() <= most,
            || format!("has {} numbers", values.len()),
            || format!("give {most} at most"),
        );
        for (index, value) in values.iter().enumerate() {
            self.number(&format!("{field}[{index}]"), *value, range.clone());
        }
    }

    /// Checks that the numbers of a list rise strictly.
    pub fn rising(&mut self, field: &str, values: &[f64]) {
        let is_right = values.is_sorted_by(|a, b| a < b);
        self.that(
            field,
            is_right,
            || format!("is {values:?}"),
            || "give increasing numbers",
        );
    }

    /// Checks settings that are a field of these settings.
    pub fn inside(&mut self, field: &str, settings: &impl Checked) {
        let outside = self.inside.clone();
        self.inside = format!("{outside}{field}.");
        settings.check(self);
        self.inside = outside;
    }

    /// Ends the check.
    ///
    /// # Errors
    /// The first number that was outside of its range.
    pub fn finish(self) -> Result<(), Problem> {
        self.first.map_or(Ok(()), Err)
    }

    /// Checks any other condition on a field; `problem` and `hint` say what is wrong and what to do
    /// if it does not hold.
    pub fn that<P: Into<String>, H: Into<String>>(
        &mut self,
        field: &str,
        is_right: bool,
        problem: impl FnOnce() -> P,
        hint: impl FnOnce() -> H,
    ) {
        if !is_right && self.first.is_none() {
            self.first = Some(Problem::new(format!("{}{field}", self.inside), problem(), hint()));
        }
    }
}

/// A number of any type.
pub trait Number: Copy {
    /// Its value, to the nearest double.
    fn number(self) -> f64;
}

macro_rules! number {
    ($($kind:ty),*) => {$(
        impl Number for $kind {
            fn number(self) -> f64 {
                self as f64
            }
        }
    )*};
}

number!(f64, f32, usize, u64, u32, u16, u8);

/// A number as people write it: without an exponent unless it is very large or very small.
struct Shown(f64);

impl Display for Shown {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let size = self.0.abs();
        if size == 0.0 || !size.is_finite() || (1e-4..1e7).contains(&size) {
            write!(f, "{}", self.0)
        } else {
            write!(f, "{:e}", self.0)
        }
    }
}

impl<T: Checked> Document<T> {
    /// The value of the file, if all of its numbers are within their ranges.
    ///
    /// # Errors
    /// The first number that is not, at its line.
    pub fn checked(self) -> Result<T, ConfigError> {
        match self.value.checked() {
            Ok(()) => Ok(self.value),
            Err(problem) => Err(self.error(&problem.field, problem.problem, problem.hint)),
        }
    }
}
