//! Trains and evaluates a surrogate from a sensor's description alone.

use std::path::Path;

use serde::{Deserialize, Serialize};
use twintac_fast::{FastGel, Judgement, TrainSettings, lesson_places_mm};
use twintac_plot::png;
use twintac_recording::Provenance;
use twintac_sensor::SensorFile;
use twintac_store::{Keyed, Owner, Store, write_file, write_json};
use twintac_tables::FAST_GEL;
use twintac_teach::{TeachError, Teacher, exam_surfaces};
use twintac_work::{Caller, Work, WorkError};

use crate::presses::{PressKind, Solved};
use crate::strange::{Told, strange_presses};

/// One training press of this many is held out for evaluation (the second number if there are few):
/// the errors on them show how good the surrogate is where few presses trained it.
const ONE_HELD_OUT_OF: usize = 20;
const ONE_HELD_OUT_OF_FEW: usize = 5;

/// Fewer training presses than this are few.
const FEW_LESSONS: usize = 500;

/// A press can be held out if its mesh's edges are at most this many times as long as the shortest
/// of all.
const HELD_OUT_LONGER: f64 = 1.2;

/// Numbers of presses, and settings of the training.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct FastSettings {
    /// Training presses.
    pub n_lessons: u64,
    /// Test presses, straight down, of shapes that no training press has.
    pub n_exams: u64,
    /// Test presses of such shapes that slide and tilt.
    pub n_slides: u64,
    /// Out-of-distribution test presses of each kind.
    pub n_strange: u64,
    /// Whether all presses use the sensor's own indenters, upright and near its ports: for the twin
    /// of a bench.
    pub own_indenters: bool,
    /// Settings of the networks' training.
    pub train: TrainSettings,
}

impl Default for FastSettings {
    fn default() -> Self {
        Self {
            n_lessons: 2000,
            n_exams: 100,
            n_slides: 40,
            n_strange: 24,
            own_indenters: false,
            train: TrainSettings::default(),
        }
    }
}

/// The result of a training: `judgement.json`.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct FastResult {
    /// The sensor's name.
    pub sensor: String,
    /// Always `simulated`: the surrogate and the FEM solution that it is compared with.
    pub provenance: Provenance,
    /// Whether all presses use the sensor's own indenters.
    pub own_indenters: bool,
    /// Number of presses that the surrogate was trained on.
    pub n_taught: usize,
    /// Errors against the FEM solution on held-out presses like those of training.
    pub held_out: Judgement,
    /// Errors against the FEM solution on test presses straight down: of shapes that no training
    /// press has, or of the sensor's own indenters.
    pub exams: Judgement,
    /// Errors on test presses that slide and tilt; no frames if all presses use the sensor's own
    /// indenters.
    pub slides: Judgement,
    /// Evaluation of the OOD score; `None` if all presses use the sensor's own indenters.
    pub strange: Option<Told>,
}

/// Trains and evaluates a surrogate in a folder. Presses that are in the folder already are not
/// solved again.
///
/// # Errors
/// A folder in which another process works; a gel that cannot be pressed; files that cannot be
/// written.
pub fn train_fast(
    sensor: &SensorFile,
    folder: &Path,
    settings: &FastSettings,
    seed: u64,
    caller: &Caller,
) -> Result<FastResult, WorkError> {
    let _owner = Owner::of(folder)?;
    let progress = &*caller.progress;
    let places_mm = lesson_places_mm(&sensor.sensor);
    let teacher = Teacher::new(&sensor.sensor, &places_mm)?;
    let teacher = Keyed::from_inputs(teacher, &*sensor.sensor)?;
    let solved = Solved {
        teacher: &teacher,
        seed,
        store: &Store::new(&folder.join("presses"), &caller.program),
        progress,
    };
    let is_own = settings.own_indenters;
    let exam = if is_own {
        PressKind::OwnExam
    } else {
        PressKind::Exam
    };
    let exams = solved.presses(exam, settings.n_exams)?;
    let n_slides = if is_own { 0 } else { settings.n_slides };
    let slides = solved.presses(PressKind::Slide, n_slides)?;
    let n_strange = if is_own { 0 } else { settings.n_strange };
    let strange = strange_presses(&solved, n_strange)?;
    let lesson = if is_own {
        PressKind::OwnLesson
    } else {
        PressKind::Lesson
    };
    let lessons = solved.presses(lesson, settings.n_lessons)?;
    let (mut taught, mut held_out) = (Vec::new(), Vec::new());
    let edges_mm = lessons.iter().map(|lesson| lesson.edge_mm);
    let one_held_out_of = match lessons.len() < FEW_LESSONS {
        true => ONE_HELD_OUT_OF_FEW,
        false => ONE_HELD_OUT_OF,
    };
    let longest_held_out_mm = HELD_OUT_LONGER * edges_mm.fold(f64::INFINITY, f64::min);
    for (number, lesson) in lessons.into_iter().enumerate() {
        // On a coarse mesh the FEM solution reads too little, so such presses are not used for
        // evaluation.
        let is_held_out = number % one_held_out_of == 0 && lesson.edge_mm < longest_held_out_mm;
        if is_held_out { &mut held_out } else { &mut taught }.push(lesson);
    }
    let n_reports = settings.train.n_steps / twintac_fast::REPORT_STEPS;
    let work = Work::start(progress, "training", n_reports);
    let lessons = (&taught[..], &held_out[..]);
    let gel = FastGel::train(&sensor.sensor, lessons, &settings.train, seed, &mut |state| {
        let [pressure, wrench] = [state.pressure, state.wrench].map(|error| 100.0 * error);
        work.step(&format!("pressure {pressure:.2} %, force {wrench:.2} %"));
    })?;
    drop(work);
    write_file(&folder.join(FAST_GEL), &gel.to_bytes()?)?;
    let mut surfaces = exam_surfaces().map_err(TeachError::from)?;
    surfaces.extend(sensor.sensor.surfaces.clone());
    let result = FastResult {
        strange: (n_strange > 0)
            .then(|| Told::of(&gel, &held_out, &strange))
            .transpose()?,
        sensor: sensor.sensor.name.clone(),
        provenance: Provenance::Simulated,
        own_indenters: is_own,
        n_taught: taught.len(),
        held_out: gel.judge(&held_out, &surfaces)?,
        exams: gel.judge(&exams, &surfaces)?,
        slides: gel.judge(&slides, &surfaces)?,
    };
    write_json(&folder.join("judgement.json"), &result)?;
    write_file(&folder.join("judgement.png"), &png(&result.plot().scene(), 2.0)?)?;
    Ok(result)
}
