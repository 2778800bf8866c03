//! A part of a data set.

use std::fmt::{Display, Formatter};
use std::ops::Range;
use std::str::FromStr;

use twintac_work::WorkError;

/// One of several parts of a data set, counted from 1: `3/64`.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct Shard {
    number: u32,
    of: u32,
}

impl Shard {
    /// Shard `number` of `of`.
    ///
    /// # Errors
    /// A number that is not from 1 to `of`.
    pub fn new(number: u32, of: u32) -> Result<Self, WorkError> {
        if (1..=of).contains(&number) {
            return Ok(Self { number, of });
        }
        Err(WorkError::Input(format!(
            "there is no shard {number}/{of}: the first of {of} shards is 1/{of}, the last {of}/{of}"
        )))
    }

    /// Its number, from 1.
    #[must_use]
    pub fn number(self) -> u32 {
        self.number
    }

    /// The number of shards.
    #[must_use]
    pub fn of(self) -> u32 {
        self.of
    }

    /// The range of its presses among all presses of the data set.
    pub(super) fn stretch(self, n_presses: usize) -> Result<Range<usize>, WorkError> {
        let of = self.of as usize;
        if of > n_presses {
            return Err(WorkError::Input(format!(
                "{n_presses} presses cannot be divided into {of} shards: give at most {n_presses} shards"
            )));
        }
        let edge = |number: u32| (number as u128 * n_presses as u128 / u128::from(self.of)) as usize;
        Ok(edge(self.number - 1)..edge(self.number))
    }

    /// The name of its files without extension.
    pub(super) fn stem(self) -> String {
        format!("shard-{:06}-of-{:06}", self.number, self.of)
    }

    /// The shard with a manifest of this file name.
    pub(super) fn of_manifest(name: &str) -> Option<Self> {
        let (number, of) = name
            .strip_prefix("shard-")?
            .strip_suffix(".json")?
            .split_once("-of-")?;
        Self::new(number.parse().ok()?, of.parse().ok()?).ok()
    }
}

impl FromStr for Shard {
    type Err = WorkError;

    fn from_str(text: &str) -> Result<Self, WorkError> {
        let parts = text.split_once('/');
        match parts.map(|(number, of)| (number.parse(), of.parse())) {
            Some((Ok(number), Ok(of))) => Self::new(number, of),
            _ => Err(WorkError::Input(format!(
                "`{text}` is not a shard: give its number and how many there are, such as 3/64"
            ))),
        }
    }
}

impl Display for Shard {
    fn fmt(&self, f: &mut Formatter<'_>) -> std::fmt::Result {
        write!(f, "{}/{}", self.number, self.of)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn shards_cover_all_presses_once() {
        for (n_presses, of) in [(10, 1), (10, 3), (10, 10), (1_000_003, 64)] {
            let mut end = 0;
            for number in 1..=of {
                let stretch = Shard::new(number, of).unwrap().stretch(n_presses).unwrap();
                assert_eq!(stretch.start, end);
                assert!(stretch.len().abs_diff(n_presses / of as usize) <= 1);
                end = stretch.end;
            }
            assert_eq!(end, n_presses);
        }
    }

    #[test]
    fn what_is_no_shard_is_refused() {
        for (text, expected) in [
            ("0/4", "the first of 4 shards is 1/4"),
            ("5/4", "the last 4/4"),
            ("3", "3/64"),
            ("a/b", "`a/b` is not a shard"),
        ] {
            let error = text.parse::<Shard>().unwrap_err().to_string();
            assert!(error.contains(expected), "{error}");
        }
        let shard: Shard = "3/64".parse().unwrap();
        assert_eq!((shard.number(), shard.of()), (3, 64));
        assert!(shard.stretch(63).is_err());
        let manifest = format!("{}.json", shard.stem());
        assert_eq!(Shard::of_manifest(&manifest), Some(shard));
        assert_eq!(Shard::of_manifest("shard-000000-of-000004.json"), None);
    }
}
