//! Presses solved by finite elements. Each is kept in a file, so that a training that was killed
//! continues.

use rayon::prelude::*;
use serde::Serialize;
use twintac_fast::FemPress;
use twintac_fem_presses::{FemPresses, OodKind};
use twintac_store::{Keyed, Recipe, Store};
use twintac_work::{At, Progress, Work, WorkError};

/// The purpose of a press.
#[derive(Clone, Copy, Debug, Serialize)]
#[serde(rename_all = "kebab-case")]
pub(super) enum PressKind {
    Training,
    OwnTraining,
    Test,
    OwnTest,
    Slide,
    OutOfDistribution(OodKind),
}

impl PressKind {
    /// The name in progress reports and file names.
    fn name(self) -> String {
        match self {
            Self::Training | Self::OwnTraining => "training-presses".to_owned(),
            Self::Test | Self::OwnTest => "test-presses".to_owned(),
            Self::Slide => "slides".to_owned(),
            Self::OutOfDistribution(kind) => format!("out-of-distribution/{}", kind.name()),
        }
    }
}

/// The presses that a `FemPresses` draws, and where they are kept.
pub(super) struct Solved<'a> {
    /// It follows from the sensor's description.
    pub(super) fem_presses: &'a Keyed<FemPresses>,
    pub(super) seed: u64,
    pub(super) store: &'a Store,
    pub(super) progress: &'a dyn Progress,
}

/// One press: drawn from its seed and number, and solved.
#[derive(Serialize)]
struct SolvedPress<'a> {
    fem_presses: &'a Keyed<FemPresses>,
    kind: PressKind,
    seed: u64,
    number: u64,
}

impl Recipe for SolvedPress<'_> {
    type Value = FemPress;
    type Error = WorkError;

    fn label(&self) -> String {
        format!("{}-{:06}", self.kind.name(), self.number)
    }

    fn make(&self) -> Result<FemPress, WorkError> {
        let Self {
            fem_presses,
            seed,
            number,
            ..
        } = *self;
        let press = match self.kind {
            PressKind::Training => fem_presses.training_press(seed, number),
            PressKind::OwnTraining => fem_presses.own_training_press(seed, number),
            PressKind::Test => fem_presses.test_press(seed, number),
            PressKind::OwnTest => fem_presses.own_test_press(seed, number),
            PressKind::Slide => fem_presses.slide(seed, number),
            PressKind::OutOfDistribution(kind) => fem_presses.ood_press(kind, seed, number),
        };
        press.at(|| format!("{}, press {number}", self.kind.name()))
    }
}

impl Solved<'_> {
    /// The first `n` presses of a kind, from their files or solved now.
    pub(super) fn presses(&self, kind: PressKind, n: u64) -> Result<Vec<FemPress>, WorkError> {
        let work = Work::start(self.progress, &kind.name(), n as usize);
        let presses = (0..n as usize).into_par_iter().with_max_len(1).map(|number| {
            work.go_on()?;
            let kept = self.store.get(&SolvedPress {
                fem_presses: self.fem_presses,
                kind,
                seed: self.seed,
                number: number as u64,
            })?;
            kept.made_again.iter().for_each(|why| self.progress.note(why));
            work.step("");
            Ok(kept.value)
        });
        presses.collect()
    }
}
