//! The folder of the experiments, and what they share.

use std::path::{Path, PathBuf};

use twintac_run::Run;
use twintac_sensor::SensorFile;
use twintac_store::{Finished, Owner, Stage, Stages};
use twintac_work::{At, Caller, Progress, WorkError};

use crate::effort::Effort;

/// The command that makes all stages.
pub(super) const PAPER_COMMAND: &str = "twintac reproduce --paper";

/// The paper's experiments in a folder. What exists there is not made again.
#[derive(Clone, Debug)]
pub struct Paper {
    pub(super) folder: PathBuf,
    pub(super) effort: Effort,
    pub(super) seed: u64,
    pub(super) sensor: SensorFile,
    pub(super) caller: Caller,
    owner: Owner,
}

impl Paper {
    /// Starts the experiments, or continues those of a folder.
    ///
    /// # Errors
    /// The folder cannot be written, or another process works in it.
    pub fn start(folder: &Path, effort: Effort, seed: u64, caller: Caller) -> Result<Self, WorkError> {
        Ok(Self {
            owner: Owner::of(folder)?,
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

    /// A run with the described sensor.
    pub(super) fn run(&self, name: &str, source: &str) -> Result<Run, WorkError> {
        self.run_with(self.sensor.clone(), name, source)
    }

    /// A run whose simulated gel follows another description. The bench's gel does not depend on
    /// it.
    pub(super) fn run_with(&self, sensor: SensorFile, name: &str, source: &str) -> Result<Run, WorkError> {
        let settings = self.effort.run_settings();
        let (folder, caller) = (self.folder.join(name), self.caller.clone());
        Run::start(&folder, sensor, source, self.seed, settings, caller)
    }

    pub(super) fn progress(&self) -> &dyn Progress {
        &*self.caller.progress
    }

    pub(super) fn run_stage<S>(&self, stage: &S) -> Result<Finished, WorkError>
    where
        S: Stage<Follower = dyn Progress, Error = WorkError>,
    {
        let _turn = self.owner.turn();
        let stages = Stages {
            root: &self.folder,
            program: &self.caller.program,
        };
        let made = stages.run(stage, &*self.caller.progress);
        let (outcome, finished) = made.at(|| format!("stage `{}`", S::NAME))?;
        self.progress().stage(S::NAME, outcome);
        Ok(finished)
    }
}
