//! Stage `recordings`: presses from a lab's files, or from the emulated bench.

use std::path::{Path, PathBuf};
use std::sync::Arc;

use anyhow::{Context, Result, bail};
use rayon::prelude::*;
use twintac_lab::{Bench, Reality};
use twintac_protocol::{PressPlan, Protocol};
use twintac_recording::{Import, ImportSummary, Press, Recording};

use super::Run;
use crate::progress;
use crate::stage::{Inputs, read_json, write_json};

impl Run {
    /// Imports files; all of them must belong to the run's sensor.
    pub(crate) fn import(&self, import: &Path, files: &[PathBuf]) -> Result<()> {
        let mut inputs = Inputs::new()?.file(import)?;
        for file in files {
            inputs = inputs.file(file)?;
        }
        self.run_stage("recordings", inputs, |folder| {
            let (recording, summary) = import_files(import, files)?;
            self.check_sensor(&recording)?;
            recording.write_parquet(&folder.join("presses.parquet"))?;
            write_json(&folder.join("summary.json"), &summary)
        })
    }

    /// Records planned presses on the emulated bench, each kept as soon as it is done.
    pub(crate) fn record(&self, reality: &Reality, plans: &[PressPlan]) -> Result<()> {
        let inputs = Inputs::new()?
            .settings("reality", reality)?
            .settings("plans", &plans)?
            .file(&self.folder.join("sensor.toml"))?;
        self.run_stage("recordings", inputs, |folder| {
            let bench = Bench::new(Arc::clone(&self.sensor.sensor), reality.clone());
            let recording = record_on_bench(&bench, plans, &folder.join("presses"))?;
            recording.write_parquet(&folder.join("presses.parquet"))?;
            write_json(&folder.join("plans.json"), &plans)
        })
    }

    fn check_sensor(&self, recording: &Recording) -> Result<()> {
        let sensor = &self.sensor.sensor;
        if recording.sensor != sensor.name {
            bail!(
                "the recordings are of sensor `{}`, the description is of `{}`",
                recording.sensor,
                sensor.name
            );
        }
        let taxels: Vec<&String> = sensor.taxels.iter().map(|taxel| &taxel.name).collect();
        if !recording.taxels.iter().eq(taxels.iter().copied()) {
            bail!(
                "the recordings have taxels {:?}, the description has {taxels:?}",
                recording.taxels
            );
        }
        Ok(())
    }
}

/// Reads files through an import description.
pub(crate) fn import_files(import: &Path, files: &[PathBuf]) -> Result<(Recording, ImportSummary)> {
    let text = std::fs::read_to_string(import).with_context(|| format!("reading {}", import.display()))?;
    let import = Import::parse(&import.display().to_string(), &text)?;
    Ok(import.read_all(files)?)
}

/// Performs presses over all cores; those that `folder` already holds are not repeated.
pub(crate) fn record_on_bench(bench: &Bench, plans: &[PressPlan], folder: &Path) -> Result<Recording> {
    let bar = progress::bar("recording", plans.len() as u64);
    let presses = plans
        .par_iter()
        .with_max_len(1)
        .map(|plan| -> Result<Press> {
            let path = folder.join(format!("{}.json", plan.name.replace('#', "-")));
            let press = match read_json(&path) {
                Ok(press) => press,
                Err(_) => {
                    let press = bench.press(plan)?;
                    write_json(&path, &press)?;
                    press
                }
            };
            bar.inc(1);
            Ok(press)
        })
        .collect::<Result<Vec<_>>>()?;
    bar.finish_and_clear();
    Ok(bench.recording(presses))
}

/// The presses that a protocol plans for a sensor.
pub(crate) fn plan(protocol: &Path, sensor: &twintac_sensor::Sensor, seed: u64) -> Result<Vec<PressPlan>> {
    let text =
        std::fs::read_to_string(protocol).with_context(|| format!("reading {}", protocol.display()))?;
    plan_text(&protocol.display().to_string(), &text, sensor, seed)
}

/// The presses that a protocol's text plans for a sensor.
pub(crate) fn plan_text(
    file: &str,
    text: &str,
    sensor: &twintac_sensor::Sensor,
    seed: u64,
) -> Result<Vec<PressPlan>> {
    let names: Vec<String> = sensor
        .indenters
        .iter()
        .map(|indenter| indenter.name.clone())
        .collect();
    Ok(Protocol::parse(file, text)?.plan(&names, seed)?)
}
