//! A run: a folder in which a sensor's recordings become a judged twin.

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

/// The sensor's description in a run's folder.
pub(crate) const SENSOR: &str = "sensor.toml";

/// The folder of the logs of a bench.
pub(crate) const LOGS: &str = "logs";

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
/// with what it had finished. A stage reads earlier ones only if they are as they would be made now: otherwise it is refused, and the error says what
/// differs.
///
/// As long as a run is open, no other process can open it.
#[derive(Clone, Debug)]
pub struct Run {
    folder: PathBuf,
    record: RunRecord,
    /// Those of the record, without the path of the fast gel, which the folder has a copy of.
    settings: RunSettings,
    /// The same with the default of what comes after the simulation.
    simulation_settings: RunSettings,
    sensor: Arc<Keyed<SensorFile>>,
    fast: Option<Arc<Keyed<FastTables>>>,
    caller: Caller,
    owner: Owner,
}

impl Run {
    /// Starts a run, or takes up the one that the folder holds with new settings: stages that they do not touch are kept. `source` says
    /// in words where the presses come from. The surfaces of the sensor are copied into the folder, and the fast gel of the settings.
    ///
    /// # Errors
    /// A setting that makes no sense; a folder that cannot be written, or in which another process works; a fast gel of another sensor.
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

    /// Opens a run that was started.
    ///
    /// # Errors
    /// [`WorkError::NotARun`]; a folder in which another process works; a sensor description or a fast gel that cannot be read.
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
        self.folder.join(LOGS)
    }

    /// The gel as the twin simulates it.
    pub(crate) fn gel(&self) -> Gel {
        gel_of(&self.sensor, &self.record.settings)
    }

    /// The fast gel whose tables the run uses, if it does.
    pub(crate) fn fast(&self) -> Option<&Keyed<FastTables>> {
        self.fast.as_deref()
    }

    pub(crate) fn caller(&self) -> &Caller {
        &self.caller
    }

    pub(crate) fn progress(&self) -> &dyn Progress {
        &*self.caller.progress
    }

    /// Taxels whose readings are not to be trusted, by index: left out of headline figures.
    pub(crate) fn left_out(&self) -> BTreeSet<usize> {
        left_out(&self.sensor.sensor)
    }

    pub(crate) fn stages(&self) -> Stages<'_> {
        Stages {
            root: &self.folder,
            program: &self.caller.program,
        }
    }

    /// Runs a stage unless it is there, and says so.
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

/// The text of a description tells it from every other once its surfaces are called after their contents.
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

/// A sensor's gel as settings have it simulated.
pub(crate) fn gel_of(sensor: &SensorFile, settings: &RunSettings) -> Gel {
    Gel::new(Arc::clone(&sensor.sensor), settings.simulate.clone())
}
