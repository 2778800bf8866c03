//! The division of presses into training, validation and test presses.
//!
//! Whole presses are held out, by location: presses that repeat a location are never in two parts.
//! The locations are ordered, and one is drawn at random from each run of a few, so that the
//! held-out locations lie between training locations and cover the whole gel. The outermost
//! locations of each indenter are used for training (unless the number of training locations is
//! limited), so that a twin is not tested on extrapolation.

use std::collections::{BTreeMap, BTreeSet};

use rand::Rng;
use rand::seq::SliceRandom;
use serde::{Deserialize, Serialize};
use twintac_config::{Checked, Problem, Ranges};
use twintac_recording::{Control, Press, Recording};

use crate::bench_fit::{deepest_pose, n_places};
use crate::{DigitacError, seed};

/// Side of the square in which presses belong together, mm.
const BLOCK_MM: f64 = 0.1;
/// The same for dense grids, whose neighbours are too similar.
const DENSE_BLOCK_MM: f64 = 3.0;
/// Static presses form a dense grid from this number of locations on.
const DENSE_FROM: usize = 150;

/// Settings of the division of presses.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct SplitSettings {
    /// Presses whose locations are in the same square of this side belong together, mm. Dense grids
    /// need several of their steps. Default: 0.1; 3 from 150 locations on, if each press is one
    /// frame under a prescribed force.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub block_mm: Option<f64>,
    /// One of this many locations is held out for testing.
    pub test_one_in: usize,
    /// One of this many of the remaining locations is held out for validation.
    pub validation_one_in: usize,
    /// Largest number of locations for training and validation, drawn at random; presses at the
    /// others are not used. Default: all that are not held out for testing.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[serde(alias = "teaching_places")]
    pub training_places: Option<usize>,
    /// Installations (mountings) of an indenter that are held out for testing as a whole. If there
    /// are any, no locations are held out for testing.
    #[serde(alias = "test_files")]
    pub test_mountings: BTreeSet<String>,
}

impl Default for SplitSettings {
    fn default() -> Self {
        Self {
            block_mm: None,
            test_one_in: 4,
            validation_one_in: 5,
            training_places: None,
            test_mountings: BTreeSet::new(),
        }
    }
}

impl Checked for SplitSettings {
    fn check(&self, ranges: &mut Ranges) {
        let Self {
            block_mm,
            test_one_in,
            validation_one_in,
            training_places,
            test_mountings: _,
        } = self;
        if let Some(block_mm) = block_mm {
            ranges.number("block_mm", *block_mm, 0.01..=100.0);
        }
        ranges.number("test_one_in", *test_one_in, 2.0..=1000.0);
        ranges.number("validation_one_in", *validation_one_in, 2.0..=1000.0);
        if let Some(training_places) = training_places {
            ranges.number("training_places", *training_places, 2.0..=1e6);
        }
    }
}

impl SplitSettings {
    /// Side of the square in which presses of a recording belong together, mm.
    ///
    /// # Errors
    /// A press without frames.
    pub fn block_mm_of(&self, recording: &Recording) -> Result<f64, DigitacError> {
        if let Some(block_mm) = self.block_mm {
            return Ok(block_mm);
        }
        let is_static = |press: &Press| press.control == Control::Force && press.time_s.len() == 1;
        let is_dense = recording.presses.iter().all(is_static) && n_places(recording)? >= DENSE_FROM;
        Ok(if is_dense { DENSE_BLOCK_MM } else { BLOCK_MM })
    }

    /// An error if an installation that is to be held out does not exist.
    fn check_mountings(&self, recording: &Recording) -> Result<(), DigitacError> {
        let there: BTreeSet<&String> = recording.presses.iter().map(|press| &press.mounting).collect();
        let Some(unknown) = self.test_mountings.iter().find(|name| !there.contains(name)) else {
            return Ok(());
        };
        let names: Vec<&str> = there.iter().map(|name| name.as_str()).collect();
        let hint = match &names[..] {
            [] => "there are no presses".to_owned(),
            names => format!("there are `{}`", names.join("`, `")),
        };
        let problem = format!("names `{unknown}`, which has no presses");
        Err(Problem::new("test_mountings", problem, hint).into())
    }
}

/// Indices of presses, each list in order. Together they are all presses, unless the number of
/// training locations is limited.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Split {
    /// Presses that the twin is fitted to.
    pub train: Vec<usize>,
    /// Presses that stop the training and choose the variant.
    pub validation: Vec<usize>,
    /// Presses that nothing is fitted to.
    pub test: Vec<usize>,
}

type Place<'a> = (&'a str, i64, i64);

