//! The presses that shapes are told by: of the bench, and of the twins.

use std::path::Path;

use digitac::{Model, simulated_recording};
use twintac_protocol::{PressPlan, Protocol};

use super::experiments::Paper;
use super::level::Level;
use super::mixture::Simulated;
use crate::built_in::{SHAPES_PROTOCOL, reality};
use crate::depth_tables::DepthTableStore;
use crate::model::gel_of;
use crate::progress::Work;
use crate::{Planned, Run, RunError};

/// The simulated presses are drawn with another seed than the real ones.
const SIMULATED_SEED: u64 = 1_000_000;

impl Paper {
    /// The presses of the bench that shapes are told by.
    pub(super) fn trials(&self) -> Result<Run, RunError> {
        let planned = self.shapes(2 * self.effort.real_trials(), self.seed)?;
        let source = format!("{} trials on the emulated bench", planned.presses.len());
        let run = self.run("trials", &source)?;
        run.emulate(&reality(Some(Path::new(self.effort.reality())))?, &planned)?;
        Ok(run)
    }

    fn shapes(&self, n_trials: u32, seed: u64) -> Result<Planned, RunError> {
        let protocol = Protocol::parse(SHAPES_PROTOCOL.name, SHAPES_PROTOCOL.text)?;
        Planned::of(&protocol.with_random_places(n_trials), &self.sensor.sensor, seed)
    }

    /// Presses that the twins of a run would feel.
    pub(super) fn simulated(&self, data: &Run, level: &Level) -> Result<(), RunError> {
        let planned = self.shapes(self.effort.simulated_trials(), self.seed + SIMULATED_SEED)?;
        let felt: Vec<PressPlan> = planned.presses.iter().map(|plan| level.plan(plan)).collect();
        let models = [
            (Simulated::Twin, data.model_folder()),
            (Simulated::PaperTwin, data.paper_twin_folder()),
        ];
        let mut inputs = self.inputs().settings("plans", &felt)?;
        for (_, folder) in &models {
            inputs = inputs
                .file(&folder.join("weights.safetensors"))?
                .file(&folder.join("twin.json"))?;
        }
        self.run_stage("simulated", inputs, |folder| {
            let _work = Work::start(self.progress(), "simulating trials", 0);
            for (simulated, model_folder) in &models {
                let model = Model::load(model_folder)?;
                let gel = gel_of(&model, model_folder)?;
                let store = DepthTableStore::new(&gel, folder.join("depth_tables"), self.progress());
                let rate_hz = gel.sensor().readout.rate_hz;
                let bench = &model.record.bench;
                let mut recording = simulated_recording(&model.twin, bench, &store, &felt, rate_hz)?;
                recording.sensor.clone_from(&gel.sensor().name);
                recording.write_parquet(&folder.join(simulated.name()).with_extension("parquet"))?;
            }
            Ok(())
        })
    }
}
