//! The presses from which shapes are classified: on the bench, and of the twins.

use std::path::Path;

use digitac::{Model, simulated_recording};
use serde::Serialize;
use twintac_model::gel_of;
use twintac_protocol::{PressPlan, Protocol};
use twintac_run::built_in::SHAPES_PROTOCOL;
use twintac_run::{COMPLETE, Run};
use twintac_store::{Finished, Stage};
use twintac_tables::DepthTableStore;
use twintac_work::{Planned, Progress, Work, WorkError};

use crate::experiments::{PAPER_COMMAND, Paper};
use crate::level::Level;
use crate::mixture::Simulated;

/// Offset of the seed, so that simulated presses differ from those of the bench.
const SIMULATED_SEED: u64 = 1_000_000;

impl Paper {
    /// The presses of the bench from which shapes are classified.
    pub(super) fn trials(&self) -> Result<Run, WorkError> {
        let planned = self.shapes(2 * self.effort.real_trials(), self.seed)?;
        let source = format!("{} trials on the emulated bench", planned.presses.len());
        let run = self.run("trials", &source)?;
        run.emulate(&self.effort.emulator()?, &planned)?;
        Ok(run)
    }

    fn shapes(&self, n_trials: u32, seed: u64) -> Result<Planned, WorkError> {
        let protocol = Protocol::parse(SHAPES_PROTOCOL.name, SHAPES_PROTOCOL.text)?;
        Planned::of(&protocol.with_random_places(n_trials), &self.sensor.sensor, seed)
    }

    /// The presses that the twins simulate. `paper_twin` is the stage of the paper's network.
    pub(super) fn simulated(
        &self,
        data: &Run,
        paper_twin: Finished,
        level: &Level,
    ) -> Result<Finished, WorkError> {
        let planned = self.shapes(self.effort.simulated_trials(), self.seed + SIMULATED_SEED)?;
        let felt: Vec<PressPlan> = planned.presses.iter().map(|plan| level.plan(plan)).collect();
        self.run_stage(&SimulatedTrials {
            felt: &felt,
            training: data.training()?,
            paper_twin,
        })
    }
}

/// The inputs of the simulated trials.
#[derive(Serialize)]
struct SimulatedTrials<'a> {
    felt: &'a [PressPlan],
    training: Finished,
    paper_twin: Finished,
}

impl Stage for SimulatedTrials<'_> {
    const NAME: &'static str = "simulated";
    const MADE_BY: &'static str = PAPER_COMMAND;
    type Follower = dyn Progress;
    type Error = WorkError;

    fn make(&self, folder: &Path, progress: &dyn Progress) -> Result<(), WorkError> {
        let _work = Work::start(progress, "simulating trials", 0);
        for (simulated, twins) in [
            (Simulated::Twin, &self.training),
            (Simulated::PaperTwin, &self.paper_twin),
        ] {
            let model_folder = twins.file(COMPLETE);
            let model = Model::load(&model_folder)?;
            let gel = gel_of(&model, &model_folder)?;
            let (name, rate_hz) = (gel.sensor().name.clone(), gel.sensor().readout.rate_hz);
            let store = DepthTableStore::of(gel, progress)?.kept_in(&folder.join("depth_tables"), Self::NAME);
            let bench = &model.record.bench;
            let mut recording = simulated_recording(&model.twin, bench, &store, self.felt, rate_hz)?;
            recording.sensor = name;
            recording.write_parquet(&folder.join(simulated.file()))?;
        }
        Ok(())
    }
}