impl Split {
    /// Divides the presses of a recording by location. The outermost locations of each file are
    /// used for training (unless [`SplitSettings::training_places`] limits their number): a twin is
    /// tested between the locations that it was trained on. `seed` draws the others.
    ///
    /// # Errors
    /// Settings outside their ranges; installations to hold out that do not exist; a press without
    /// frames; too few locations.
    pub fn new(recording: &Recording, settings: &SplitSettings, seed: u64) -> Result<Self, DigitacError> {
        let presses = &recording.presses;
        settings.checked()?;
        settings.check_mountings(recording)?;
        let of_mountings = |press: &Press| settings.test_mountings.contains(&press.mounting);
        let test: BTreeSet<usize> = (0..presses.len())
            .filter(|index| of_mountings(&presses[*index]))
            .collect();
        let drawn = test.is_empty();
        Self::around(recording, test, drawn, settings, seed)
    }

    /// Divides the presses other than the test presses. If these are not given, they are drawn by
    /// location.
    pub(crate) fn around(
        recording: &Recording,
        test: BTreeSet<usize>,
        is_drawn: bool,
        settings: &SplitSettings,
        seed_number: u64,
    ) -> Result<Self, DigitacError> {
        let presses = &recording.presses;
        let block_mm = settings.block_mm_of(recording)?;
        let mut groups: BTreeMap<Place<'_>, Vec<usize>> = BTreeMap::new();
        for (index, press) in presses.iter().enumerate() {
            if !test.contains(&index) {
                groups.entry(place(press, block_mm)?).or_default().push(index);
            }
        }
        let n_places = groups.len();
        let mut in_file: BTreeMap<&str, Vec<Place<'_>>> = BTreeMap::new();
        for press in presses {
            in_file
                .entry(&press.mounting)
                .or_default()
                .push(place(press, block_mm)?);
        }
        let outermost: BTreeSet<Place<'_>> = in_file.values().flat_map(|places| outermost(places)).collect();
        let (outer, inner): (Vec<_>, Vec<_>) = groups
            .into_iter()
            .partition(|(place, _)| outermost.contains(place));
        let mut inner: Vec<Vec<usize>> = inner.into_iter().map(|(_, presses)| presses).collect();
        let mut split = Self {
            train: Vec::new(),
            validation: Vec::new(),
            test: test.into_iter().collect(),
        };
        if is_drawn {
            split.test = draw(&mut inner, settings.test_one_in, seed_number, "test");
        }
        let mut outer: Vec<Vec<usize>> = outer.into_iter().map(|(_, presses)| presses).collect();
        if let Some(n_training) = settings.training_places {
            inner.append(&mut outer);
            inner.shuffle(&mut seed::stream(seed_number, "split/teaching"));
            inner.truncate(n_training);
        }
        split.validation = draw(&mut inner, settings.validation_one_in, seed_number, "validation");
        split.train = inner.into_iter().chain(outer).flatten().collect();
        for part in [&mut split.train, &mut split.validation, &mut split.test] {
            part.sort_unstable();
        }
        if split.train.is_empty() || split.validation.is_empty() || split.test.is_empty() {
            return Err(DigitacError::TooFew {
                expected: "inner locations to train, to validate and to test with".into(),
                found: format!("{} presses at {n_places} locations", presses.len()),
            });
        }
        Ok(split)
    }
}

fn place(press: &Press, block_mm: f64) -> Result<Place<'_>, DigitacError> {
    let [x, y] = deepest_pose(press)?
        .position_mm
        .truncate()
        .to_array()
        .map(|mm| (mm / block_mm).round() as i64);
    Ok((&press.indenter, y, x))
}

/// Locations with the smallest or largest x or y of their indenter in one file, along axes on which
/// it was moved.
fn outermost<'a>(places: &[Place<'a>]) -> BTreeSet<Place<'a>> {
    let mut limits: BTreeMap<&str, [i64; 4]> = BTreeMap::new();
    for &(indenter, y, x) in places {
        let [low_x, high_x, low_y, high_y] = limits.entry(indenter).or_insert([x, x, y, y]);
        (*low_x, *high_x, *low_y, *high_y) = (
            (*low_x).min(x),
            (*high_x).max(x),
            (*low_y).min(y),
            (*high_y).max(y),
        );
    }
    places
        .iter()
        .copied()
        .filter(|(indenter, y, x)| {
            let [low_x, high_x, low_y, high_y] = limits[indenter];
            (low_x < high_x && (*x == low_x || *x == high_x))
                || (low_y < high_y && (*y == low_y || *y == high_y))
        })
        .collect()
}

