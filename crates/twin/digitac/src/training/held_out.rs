//! Ways to hold presses out for the evaluation of a twin.

use std::collections::{BTreeMap, BTreeSet};

use rand::seq::SliceRandom;
use serde::{Deserialize, Serialize};
use twintac_config::Checked;
use twintac_recording::{Press, Recording};

use super::{Split, SplitSettings};
use crate::bench_fit::deepest_pose;
use crate::{DigitacError, seed};

/// Presses belong to the deepest fifth also if they are within this of it in depth, mm; commanded
/// depths differ by less.
const SAME_DEPTH_MM: f64 = 0.05;

/// What is held out together.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum HeldOut {
    /// Single presses, drawn at random. Other presses at the same location may be training presses.
    Press,
    /// All presses of a location that lies between training locations.
    Place,
    /// All presses of a file, one file after the other.
    File,
    /// All presses of an indenter, one indenter after the other.
    Indenter,
    /// The deepest fifth of the presses of each indenter.
    Depth,
    /// The outermost third along the longer side of the pressed region, one end after the other.
    Region,
    /// All readings of a taxel, one taxel after the other; its gain comes from one press.
    Taxel,
}

impl HeldOut {
    /// All ways.
    pub const ALL: [Self; 7] = [
        Self::Press,
        Self::Place,
        Self::File,
        Self::Indenter,
        Self::Depth,
        Self::Region,
        Self::Taxel,
    ];

    /// The name used in files and on the command line.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Press => "press",
            Self::Place => "place",
            Self::File => "file",
            Self::Indenter => "indenter",
            Self::Depth => "depth",
            Self::Region => "region",
            Self::Taxel => "taxel",
        }
    }
}

impl std::fmt::Display for HeldOut {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(self.name())
    }
}

impl std::str::FromStr for HeldOut {
    type Err = String;

    fn from_str(name: &str) -> Result<Self, String> {
        let names = || Self::ALL.map(Self::name).join(", ");
        Self::ALL
            .into_iter()
            .find(|kind| kind.name() == name)
            .ok_or_else(|| format!("cannot hold out by `{name}`; there are: {}", names()))
    }
}

/// One division of presses, with what it holds out.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Fold {
    /// What is held out together.
    pub by: HeldOut,
    /// The held-out file, indenter, end or taxel; empty if presses were drawn.
    pub held_out: String,
    /// The division.
    pub split: Split,
    /// The taxel whose readings are not used for training, if one is held out.
    pub taxel: Option<usize>,
}

impl Fold {
    /// The divisions of a recording for one seed: several if files, indenters, ends or taxels are
    /// held out one after the other. Taxels in `left_out` are not held out.
    ///
    /// # Errors
    /// Too few presses, files or indenters.
    pub fn all(
        recording: &Recording,
        by: HeldOut,
        (settings, seed): (&SplitSettings, u64),
        left_out: &BTreeSet<usize>,
    ) -> Result<Vec<Self>, DigitacError> {
        settings.checked()?;
        let around = |test| Split::around(recording, test, false, settings, seed);
        let fold = |held_out: &str, split: Split| Self {
            by,
            held_out: held_out.to_owned(),
            split,
            taxel: None,
        };
        match by {
            HeldOut::Place => Ok(vec![fold("", Split::new(recording, settings, seed)?)]),
            HeldOut::Press => {
                let test = drawn(recording, settings, seed);
                Ok(vec![fold("", around(test)?)])
            }
            HeldOut::Depth => {
                let test = deepest(recording)?;
                Ok(vec![fold("", around(test)?)])
            }
            HeldOut::Region => {
                let [low, high] = ends(recording)?;
                Ok(vec![
                    fold("low end", around(low)?),
                    fold("high end", around(high)?),
                ])
            }
            HeldOut::File => one_by_one(recording, by, &around, |press| &press.mounting),
            HeldOut::Indenter => one_by_one(recording, by, &around, |press| &press.indenter),
            HeldOut::Taxel => {
                let split = Split::new(recording, settings, seed)?;
                let taxels = recording.taxels.iter().enumerate();
                Ok(taxels
                    .filter(|(taxel, _)| !left_out.contains(taxel))
                    .map(|(taxel, name)| Self {
                        taxel: Some(taxel),
                        ..fold(name, split.clone())
                    })
                    .collect())
            }
        }
    }
}

fn one_by_one(
    recording: &Recording,
    by: HeldOut,
    around: &dyn Fn(BTreeSet<usize>) -> Result<Split, DigitacError>,
    name: impl Fn(&Press) -> &String,
) -> Result<Vec<Fold>, DigitacError> {
    let mut groups: BTreeMap<&str, BTreeSet<usize>> = BTreeMap::new();
    for (index, press) in recording.presses.iter().enumerate() {
        groups.entry(name(press)).or_default().insert(index);
    }
    if groups.len() < 2 {
        return Err(DigitacError::TooFew {
            expected: format!("two groups to hold out by {by}"),
            found: groups.len().to_string(),
        });
    }
    let fold = |(name, test): (&str, BTreeSet<usize>)| {
        Ok(Fold {
            by,
            held_out: name.to_owned(),
            split: around(test)?,
            taxel: None,
        })
    };
    groups.into_iter().map(fold).collect()
}

