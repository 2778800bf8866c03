//! A fast twin, from a sensor's description alone: presses of the solved gel to learn from, training, and presses to be judged on.

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

/// One lesson of so many is not taught but judged on, and one of so many where lessons are few: how
/// far off the gel is where few lessons pressed is known from them.
const ONE_HELD_OUT_OF: usize = 20;
const ONE_HELD_OUT_OF_FEW: usize = 5;

/// Fewer lessons than that are few.
const FEW_LESSONS: usize = 500;

/// Held out is what has edges at most so much longer than the shortest of all.
const HELD_OUT_LONGER: f64 = 1.2;

/// How much is learned from.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct FastSettings {
    /// Presses of shapes that are taught.
    pub n_lessons: u64,
    /// Presses of shapes that are not.
    pub n_exams: u64,
    /// Presses of such shapes that slide and tilt.
    pub n_slides: u64,
    /// Presses of each kind that is unlike all that is taught.
    pub n_strange: u64,
    /// Whether presses are those of the sensor's own indenters, upright and near its ports: for the twin of a bench.
    pub own_indenters: bool,
    /// How the networks are trained.
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

/// What became of it.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct FastResult {
    /// The sensor.
    pub sensor: String,
    /// Where the numbers come from: both gels are simulated.
    pub provenance: Provenance,
    /// Whether all presses are those of the sensor's own indenters.
    pub own_indenters: bool,
    /// Presses that were taught.
    pub n_taught: usize,
    /// Errors against the solved gel on presses like those that were taught.
    pub held_out: Judgement,
    /// Errors against the solved gel on exams, pressed straight down: of shapes that no lesson has, or with the sensor's own indenters.
    pub exams: Judgement,
    /// The same where shapes that no lesson has slide and tilt; no frames for a sensor's own indenters.
    pub slides: Judgement,
    /// Whether contacts unlike all that was taught are told; nothing where the sensor's own indenters were pressed.
    pub strange: Option<Told>,
}

/// Teaches and judges a fast twin in a folder. Presses that are there already are not solved again.
///
/// # Errors
/// A folder in which another process works, a gel that can't be pressed, files that cannot be written.
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
        // On a coarse mesh the solved gel reads too little: nobody is judged by it.
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
