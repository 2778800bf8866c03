//! What numbers of settings may be, said once for each type.

use std::fmt::{self, Display};
use std::ops::RangeInclusive;

use crate::{ConfigError, Document};

/// Settings that say what each of their numbers may be.
///
/// Take `self` apart in [`check`](Self::check), so that a field without a range does not compile:
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
    /// Names every number and what it may be.
    fn check(&self, ranges: &mut Ranges);

    /// Whether all numbers are what they may be.
    ///
    /// # Errors
    /// The first that is not.
    fn checked(&self) -> Result<(), Problem> {
        let mut ranges = Ranges::default();
        self.check(&mut ranges);
        ranges.finish()
    }
}

/// A field that cannot be what it is.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("`{field}` {problem}; {hint}")]
pub struct Problem {
    /// Dotted path of the field, with array indices from 0.
    pub field: String,
    /// What is wrong, read after the field's name.
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

/// Takes the ranges of numbers, and remembers the first number that is beyond its own.
#[derive(Debug, Default)]
pub struct Ranges {
    inside: String,
    first: Option<Problem>,
}

impl Ranges {
    /// A number, and from where to where it makes sense, both included.
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

    /// The same of a number that may be zero as well: what it is about is then left out.
    pub fn zero_or(&mut self, field: &str, value: impl Number, range: RangeInclusive<f64>) {
        let number = value.number();
        let hint = || format!("give 0, or {} to {}", Shown(*range.start()), Shown(*range.end()));
        let is_right = number == 0.0 || range.contains(&number);
        self.that(field, is_right, || format!("is {}", Shown(number)), hint);
    }

    /// A list of so many numbers at most, each in a range.
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

    /// A list of numbers that rise.
    pub fn rising(&mut self, field: &str, values: &[f64]) {
        let is_right = values.is_sorted_by(|a, b| a < b);
        self.that(
            field,
            is_right,
            || format!("is {values:?}"),
            || "give numbers that rise",
        );
    }

    /// Settings inside of these.
    pub fn inside(&mut self, field: &str, settings: &impl Checked) {
        let outside = self.inside.clone();
        self.inside = format!("{outside}{field}.");
        settings.check(self);
        self.inside = outside;
    }

    /// The first number that is beyond its range, if there is one.
    ///
    /// # Errors
    /// That number.
    pub fn finish(self) -> Result<(), Problem> {
        self.first.map_or(Ok(()), Err)
    }

    /// Anything else that has to hold of a field: otherwise, what is wrong and what to do.
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

/// A number of any kind.
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

/// A number as people write it.
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
    /// What the file says, if all of its numbers are what they may be.
    ///
    /// # Errors
    /// The first that is not, at its line.
    pub fn checked(self) -> Result<T, ConfigError> {
        match self.value.checked() {
            Ok(()) => Ok(self.value),
            Err(problem) => Err(self.error(&problem.field, problem.problem, problem.hint)),
        }
    }
}
