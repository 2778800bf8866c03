//! A run: a folder in which a sensor's recordings become a judged twin.

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use serde::{Deserialize, Serialize};
use twintac_config::Checked;
use twintac_recording::Recording;
use twintac_simulate::Gel;

use crate::cache::{self, Inputs};
use crate::doubtful::left_out;
use crate::error::At;
use crate::fast::FAST_GEL;
use crate::fast::tables::FastTables;
use crate::files::{read_json, write_file, write_json};
use crate::progress::go_on;
use crate::{Caller, Metrics, Progress, RunError, RunSettings, SensorFile};

/// What a run is made from: `run.json`.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct RunRecord {
    /// The sensor's name.
    pub sensor: String,
    /// Where the presses come from, in words.
    pub source: String,
    /// Seed of all that chance decides.
    pub seed: u64,
    /// Settings of every stage.
    pub settings: RunSettings,
}

/// An open run. Its stages are methods, in the order in which they are called: one that brings recordings ([`import`](Self::import),
/// [`emulate`](Self::emulate) or [`collect`](Self::collect)), then [`mesh`](Self::mesh), [`simulate`](Self::simulate), [`pair`](Self::pair),
/// [`train`](Self::train), [`evaluate`](Self::evaluate), [`report`](Self::report).
///
/// A stage that is asked for again with the same inputs by the same [`Caller::program`] is not run again. A stage that was killed goes on
/// with what it had finished.
#[derive(Clone, Debug)]
pub struct Run {
    pub(crate) folder: PathBuf,
    pub(crate) record: RunRecord,
    pub(crate) sensor: SensorFile,
    pub(crate) caller: Caller,
}

impl Run {
    /// Starts a run, or takes up the one that the folder holds with new settings: stages that they do not touch are kept. `source` says
    /// in words where the presses come from.
    ///
    /// # Errors
    /// The folder cannot be written; a setting that makes no sense.
    pub fn start(
        folder: &Path,
        sensor: impl Into<SensorFile>,
        source: &str,
        seed: u64,
        settings: RunSettings,
        caller: Caller,
    ) -> Result<Self, RunError> {
        settings.checked()?;
        std::fs::create_dir_all(folder).map_err(RunError::file("creating", folder))?;
        let sensor = sensor.into();
        let record = RunRecord {
            sensor: sensor.sensor.name.clone(),
            source: source.to_owned(),
            seed,
            settings,
        };
        for (name, path) in sensor.surfaces() {
            let bytes = std::fs::read(&path).map_err(RunError::file("reading", &path))?;
            write_file(&folder.join(name), &bytes)?;
        }
        if let Some(path) = &record.settings.fast_gel {
            FastTables::read(path, &sensor.sensor)?;
            let bytes = std::fs::read(path).map_err(RunError::file("reading", path))?;
            write_file(&folder.join(FAST_GEL), &bytes)?;
        }
        write_file(&folder.join("sensor.toml"), sensor.text.as_bytes())?;
        write_json(&folder.join("run.json"), &record)?;
        Ok(Self {
            folder: folder.to_owned(),
            record,
            sensor,
            caller,
        })
    }

    /// Opens a run that was started.
    ///
    /// # Errors
    /// [`RunError::NotARun`]; a sensor description that cannot be read.
    pub fn open(folder: &Path, caller: Caller) -> Result<Self, RunError> {
        let record: RunRecord = read_json(&folder.join("run.json")).map_err(|source| RunError::NotARun {
            folder: folder.to_owned(),
            source: Box::new(source),
        })?;
        let path = folder.join("run.json");
        record.settings.checked().at(|| path.display().to_string())?;
        let sensor = SensorFile::read(&folder.join("sensor.toml"))?;
        Ok(Self {
            folder: folder.to_owned(),
            record,
            sensor,
            caller,
        })
    }

    /// The same run, whose work another follows.
    #[must_use]
    pub fn followed_by(mut self, progress: Arc<dyn Progress>) -> Self {
        self.caller.progress = progress;
        self
    }

    /// Runs all stages after the recordings, and says how well the twin did.
    ///
    /// # Errors
    /// Those of the stages.
    pub fn finish(&self) -> Result<Metrics, RunError> {
        self.mesh()?;
        self.simulate()?;
        self.pair()?;
        self.train()?;
        let metrics = self.evaluate()?;
        self.report()?;
        Ok(metrics)
    }

    /// The run's folder.
    #[must_use]
    pub fn folder(&self) -> &Path {
        &self.folder
    }

    /// What the run is made from.
    #[must_use]
    pub fn record(&self) -> &RunRecord {
        &self.record
    }

    /// The sensor whose twin is made.
    #[must_use]
    pub fn sensor(&self) -> &SensorFile {
        &self.sensor
    }

    /// The folder of the twin of all presses: what [`digitac::Model::load`] reads.
    #[must_use]
    pub fn model_folder(&self) -> PathBuf {
        self.folder.join("model")
    }

    /// The page that [`report`](Self::report) writes.
    #[must_use]
    pub fn report_path(&self) -> PathBuf {
        self.folder.join("report.html")
    }

    /// The folder of the logs of a bench.
    #[must_use]
    pub fn logs_folder(&self) -> PathBuf {
        self.folder.join("logs")
    }

    /// The presses, as recorded.
    ///
    /// # Errors
    /// There are none yet, or they cannot be read.
    pub fn recording(&self) -> Result<Recording, RunError> {
        let path = self.stage("recordings").join("presses.parquet");
        Ok(Recording::read_parquet(&path)?)
    }

    /// The folder of a stage.
    pub(crate) fn stage(&self, name: &str) -> PathBuf {
        self.folder.join(name)
    }

    /// The gel as the twin simulates it.
    pub(crate) fn gel(&self) -> Gel {
        Gel::new(
            Arc::clone(&self.sensor.sensor),
            self.record.settings.simulate.clone(),
        )
    }

    /// The fast gel whose tables the run uses, if it does.
    pub(crate) fn fast(&self) -> Result<Option<FastTables>, RunError> {
        let is_asked_for = self.record.settings.fast_gel.is_some();
        let read = || FastTables::read(&self.folder.join(FAST_GEL), &self.sensor.sensor);
        is_asked_for.then(read).transpose()
    }

    pub(crate) fn progress(&self) -> &dyn Progress {
        &*self.caller.progress
    }

    /// Taxels whose readings are not to be trusted, by index: left out of headline figures.
    pub(crate) fn left_out(&self) -> BTreeSet<usize> {
        left_out(&self.sensor.sensor)
    }

    /// What every stage depends on.
    pub(crate) fn inputs(&self) -> Inputs {
        Inputs::new(&self.caller.program)
    }

    /// Runs a stage unless it is there, and says so.
    pub(crate) fn run_stage(
        &self,
        name: &str,
        inputs: Inputs,
        work: impl FnOnce(&Path) -> Result<(), RunError>,
    ) -> Result<(), RunError> {
        go_on(self.progress())?;
        let outcome = cache::run(&self.stage(name), inputs, work).at(|| format!("stage `{name}`"))?;
        self.progress().stage(name, outcome);
        Ok(())
    }
}
