//! The paper's data in its full size, and the twins trained on them.

use twintac_run::{Metrics, Run};
use twintac_sensor::SensorFile;
use twintac_store::Finished;
use twintac_work::{Planned, WorkError};

use crate::experiments::Paper;
use crate::level::Level;

impl Paper {
    /// The paper's presses, as the bench records them.
    pub(super) fn presses(&self) -> Result<Run, WorkError> {
        let protocol = self.effort.data();
        let planned = Planned::parse(protocol.name, protocol.text, &self.sensor.sensor, self.seed)?;
        let run = self.run(
            "presses",
            &format!("{} presses on the emulated bench", planned.presses.len()),
        )?;
        run.emulate(&self.effort.emulator()?, &planned)?;
        Ok(run)
    }

    /// Trains twins on the presses, in the frame of the levelled gel. Returns the run, the metrics
    /// of this project's twin, and the stage of the paper's network.
    pub(super) fn data(
        &self,
        presses: &Run,
        sensor: SensorFile,
        level: &Level,
    ) -> Result<(Run, Metrics, Finished), WorkError> {
        let run = self.run_with(sensor, "data", &presses.record().source)?;
        run.take(presses, level)?;
        let metrics = run.finish()?;
        let paper_twin = run.train_paper_twin()?;
        Ok((run, metrics, paper_twin))
    }
}
