//! A run: a folder in which a sensor's recordings become a judged twin, stage by stage.
//!
//! ```text
//! run.json       what the run is made from, and its settings
//! sensor.toml    the sensor description, as it was (surfaces beside it)
//! logs/          of a bench: one for each press (MCAP)
//! lab/           of the emulated bench: what its gel answers at the places of the presses
//! recordings/    presses.parquet, summary.json
//! mesh/          the gel's mesh for ParaView and Gmsh, quality.json
//! simulation/    split.json, bench.json, and a table over depth for each place
//! pairs/         measured and simulated frames side by side
//! training/      a twin that never saw the test presses, a twin of all presses, losses
//! evaluation/    the errors
//! model/         the twin of all presses, to be used elsewhere
//! report.html, metrics.json
//! ```

use std::path::{Path, PathBuf};
use std::sync::Arc;

use anyhow::{Context, Result};
use serde::{Deserialize, Serialize};
use twintac_recording::Recording;
use twintac_sensor::Sensor;
use twintac_simulate::Gel;

use crate::cache::{self, read_json, write_json};
use crate::sensor_file::{SensorFile, read_sensor};

use crate::settings::RunSettings;

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

/// An open run.
pub struct Run {
    pub folder: PathBuf,
    pub record: RunRecord,
    pub sensor: SensorFile,
}

impl Run {
    /// Starts a run, or takes up the one that the folder holds with new settings: stages that they do not touch are kept.
    pub fn start(
        folder: &Path,
        sensor: SensorFile,
        source: String,
        seed: u64,
        settings: RunSettings,
    ) -> Result<Self> {
        std::fs::create_dir_all(folder).with_context(|| format!("creating {}", folder.display()))?;
        let record = RunRecord {
            sensor: sensor.sensor.name.clone(),
            source,
            seed,
            settings,
        };
        sensor.copy_to(folder)?;
        write_json(&folder.join("run.json"), &record)?;
        Ok(Self {
            folder: folder.to_owned(),
            record,
            sensor,
        })
    }

    /// Opens a run that was started.
    pub fn open(folder: &Path) -> Result<Self> {
        let record: RunRecord = read_json(&folder.join("run.json")).with_context(|| {
            format!(
                "{} is not a run; start one with `twintac import` or `twintac record`",
                folder.display()
            )
        })?;
        let sensor = read_sensor(&folder.join("sensor.toml"))?;
        Ok(Self {
            folder: folder.to_owned(),
            record,
            sensor,
        })
    }

    /// The folder of a stage.
    pub fn stage(&self, name: &str) -> PathBuf {
        self.folder.join(name)
    }

    /// The presses, as recorded.
    pub fn recording(&self) -> Result<Recording> {
        let path = self.stage("recordings").join("presses.parquet");
        Recording::read_parquet(&path).map_err(Into::into)
    }

    /// The gel as the twin simulates it.
    pub fn gel(&self) -> Gel {
        Gel::new(
            Arc::clone(&self.sensor.sensor),
            self.record.settings.simulate.clone(),
        )
    }

    /// Taxels whose readings are not to be trusted, by index: left out of headline figures.
    pub fn left_out(&self) -> std::collections::BTreeSet<usize> {
        left_out(&self.sensor.sensor)
    }

    /// Runs a stage unless it is there, and says so.
    pub fn run_stage(
        &self,
        name: &str,
        inputs: cache::Inputs,
        work: impl FnOnce(&Path) -> Result<()>,
    ) -> Result<()> {
        let outcome =
            cache::run(&self.stage(name), inputs, work).with_context(|| format!("stage `{name}`"))?;
        let word = match outcome {
            cache::Outcome::Ran => "done",
            cache::Outcome::Kept => "kept",
        };
        crate::progress::note(&format!("{name:>11} {word}"));
        Ok(())
    }
}

/// Taxels of a sensor whose readings are not to be trusted, by index.
pub fn left_out(sensor: &Sensor) -> std::collections::BTreeSet<usize> {
    let taxels = sensor.taxels.iter().enumerate();
    taxels
        .filter(|(_, taxel)| taxel.doubtful.is_some())
        .map(|(index, _)| index)
        .collect()
}
