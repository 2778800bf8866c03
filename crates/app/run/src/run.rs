//! A run: a folder in which a sensor's recordings become a trained and evaluated twin.

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use serde::{Deserialize, Serialize};
use twintac_config::Checked;
use twintac_model::left_out;
use twintac_sensor::SensorFile;
use twintac_simulate::Gel;
use twintac_store::{Finished, Keyed, Owner, Stage, Stages, read_json, write_file, write_json};
use twintac_tables::{FAST_GEL, FastTables};
use twintac_work::{At, Caller, Progress, WorkError, go_on};

use crate::{Metrics, RunSettings};

/// Name of the sensor's description in a run's folder.
pub(crate) const SENSOR: &str = "sensor.toml";

/// Name of the folder of a bench's logs.
pub(crate) const LOGS: &str = "logs";

/// The inputs of a run: `run.json`.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct RunRecord {
    /// The sensor's name.
    pub sensor: String,
    /// Where the presses come from, in words.
    pub source: String,
    /// Seed of all random choices.
    pub seed: u64,
    /// Settings of every stage.
    pub settings: RunSettings,
}

/// An open run. Its stages are methods, in the order in which they are called: one that brings
/// recordings ([`import`](Self::import), [`emulate`](Self::emulate) or [`collect`](Self::collect)),
/// then [`mesh`](Self::mesh), [`simulate`](Self::simulate), [`pair`](Self::pair),
/// [`train`](Self::train), [`evaluate`](Self::evaluate), [`report`](Self::report).
///
/// A stage that is requested again with the same inputs by the same [`Caller::program`] is not run
/// again. A stage that was killed continues with what it had finished. A stage reads earlier ones
/// only if they match their present inputs; otherwise it fails, and the error names the difference.
///
/// While a run is open, no other process can open it.
#[derive(Clone, Debug)]
pub struct Run {
    folder: PathBuf,
    record: RunRecord,
    /// The settings of the record without the path of the surrogate, because the folder has a copy
    /// of its file.
    settings: RunSettings,
    /// The same, with default values for the settings that the simulation does not use.
    simulation_settings: RunSettings,
    sensor: Arc<Keyed<SensorFile>>,
    fast: Option<Arc<Keyed<FastTables>>>,
    caller: Caller,
    owner: Owner,
}

impl Run {
    /// Starts a run, or continues the one in the folder with new settings: stages that do not
    /// depend on the changed settings are kept. `source` says in words where the presses come from.
    /// The surface files of the sensor and the surrogate of the settings are copied into the
    /// folder.
    ///
    /// # Errors
    /// A setting that is not allowed; a folder that cannot be written, or in which another process
    /// works; a surrogate of another sensor.
    pub fn start(
        folder: &Path,
        sensor: impl Into<SensorFile>,
        source: &str,
        seed: u64,
        settings: RunSettings,
        caller: Caller,
    ) -> Result<Self, WorkError> {
        settings.checked()?;
        let owner = Owner::of(folder)?;
        let path = folder.join(SENSOR);
        let sensor = sensor.into().kept_as(&path)?;
        let fast = match &settings.fast_gel {
            Some(from) => {
                let (fast, bytes) = FastTables::read(from, &sensor.sensor)?;
                write_file(&folder.join(FAST_GEL), &bytes)?;
                Some(Arc::new(fast))
            }
            None => None,
        };
        for (name, bytes) in sensor.surfaces() {
            write_file(&folder.join(name), bytes)?;
        }
        write_file(&path, sensor.text.as_bytes())?;
        let record = RunRecord {
            sensor: sensor.sensor.name.clone(),
            source: source.to_owned(),
            seed,
            settings,
        };
        write_json(&folder.join("run.json"), &record)?;
        Ok(Self {
            folder: folder.to_owned(),
            settings: without_path(&record.settings),
            simulation_settings: of_simulation(&record.settings),
            record,
            sensor: Arc::new(keyed(sensor)),
            fast,
            caller,
            owner,
        })
    }

