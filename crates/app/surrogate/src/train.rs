//! Trains and evaluates a surrogate from a sensor's description alone.

use std::path::Path;

use serde::{Deserialize, Serialize};
use twintac_fast::{Evaluation, FastGel, TrainSettings, training_places_mm};
use twintac_fem_presses::{FemPressError, FemPresses, test_surfaces};
use twintac_plot::png;
use twintac_recording::Provenance;
use twintac_sensor::SensorFile;
use twintac_store::{Keyed, Owner, Store, write_file, write_json};
use twintac_tables::FAST_GEL;
use twintac_work::{Caller, Work, WorkError};

use crate::out_of_distribution::{OodEvaluation, ood_presses};
use crate::presses::{PressKind, Solved};

/// One training press of this many is held out for evaluation (the second number if there are few):
/// the errors on them show how good the surrogate is where few presses trained it.
const ONE_HELD_OUT_OF: usize = 20;
const ONE_HELD_OUT_OF_FEW: usize = 5;

/// Fewer training presses than this are few.
const FEW_PRESSES: usize = 500;

/// A press can be held out if its mesh's edges are at most this many times as long as the shortest
/// of all.
const HELD_OUT_LONGER: f64 = 1.2;

/// Numbers of presses, and settings of the training.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct FastSettings {
    /// Training presses.
    pub n_training_presses: u64,
    /// Test presses, straight down, of shapes that no training press has.
    pub n_test_presses: u64,
    /// Test presses of such shapes that slide and tilt.
    pub n_slides: u64,
    /// Out-of-distribution test presses of each kind.
    pub n_ood: u64,
    /// Whether all presses use the sensor's own indenters, upright and near its ports: for the twin
    /// of a bench.
    pub own_indenters: bool,
    /// Settings of the networks' training.
    pub train: TrainSettings,
}

impl Default for FastSettings {
    fn default() -> Self {
        Self {
            n_training_presses: 2000,
            n_test_presses: 100,
            n_slides: 40,
            n_ood: 24,
            own_indenters: false,
            train: TrainSettings::default(),
        }
    }
}

/// The result of a training: `evaluation.json`.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct FastResult {
    /// The sensor's name.
    pub sensor: String,
    /// Always `simulated`: the surrogate and the FEM solution that it is compared with.
    pub provenance: Provenance,
    /// Whether all presses use the sensor's own indenters.
    pub own_indenters: bool,
    /// Number of presses that the surrogate was trained on.
    #[serde(alias = "n_taught")]
    pub n_trained_on: usize,
    /// Errors against the FEM solution on held-out presses like those of training.
    pub held_out: Evaluation,
    /// Errors against the FEM solution on test presses straight down: of shapes that no training
    /// press has, or of the sensor's own indenters.
    #[serde(alias = "exams")]
    pub test_presses: Evaluation,
    /// Errors on test presses that slide and tilt; no frames if all presses use the sensor's own
    /// indenters.
    pub slides: Evaluation,
    /// Evaluation of the OOD score; `None` if all presses use the sensor's own indenters.
    #[serde(alias = "strange")]
    pub out_of_distribution: Option<OodEvaluation>,
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
    let places_mm = training_places_mm(&sensor.sensor);
    let fem_presses = FemPresses::new(&sensor.sensor, &places_mm)?;
    let fem_presses = Keyed::from_inputs(fem_presses, &*sensor.sensor)?;
    let solved = Solved {
        fem_presses: &fem_presses,
        seed,
        store: &Store::new(&folder.join("presses"), &caller.program),
        progress,
    };
    let is_own = settings.own_indenters;
    let test = if is_own {
        PressKind::OwnTest
    } else {
        PressKind::Test
    };
    let test_presses = solved.presses(test, settings.n_test_presses)?;
    let n_slides = if is_own { 0 } else { settings.n_slides };
    let slides = solved.presses(PressKind::Slide, n_slides)?;
    let n_ood = if is_own { 0 } else { settings.n_ood };
    let ood = ood_presses(&solved, n_ood)?;
    let training = if is_own {
        PressKind::OwnTraining
    } else {
        PressKind::Training
    };
    let presses = solved.presses(training, settings.n_training_presses)?;
    let (mut trained_on, mut held_out) = (Vec::new(), Vec::new());
    let edges_mm = presses.iter().map(|press| press.edge_mm);
    let one_held_out_of = match presses.len() < FEW_PRESSES {
        true => ONE_HELD_OUT_OF_FEW,
        false => ONE_HELD_OUT_OF,
    };
    let longest_held_out_mm = HELD_OUT_LONGER * edges_mm.fold(f64::INFINITY, f64::min);
    for (number, press) in presses.into_iter().enumerate() {
        // On a coarse mesh the FEM solution reads too little, so such presses are not used for
        // evaluation.
        let is_held_out = number % one_held_out_of == 0 && press.edge_mm < longest_held_out_mm;
        if is_held_out {
            &mut held_out
        } else {
            &mut trained_on
        }
        .push(press);
    }
    let n_reports = settings.train.n_steps / twintac_fast::REPORT_STEPS;
    let work = Work::start(progress, "training", n_reports);
    let presses = (&trained_on[..], &held_out[..]);
    let gel = FastGel::train(&sensor.sensor, presses, &settings.train, seed, &mut |state| {
        let [pressure, wrench] = [state.pressure, state.wrench].map(|error| 100.0 * error);
        work.step(&format!("pressure {pressure:.2} %, force {wrench:.2} %"));
    })?;
    drop(work);
    write_file(&folder.join(FAST_GEL), &gel.to_bytes()?)?;
    let mut surfaces = test_surfaces().map_err(FemPressError::from)?;
    surfaces.extend(sensor.sensor.surfaces.clone());
    let result = FastResult {
        out_of_distribution: (n_ood > 0)
            .then(|| OodEvaluation::of(&gel, &held_out, &ood))
            .transpose()?,
        sensor: sensor.sensor.name.clone(),
        provenance: Provenance::Simulated,
        own_indenters: is_own,
        n_trained_on: trained_on.len(),
        held_out: gel.evaluate(&held_out, &surfaces)?,
        test_presses: gel.evaluate(&test_presses, &surfaces)?,
        slides: gel.evaluate(&slides, &surfaces)?,
    };
    write_json(&folder.join("evaluation.json"), &result)?;
    write_file(&folder.join("evaluation.png"), &png(&result.plot().scene(), 2.0)?)?;
    Ok(result)
}