fn drawn(recording: &Recording, settings: &SplitSettings, seed_number: u64) -> BTreeSet<usize> {
    let mut presses: Vec<usize> = (0..recording.presses.len()).collect();
    presses.shuffle(&mut seed::stream(seed_number, "split/press"));
    presses.truncate(presses.len() / settings.test_one_in);
    presses.into_iter().collect()
}

/// The presses of each indenter that are about as deep as its deepest fifth.
fn deepest(recording: &Recording) -> Result<BTreeSet<usize>, DigitacError> {
    let mut heights: BTreeMap<&str, Vec<(f64, usize)>> = BTreeMap::new();
    for (index, press) in recording.presses.iter().enumerate() {
        let height_mm = deepest_pose(press)?.position_mm.z;
        heights
            .entry(&press.indenter)
            .or_default()
            .push((height_mm, index));
    }
    let mut deepest = BTreeSet::new();
    for mut own in heights.into_values() {
        own.sort_by(|a, b| a.0.total_cmp(&b.0));
        let limit_mm = own[own.len() / 5].0 + SAME_DEPTH_MM;
        deepest.extend(
            own.iter()
                .filter(|(z, _)| *z <= limit_mm)
                .map(|(_, index)| *index),
        );
    }
    Ok(deepest)
}

/// The presses of the outermost third at either end, along the axis with the largest range of
/// locations.
fn ends(recording: &Recording) -> Result<[BTreeSet<usize>; 2], DigitacError> {
    let places: Vec<[f64; 2]> = recording
        .presses
        .iter()
        .map(|press| Ok(deepest_pose(press)?.position_mm.truncate().to_array()))
        .collect::<Result<_, DigitacError>>()?;
    let limits = |axis: usize| {
        let along = || places.iter().map(|place| place[axis]);
        let (low, high) = (
            along().fold(f64::INFINITY, f64::min),
            along().fold(f64::NEG_INFINITY, f64::max),
        );
        (low, high - low)
    };
    let axis = usize::from(limits(1).1 > limits(0).1);
    let (low, range) = limits(axis);
    let share = |press: &usize| (places[*press][axis] - low) / range.max(f64::MIN_POSITIVE);
    let all = 0..places.len();
    Ok([
        all.clone().filter(|press| share(press) < 1.0 / 3.0).collect(),
        all.filter(|press| share(press) > 2.0 / 3.0).collect(),
    ])
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::synthetic::Truth;

    #[test]
    fn folds_hold_out_what_they_say() {
        let recording = Truth::new().recording(12);
        let folds = |by| {
            Fold::all(
                &recording,
                by,
                (&SplitSettings::default(), 1),
                &BTreeSet::from([0]),
            )
            .unwrap()
        };
        for by in [HeldOut::Press, HeldOut::Place] {
            let [fold] = &folds(by)[..] else { panic!("{by}") };
            let n_test = fold.split.test.len();
            assert!(4 * n_test <= recording.presses.len() && 6 * n_test >= recording.presses.len());
        }
        let files = folds(HeldOut::File);
        for fold in &files {
            let of_file = |index: &usize| recording.presses[*index].mounting == fold.held_out;
            assert!(fold.split.test.iter().all(of_file));
            let training_presses = [&fold.split.train[..], &fold.split.validation].concat();
            assert!(!training_presses.iter().any(of_file) && !training_presses.is_empty());
        }
        assert_eq!(
            files.iter().map(|fold| fold.split.test.len()).sum::<usize>(),
            recording.presses.len()
        );
        let taxels: Vec<_> = folds(HeldOut::Taxel).iter().map(|fold| fold.taxel).collect();
        assert_eq!(taxels, (1..recording.taxels.len()).map(Some).collect::<Vec<_>>());
        let all = Fold::all(
            &recording,
            HeldOut::Indenter,
            (&SplitSettings::default(), 1),
            &BTreeSet::new(),
        );
        assert!(all.unwrap_err().to_string().contains("hold out by indenter"));
    }

    #[test]
    fn no_training_press_is_as_deep_as_those_held_out_by_depth() {
        let mut recording = Truth::new().recording(12);
        for (index, press) in recording.presses.iter_mut().enumerate() {
            for pose in &mut press.gel_from_indenter {
                pose.position_mm.z -= 0.2 * (index % 5) as f64;
            }
        }
        let folds = Fold::all(
            &recording,
            HeldOut::Depth,
            (&SplitSettings::default(), 1),
            &BTreeSet::new(),
        )
        .unwrap();
        let split = &folds[0].split;
        let z = |index: &usize| deepest_pose(&recording.presses[*index]).unwrap().position_mm.z;
        let deepest = split.test.iter().map(z).fold(f64::NEG_INFINITY, f64::max);
        let training_presses = split.train.iter().chain(&split.validation).map(z);
        assert!(training_presses.fold(f64::INFINITY, f64::min) > deepest + SAME_DEPTH_MM / 2.0);
    }
}
