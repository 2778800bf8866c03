//! What a rung of the verification ladder is, and what it comes to.

mod outcome;
pub(crate) mod plots;

use anyhow::Result;

pub(crate) use outcome::{Figure, Outcome, Plot, number};

/// A rung.
pub(crate) struct Rung {
    pub(crate) number: u8,
    pub(crate) name: &'static str,
    pub(crate) title: &'static str,
    pub(crate) run: fn(Effort) -> Result<Outcome>,
}

/// How much work a rung may be.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Effort {
    /// Minutes.
    Quick,
    /// As much as it takes.
    Full,
}

impl Effort {
    /// One or the other.
    pub(crate) fn choose<T>(self, quick: T, full: T) -> T {
        match self {
            Self::Quick => quick,
            Self::Full => full,
        }
    }
}
