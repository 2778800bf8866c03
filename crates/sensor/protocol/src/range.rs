//! A number, a range or a choice.

use rand::Rng;
use serde::{Deserialize, Serialize};
use twintac_random::RandomStream;

/// A fixed number, a range with a uniform distribution, or a choice with equal probabilities.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(untagged, expecting = "expected a number, [from, to] or { one_of = [...] }")]
pub enum Range {
    /// A fixed number.
    Fixed(f64),
    /// Uniform between the two numbers.
    Between([f64; 2]),
    /// One of the numbers, with equal probabilities.
    OneOf(OneOf),
}

/// The numbers of a choice.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct OneOf {
    /// The numbers; at least one.
    one_of: Vec<f64>,
}

impl Default for Range {
    fn default() -> Self {
        Self::Fixed(0.0)
    }
}

impl Range {
    pub(crate) fn ends(&self) -> [f64; 2] {
        match self {
            Self::Fixed(value) => [*value, *value],
            Self::Between(ends) => *ends,
            Self::OneOf(OneOf { one_of }) => [
                one_of.iter().copied().fold(f64::INFINITY, f64::min),
                one_of.iter().copied().fold(f64::NEG_INFINITY, f64::max),
            ],
        }
    }

    fn numbers(&self) -> &[f64] {
        match self {
            Self::Fixed(value) => std::slice::from_ref(value),
            Self::Between(ends) => ends,
            Self::OneOf(OneOf { one_of }) => one_of,
        }
    }

    pub(crate) fn draw(&self, random: &mut RandomStream) -> f64 {
        let [low, high] = self.ends();
        let share = random.random::<f64>();
        match self {
            Self::OneOf(OneOf { one_of }) => one_of[(share * one_of.len() as f64) as usize],
            _ => low + (high - low) * share,
        }
    }

    /// What is wrong if the values must lie between the two numbers: the problem and a hint.
    pub(crate) fn problem(&self, [least, most]: [f64; 2]) -> Option<(String, String)> {
        let [low, high] = self.ends();
        if matches!(self, Self::OneOf(OneOf { one_of }) if one_of.is_empty()) {
            return Some((
                "has an empty `one_of`".to_owned(),
                "give one number or more".to_owned(),
            ));
        }
        if let Some(strange) = self.numbers().iter().find(|number| !number.is_finite()) {
            return Some((format!("is {strange}"), "give finite numbers".to_owned()));
        }
        if low > high {
            return Some((
                format!("runs from {low} to {high}"),
                "give the smaller number first".to_owned(),
            ));
        }
        if low < least {
            return Some((format!("is {low}"), format!("give {least} or more")));
        }
        (high > most).then(|| (format!("is {high}"), format!("give {most} or less")))
    }
}
