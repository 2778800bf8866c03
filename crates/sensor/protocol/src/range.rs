//! A number, or a range to draw it from.

use rand::Rng;
use serde::{Deserialize, Serialize};
use twintac_random::RandomStream;

/// One number, or two between which a press's value is drawn evenly.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(untagged, expecting = "expected a number or [from, to]")]
pub enum Range {
    /// Always the same.
    Fixed(f64),
    /// Drawn between the two.
    Between([f64; 2]),
}

impl Default for Range {
    fn default() -> Self {
        Self::Fixed(0.0)
    }
}

impl Range {
    pub(crate) fn ends(&self) -> [f64; 2] {
        match *self {
            Self::Fixed(value) => [value, value],
            Self::Between(ends) => ends,
        }
    }

    pub(crate) fn draw(&self, random: &mut RandomStream) -> f64 {
        let [low, high] = self.ends();
        low + (high - low) * random.random::<f64>()
    }

    /// What is wrong with it if nothing may be less than `least`: the problem and a hint.
    pub(crate) fn problem(&self, least: f64) -> Option<(String, String)> {
        let [low, high] = self.ends();
        if low > high {
            return Some((
                format!("runs from {low} to {high}"),
                "give the smaller number first".to_owned(),
            ));
        }
        (low < least).then(|| (format!("is {low}"), format!("give {least} or more")))
    }
}
