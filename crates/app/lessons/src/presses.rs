//! Presses solved by finite elements. Each is kept in a file, so that a training that was killed
//! continues.

use rayon::prelude::*;
use serde::Serialize;
use twintac_fast::Lesson;
use twintac_store::{Keyed, Recipe, Store};
use twintac_teach::{Strange, Teacher};
use twintac_work::{At, Progress, Work, WorkError};

/// The purpose of a press.
#[derive(Clone, Copy, Debug, Serialize)]
#[serde(rename_all = "kebab-case")]
pub(super) enum PressKind {
    Lesson,
    OwnLesson,
    Exam,
    OwnExam,
    Slide,
    Strange(Strange),
}

impl PressKind {
    /// The name in progress reports and file names.
    fn name(self) -> String {
        match self {
            Self::Lesson | Self::OwnLesson => "lessons".to_owned(),
            Self::Exam | Self::OwnExam => "exams".to_owned(),
            Self::Slide => "slides".to_owned(),
            Self::Strange(strange) => format!("strange/{}", strange.name()),
        }
    }
}

/// The presses that a `Teacher` draws, and where they are kept.
pub(super) struct Solved<'a> {
    /// It follows from the sensor's description.
    pub(super) teacher: &'a Keyed<Teacher>,
    pub(super) seed: u64,
    pub(super) store: &'a Store,
    pub(super) progress: &'a dyn Progress,
}

/// One press: drawn from its seed and number, and solved.
#[derive(Serialize)]
struct SolvedPress<'a> {
    teacher: &'a Keyed<Teacher>,
    kind: PressKind,
    seed: u64,
    number: u64,
}

impl Recipe for SolvedPress<'_> {
    type Value = Lesson;
    type Error = WorkError;

    fn label(&self) -> String {
        format!("{}-{:06}", self.kind.name(), self.number)
    }

    fn make(&self) -> Result<Lesson, WorkError> {
        let Self {
            teacher,
            seed,
            number,
            ..
        } = *self;
        let press = match self.kind {
            PressKind::Lesson => teacher.lesson(seed, number),
            PressKind::OwnLesson => teacher.own_lesson(seed, number),
            PressKind::Exam => teacher.exam(seed, number),
            PressKind::OwnExam => teacher.own_exam(seed, number),
            PressKind::Slide => teacher.slide(seed, number),
            PressKind::Strange(strange) => teacher.strange(strange, seed, number),
        };
        press.at(|| format!("{}, press {number}", self.kind.name()))
    }
}

impl Solved<'_> {
    /// The first `n` presses of a kind, from their files or solved now.
    pub(super) fn presses(&self, kind: PressKind, n: u64) -> Result<Vec<Lesson>, WorkError> {
        let work = Work::start(self.progress, &kind.name(), n as usize);
        let presses = (0..n as usize).into_par_iter().with_max_len(1).map(|number| {
            work.go_on()?;
            let kept = self.store.get(&SolvedPress {
                teacher: self.teacher,
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