/// Takes one group at random out of each run of `one_in`, and returns its presses. A last, shorter
/// run also gives one if it is at least half as long.
fn draw(groups: &mut Vec<Vec<usize>>, one_in: usize, seed_number: u64, name: &str) -> Vec<usize> {
    let mut random = seed::stream(seed_number, &format!("split/{name}"));
    let mut drawn = BTreeSet::new();
    for start in (0..groups.len()).step_by(one_in) {
        let length = one_in.min(groups.len() - start);
        if 2 * length >= one_in {
            drawn.insert(start + random.random_range(0..length));
        }
    }
    let (mut taken, mut left) = (Vec::new(), Vec::new());
    for (index, group) in std::mem::take(groups).into_iter().enumerate() {
        if drawn.contains(&index) {
            taken.extend(group)
        } else {
            left.push(group)
        }
    }
    *groups = left;
    taken
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::synthetic::Truth;
    use proptest::prelude::*;

    fn line(n_places: usize, repeats: usize) -> Recording {
        let mut recording = Truth {
            offsets_mm: vec![0.0; repeats],
            ..Truth::new()
        }
        .recording(n_places);
        recording
            .presses
            .iter_mut()
            .for_each(|press| press.mounting = "file".into());
        recording
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(64))]
        #[test]
        fn every_press_is_somewhere_and_repeats_stay_together(n_places in 7_usize..60, repeats in 1_usize..4, seed in 0_u64..99) {
            let recording = line(n_places, repeats);
            let split = Split::new(&recording, &SplitSettings::default(), seed).unwrap();
            let mut all = [&split.train[..], &split.validation, &split.test].concat();
            all.sort_unstable();
            prop_assert_eq!(all, (0..recording.presses.len()).collect::<Vec<_>>());
            let places = |part: &[usize]| part.iter().map(|i| i % n_places).collect::<BTreeSet<_>>();
            let (train, validation, test) = (places(&split.train), places(&split.validation), places(&split.test));
            prop_assert!(train.is_disjoint(&test) && train.is_disjoint(&validation) && validation.is_disjoint(&test));
            prop_assert!(train.contains(&0) && train.contains(&(n_places - 1)));
            prop_assert!(test.len() * 6 >= n_places - 2 && test.len() * 3 <= n_places + 2);
        }
    }

    #[test]
    fn files_can_be_held_out_as_a_whole() {
        let mut recording = line(12, 2);
        recording.presses[12..]
            .iter_mut()
            .for_each(|press| press.mounting = "other".into());
        let test_mountings = BTreeSet::from(["other".to_owned()]);
        let split = Split::new(
            &recording,
            &SplitSettings {
                test_mountings,
                ..SplitSettings::default()
            },
            1,
        )
        .unwrap();
        assert_eq!(split.test, (12..24).collect::<Vec<_>>());
    }

    #[test]
    fn a_few_places_can_be_trained_on() {
        let settings = SplitSettings {
            training_places: Some(6),
            ..SplitSettings::default()
        };
        let (all, few) = (SplitSettings::default(), settings);
        let recording = line(24, 1);
        let (all, few) = (
            Split::new(&recording, &all, 1).unwrap(),
            Split::new(&recording, &few, 1).unwrap(),
        );
        assert_eq!(all.test, few.test);
        assert_eq!(few.train.len() + few.validation.len(), 6);
        assert!(!few.validation.is_empty());
    }

    #[test]
    fn too_few_places_are_an_error() {
        assert!(Split::new(&line(3, 5), &SplitSettings::default(), 1).is_err());
        assert!(Split::new(&line(3, 0), &SplitSettings::default(), 1).is_err());
    }

    #[test]
    fn a_mounting_that_is_not_there_cannot_be_held_out() {
        let settings = SplitSettings {
            test_mountings: BTreeSet::from(["file".to_owned(), "nosuchfile.csv".to_owned()]),
            ..SplitSettings::default()
        };
        let error = Split::new(&line(12, 1), &settings, 1).unwrap_err().to_string();
        let expected =
            "setting `test_mountings` names `nosuchfile.csv`, which has no presses; there are `file`";
        assert_eq!(error, expected);
    }

    #[test]
    fn presses_of_a_dense_grid_belong_together_in_larger_squares_unless_settings_say_otherwise() {
        let mut recording = line(DENSE_FROM, 1);
        let block_mm = |recording: &Recording, block_mm| {
            let settings = SplitSettings {
                block_mm,
                ..SplitSettings::default()
            };
            settings.block_mm_of(recording).unwrap()
        };
        assert_eq!(block_mm(&recording, None), BLOCK_MM);
        for press in &mut recording.presses {
            press.control = Control::Force;
            press.time_s.truncate(1);
        }
        assert_eq!(block_mm(&recording, None), DENSE_BLOCK_MM);
        assert_eq!(block_mm(&recording, Some(0.5)), 0.5);
        recording.presses.pop();
        assert_eq!(block_mm(&recording, None), BLOCK_MM);
    }
}
