//! The paper's data at its size, and the twins of them.

use std::path::Path;

use super::experiments::Paper;
use crate::built_in::reality;
use crate::{Planned, Run, RunError};

impl Paper {
    /// The paper's data, and the twins of them.
    pub(super) fn data(&self) -> Result<Run, RunError> {
        let (protocol, sensor) = (self.effort.data(), &self.sensor.sensor);
        let planned = Planned::parse(protocol.name, protocol.text, sensor, self.seed)?;
        let source = format!("{} presses on the emulated bench", planned.presses.len());
        let run = self.run("data", &source)?;
        run.emulate(&reality(Some(Path::new(self.effort.reality())))?, &planned)?;
        run.finish()?;
        run.train_paper_twin()?;
        Ok(run)
    }
}
