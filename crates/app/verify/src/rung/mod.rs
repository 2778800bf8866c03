//! A verification test ("rung"), and its outcome.

mod outcome;
pub(crate) mod plots;

use anyhow::Result;

pub(crate) use outcome::{Figure, Outcome, Plot, number};

/// A verification test.
pub(crate) struct Rung {
    pub(crate) number: u8,
    pub(crate) name: &'static str,
    pub(crate) title: &'static str,
    pub(crate) run: fn(Effort) -> Result<Outcome>,
}

/// The extent of the tests.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Effort {
    /// Minutes.
    Quick,
    /// As long as needed.
    Full,
}

impl Effort {
    /// The first or the second value.
    pub(crate) fn choose<T>(self, quick: T, full: T) -> T {
        match self {
            Self::Quick => quick,
            Self::Full => full,
        }
    }
}
