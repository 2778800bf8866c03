//! The folder of the experiments, and what each of them works with.

use std::path::{Path, PathBuf};

use super::effort::Effort;
use crate::cache::{self, Inputs};
use crate::error::At;
use crate::{Caller, Progress, Run, RunError, SensorFile};

/// The paper's experiments, in a folder. What is there is not made again.
#[derive(Clone, Debug)]
pub struct Paper {
    pub(super) folder: PathBuf,
    pub(super) effort: Effort,
    pub(super) seed: u64,
    pub(super) sensor: SensorFile,
    pub(super) caller: Caller,
}

impl Paper {
    /// Starts, or takes up what a folder holds.
    ///
    /// # Errors
    /// The folder cannot be written.
    pub fn start(folder: &Path, effort: Effort, seed: u64, caller: Caller) -> Result<Self, RunError> {
        std::fs::create_dir_all(folder).map_err(RunError::file("creating", folder))?;
        Ok(Self {
            folder: folder.to_owned(),
            effort,
            seed,
            sensor: SensorFile::phystac()?,
            caller,
        })
    }

    /// The page that [`finish`](Self::finish) writes.
    #[must_use]
    pub fn report_path(&self) -> PathBuf {
        self.folder.join("report.html")
    }

    /// A run with the sensor as it is described.
    pub(super) fn run(&self, name: &str, source: &str) -> Result<Run, RunError> {
        self.run_with(self.sensor.clone(), name, source)
    }

    /// A run whose gel is simulated as another description says. The bench's gel is its own.
    pub(super) fn run_with(&self, sensor: SensorFile, name: &str, source: &str) -> Result<Run, RunError> {
        let settings = self.effort.run_settings();
        let (folder, caller) = (self.folder.join(name), self.caller.clone());
        Run::start(&folder, sensor, source, self.seed, settings, caller)
    }

    pub(super) fn progress(&self) -> &dyn Progress {
        &*self.caller.progress
    }

    pub(super) fn inputs(&self) -> Inputs {
        Inputs::new(&self.caller.program)
    }

    pub(super) fn run_stage(
        &self,
        name: &str,
        inputs: Inputs,
        work: impl FnOnce(&Path) -> Result<(), RunError>,
    ) -> Result<(), RunError> {
        let outcome = cache::run(&self.folder.join(name), inputs, work).at(|| format!("stage `{name}`"))?;
        self.progress().stage(name, outcome);
        Ok(())
    }
}
