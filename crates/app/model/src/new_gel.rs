//! Another gel's recorded presses, simulated for a twin that was not trained on them.

use std::collections::BTreeSet;
use std::path::Path;

use digitac::{
    Adapted, BenchEstimate, Estimate, Evaluation, Model, NewSensor, Places, Twin, Variant, adapt,
    choose_presses,
};
use twintac_depth_table::DepthTable;
use twintac_recording::Recording;
use twintac_sensor::SensorFile;
use twintac_store::Owner;
use twintac_tables::DepthTableStore;
use twintac_work::{Caller, WorkError};

use crate::gel::{gel_like, gel_of};
use crate::taxels::{left_out, ports_mm};
use crate::unseen::{Pressed, refuse_known, refuse_other_sensor, simulate};

/// Ratio of the smallest expected stiffness to the fitted one. Presses of prescribed force are
/// simulated deep enough for it.
const SOFTEST: f64 = 0.7;

/// Another gel's recorded presses, simulated for a twin that was not trained on them.
pub struct NewGel<'a> {
    recording: &'a Recording,
    twin: &'a Twin,
    /// The fitted bench of the training, with the port positions of this gel's sensor.
    bench: BenchEstimate,
    /// Indices of the excluded taxels (`doubtful` in the description).
    pub left_out: BTreeSet<usize>,
    places: Places,
    tables: Vec<DepthTable>,
    /// Keeps other processes out of the folder.
    _owner: Owner,
}

impl<'a> NewGel<'a> {
    /// Simulates the locations of a recording. Tables over depth are kept in `depth_tables` of the
    /// folder `out`. `sensor` describes the gel if it differs from the model's description.
    ///
    /// # Errors
    /// The paper's network, which has no gains; recordings of another sensor, or of presses that
    /// the model was trained on; a folder in which another process works; a location that cannot be
    /// pressed.
    pub fn open(
        (model, model_folder): (&'a Model, &Path),
        sensor: Option<&SensorFile>,
        recording: &'a Recording,
        out: &Path,
        caller: &Caller,
    ) -> Result<Self, WorkError> {
        let record = &model.record;
        if record.variant == Variant::Paper {
            return Err(WorkError::Input(format!(
                "{}: the paper's network has no gains to adapt; give the model of another variant",
                model_folder.display()
            )));
        }
        let gel = match sensor {
            Some(sensor) => gel_like(model, model_folder, sensor)?,
            None => gel_of(model, model_folder)?,
        };
        refuse_other_sensor(recording, gel.sensor())?;
        refuse_known(recording, record)?;
        let bench = record.bench.clone().with_ports_at(&ports_mm(gel.sensor()));
        let softer = BenchEstimate {
            stiffness: Some(Estimate {
                value: SOFTEST * bench.stiffness(),
                uncertainty: 0.0,
            }),
            ..bench.clone()
        };
        let (left_out, progress) = (left_out(gel.sensor()), &*caller.progress);
        // No folder is made for inputs that are refused.
        let owner = Owner::of(out)?;
        let store = DepthTableStore::of(gel, progress)?.kept_in(&out.join("depth_tables"), &caller.program);
        let (places, tables) = simulate(&store, recording, &softer, progress)?;
        Ok(Self {
            recording,
            twin: &model.twin,
            bench,
            left_out,
            places,
            tables,
            _owner: owner,
        })
    }

    /// Chooses presses to adapt with, as indices.
    ///
    /// # Errors
    /// Fewer candidates than presses.
    pub fn choose(&self, candidates: &[usize], n_presses: usize, seed: u64) -> Result<Vec<usize>, WorkError> {
        Ok(choose_presses(&self.sensor(), candidates, n_presses, seed)?)
    }

    /// The twin and its bench, adapted with these presses.
    ///
    /// # Errors
    /// Presses that do not touch the gel.
    pub fn adapt(&self, used: &[usize]) -> Result<Adapted, WorkError> {
        Ok(adapt(&self.sensor(), used)?)
    }

    fn sensor(&self) -> NewSensor<'_> {
        NewSensor {
            recording: self.recording,
            places: &self.places,
            tables: &self.tables,
            twin: self.twin,
            bench: &self.bench,
            left_out: &self.left_out,
        }
    }

    /// The errors of an adapted twin on these presses.
    ///
    /// # Errors
    /// Presses of which no frame is scored.
    pub fn evaluate(&self, adapted: &Adapted, scored: &[usize]) -> Result<Evaluation, WorkError> {
        self.evaluate_on(&adapted.twin, &adapted.bench, scored)
    }

    /// The errors of the original twin on these presses.
    ///
    /// # Errors
    /// Those of [`evaluate`](Self::evaluate).
    pub fn evaluate_as_learned(&self, scored: &[usize]) -> Result<Evaluation, WorkError> {
        self.evaluate_on(self.twin, &self.bench, scored)
    }

    fn evaluate_on(
        &self,
        twin: &Twin,
        bench: &BenchEstimate,
        scored: &[usize],
    ) -> Result<Evaluation, WorkError> {
        let pressed = Pressed {
            recording: self.recording,
            places: &self.places,
            tables: &self.tables,
            left_out: &self.left_out,
        };
        Ok(pressed.evaluate(twin, bench, scored)?.0)
    }
}
