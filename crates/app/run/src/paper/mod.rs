//! The TwinTac paper's experiments (arXiv 2509.10063) on the emulated bench, from nothing to one page.
//!
//! A folder with a run for each recording, and a stage for each experiment:
//!
//! ```text
//! data/              a run: the paper's data, and twins trained on them
//! trials/            a run: presses of the bench that shapes are told by
//! simulated/         the same as the twins feel them (Parquet)
//! shapes/            classifiers, and which shapes they tell
//! five-shapes/       a run: the presses of the pressure maps
//! maps/              what sensor and twin read of them
//! under-a-ball/      a run: presses that characterize the sensor
//! characterization/  report, data sheet and figures of them
//! report.html, metrics.json
//! ```

mod effort;
mod maps;
mod metrics;
mod page;
mod shapes;

use std::path::{Path, PathBuf};

pub use effort::Effort;
pub use maps::ShapeMap;
pub use metrics::{PaperMetrics, SensorFigures};
pub use shapes::{ShapesResult, Simulated};

use crate::built_in::{CHARACTERIZE_PROTOCOL, reality};
use crate::cache::{self, Inputs};
use crate::characterization::Recorded;
use crate::error::At;
use crate::files::{read_json, write_json};
use crate::{Caller, Planned, Progress, Run, RunError, SensorFile};

/// The paper's experiments, in a folder. What is there is not made again.
#[derive(Clone, Debug)]
pub struct Paper {
    folder: PathBuf,
    effort: Effort,
    seed: u64,
    sensor: SensorFile,
    caller: Caller,
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

    /// Makes all of it, and writes `report.html` and `metrics.json`.
    ///
    /// # Errors
    /// Those of the stages.
    pub fn finish(&self) -> Result<PaperMetrics, RunError> {
        let data = self.data()?;
        let twin = data.evaluate()?;
        let maps = self.maps(&data)?;
        let sensor = self.characterize()?;
        self.trials()?;
        self.simulated(&data)?;
        let metrics = PaperMetrics {
            provenance: twin.provenance,
            effort: self.effort,
            seed: self.seed,
            twin,
            sensor,
            maps,
            shapes: self.classify()?,
        };
        page::page(&metrics, &self.sensor.sensor, &self.caller.command).write(&self.report_path())?;
        write_json(&self.folder.join("metrics.json"), &metrics)?;
        Ok(metrics)
    }

    /// The page that [`finish`](Self::finish) writes.
    #[must_use]
    pub fn report_path(&self) -> PathBuf {
        self.folder.join("report.html")
    }

    /// The sensor under the paper's ball, on the bench that the paper's sensitivity is tuned on.
    fn characterize(&self) -> Result<SensorFigures, RunError> {
        let sensor = &self.sensor.sensor;
        let protocol = CHARACTERIZE_PROTOCOL;
        let planned = Planned::parse(protocol.name, protocol.text, sensor, self.seed)?;
        let run = self.run("under-a-ball", "presses and weights on the emulated bench")?;
        run.emulate(&reality(None)?, &planned)?;
        let recordings = run.stage("recordings");
        let inputs = self.inputs().stage(&recordings)?;
        self.run_stage("characterization", inputs, |folder| {
            let recorded = Recorded::read(&[recordings.join("presses.parquet")], self.progress())?;
            let found = recorded.characterize(sensor)?;
            recorded.write(&found, sensor, folder)?;
            write_json(&folder.join("figures.json"), &SensorFigures::of(&found))
        })?;
        read_json(&self.folder.join("characterization/figures.json"))
    }

    /// The paper's data, and the twins of them.
    fn data(&self) -> Result<Run, RunError> {
        let (protocol, sensor) = (self.effort.data(), &self.sensor.sensor);
        let planned = Planned::parse(protocol.name, protocol.text, sensor, self.seed)?;
        let source = format!("{} presses on the emulated bench", planned.presses.len());
        let run = self.run("data", &source)?;
        run.emulate(&reality(Some(Path::new(self.effort.reality())))?, &planned)?;
        run.finish()?;
        run.train_paper_twin()?;
        Ok(run)
    }

    fn run(&self, name: &str, source: &str) -> Result<Run, RunError> {
        let settings = self.effort.run_settings();
        let (folder, caller) = (self.folder.join(name), self.caller.clone());
        Run::start(&folder, self.sensor.clone(), source, self.seed, settings, caller)
    }

    fn progress(&self) -> &dyn Progress {
        &*self.caller.progress
    }

    fn inputs(&self) -> Inputs {
        Inputs::new(&self.caller.program)
    }

    fn run_stage(
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
