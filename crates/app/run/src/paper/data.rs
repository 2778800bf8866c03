//! The paper's data at its size, and the twins of them.

use std::path::Path;

use super::experiments::Paper;
use super::level::Level;
use crate::built_in::reality;
use crate::{Planned, Run, RunError, SensorFile};

impl Paper {
    /// The paper's presses, as the bench records them.
    pub(super) fn presses(&self) -> Result<Run, RunError> {
        let protocol = self.effort.data();
        let planned = Planned::parse(protocol.name, protocol.text, &self.sensor.sensor, self.seed)?;
        let run = self.run(
            "presses",
            &format!("{} presses on the emulated bench", planned.presses.len()),
        )?;
        run.emulate(&reality(Some(Path::new(self.effort.reality())))?, &planned)?;
        Ok(run)
    }

    /// Twins of the presses, on the gel of a sensor that lies so.
    pub(super) fn data(&self, presses: &Run, sensor: SensorFile, level: &Level) -> Result<Run, RunError> {
        let run = self.run_with(sensor, "data", &presses.record().source)?;
        run.take(presses, level, |recording| level.recording(recording))?;
        run.finish()?;
        run.train_paper_twin()?;
        Ok(run)
    }
}
