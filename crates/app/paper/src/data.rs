//! The paper's data at its size, and the twins of them.

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
        run.emulate(&self.effort.reality()?, &planned)?;
        Ok(run)
    }

    /// Twins of the presses, on the gel of a sensor that lies so; how well the first of them does, and the paper's.
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