    /// Opens an existing run.
    ///
    /// # Errors
    /// [`WorkError::NotARun`]; a folder in which another process works; a sensor's description or a
    /// surrogate that cannot be read.
    pub fn open(folder: &Path, caller: Caller) -> Result<Self, WorkError> {
        let record: RunRecord = read_json(&folder.join("run.json")).map_err(|source| WorkError::NotARun {
            folder: folder.to_owned(),
            source: Box::new(source.into()),
        })?;
        let path = folder.join("run.json");
        record.settings.checked().at(|| path.display().to_string())?;
        let owner = Owner::of(folder)?;
        let sensor = SensorFile::read(&folder.join(SENSOR))?;
        let fast = match &record.settings.fast_gel {
            Some(_) => Some(Arc::new(
                FastTables::read(&folder.join(FAST_GEL), &sensor.sensor)?.0,
            )),
            None => None,
        };
        Ok(Self {
            folder: folder.to_owned(),
            settings: without_path(&record.settings),
            simulation_settings: of_simulation(&record.settings),
            record,
            sensor: Arc::new(keyed(sensor)),
            fast,
            caller,
            owner,
        })
    }

    /// The same run with another receiver of progress.
    #[must_use]
    pub fn followed_by(mut self, progress: Arc<dyn Progress>) -> Self {
        self.caller.progress = progress;
        self
    }

    /// Runs all stages after the recordings, and returns the errors of the twin.
    ///
    /// # Errors
    /// Those of the stages.
    pub fn finish(&self) -> Result<Metrics, WorkError> {
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

    /// The inputs of the run.
    #[must_use]
    pub fn record(&self) -> &RunRecord {
        &self.record
    }

    /// The run's sensor.
    #[must_use]
    pub fn sensor(&self) -> &SensorFile {
        &self.sensor
    }

    /// Settings as an input of stages.
    pub(crate) fn settings(&self) -> &RunSettings {
        &self.settings
    }

    /// Settings as an input of the simulation.
    pub(crate) fn simulation_settings(&self) -> &RunSettings {
        &self.simulation_settings
    }

    /// The sensor as an input of stages.
    pub(crate) fn keyed_sensor(&self) -> &Keyed<SensorFile> {
        &self.sensor
    }

    /// The folder of the twin that was trained on all presses. [`digitac::Model::load`] reads it.
    #[must_use]
    pub fn model_folder(&self) -> PathBuf {
        self.folder.join("model")
    }

    /// The page that [`report`](Self::report) writes.
    #[must_use]
    pub fn report_path(&self) -> PathBuf {
        self.folder.join("report.html")
    }

    /// The folder of a bench's logs.
    #[must_use]
    pub fn logs_folder(&self) -> PathBuf {
        self.folder.join(LOGS)
    }

    /// The simulated gel of the run.
    pub(crate) fn gel(&self) -> Gel {
        gel_of(&self.sensor, &self.record.settings)
    }

    /// The surrogate that makes the run's tables, if the settings name one.
    pub(crate) fn fast(&self) -> Option<&Keyed<FastTables>> {
        self.fast.as_deref()
    }

    pub(crate) fn caller(&self) -> &Caller {
        &self.caller
    }

    pub(crate) fn progress(&self) -> &dyn Progress {
        &*self.caller.progress
    }

    /// Indices of the excluded taxels (`doubtful` in the description): they do not count in
    /// headline figures.
    pub(crate) fn left_out(&self) -> BTreeSet<usize> {
        left_out(&self.sensor.sensor)
    }

    pub(crate) fn stages(&self) -> Stages<'_> {
        Stages {
            root: &self.folder,
            program: &self.caller.program,
        }
    }

    /// Runs a stage unless it is complete, and reports the outcome.
    pub(crate) fn run_stage<S>(&self, stage: &S) -> Result<Finished, WorkError>
    where
        S: Stage<Follower = dyn Progress, Error = WorkError>,
    {
        go_on(self.progress())?;
        let _turn = self.owner.turn();
        let made = self.stages().run(stage, &*self.caller.progress);
        let (outcome, finished) = made.at(|| format!("stage `{}`", S::NAME))?;
        self.progress().stage(S::NAME, outcome);
        Ok(finished)
    }
}

/// A sensor file with a key. Its text identifies it, because the text names surfaces by their
/// contents.
pub(crate) fn keyed(sensor: SensorFile) -> Keyed<SensorFile> {
    let text = sensor.text.clone();
    Keyed::of_bytes(sensor, text.as_bytes())
}

fn without_path(settings: &RunSettings) -> RunSettings {
    RunSettings {
        fast_gel: None,
        ..settings.clone()
    }
}

fn of_simulation(settings: &RunSettings) -> RunSettings {
    let RunSettings { pair, train, .. } = RunSettings::default();
    RunSettings {
        pair,
        train,
        ..without_path(settings)
    }
}

/// A sensor's gel with the settings of its simulation.
pub(crate) fn gel_of(sensor: &SensorFile, settings: &RunSettings) -> Gel {
    Gel::new(Arc::clone(&sensor.sensor), settings.simulate.clone())
}
