//! Stage `recordings`: presses from a lab's files, from logs of a bench, or from the emulated bench at once.

use std::path::{Path, PathBuf};
use std::sync::Arc;

use anyhow::{Context, Result, bail};
use rayon::prelude::*;
use serde::Serialize;
use serde::de::DeserializeOwned;
use twintac_lab::{Lab, LabError, LiveTable, Reality};
use twintac_log::ReadOptions;
use twintac_protocol::{LoadPlan, PressPlan, Protocol, Target};
use twintac_recording::{Import, ImportSummary, Recording};
use twintac_sensor::Sensor;

use crate::cache::{Inputs, read_json, write_json};
use crate::progress;
use crate::run::Run;

impl Run {
    /// Imports files; all of them must belong to the run's sensor.
    pub fn import(&self, import: &Path, files: &[PathBuf]) -> Result<()> {
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

    /// Records planned presses and weights on the emulated bench, each kept as soon as it is done.
    pub fn record(&self, reality: &Reality, plans: &[PressPlan], loads: &[LoadPlan]) -> Result<()> {
        let inputs = Inputs::new()?
            .settings("reality", reality)?
            .settings("plans", &plans)?
            .settings("loads", &loads)?
            .file(&self.folder.join("sensor.toml"))?;
        self.run_stage("recordings", inputs, |folder| {
            let lab = Lab::new(Arc::clone(&self.sensor.sensor), reality.clone());
            let keep = folder.join("presses");
            let mut presses = kept(
                "recording",
                plans,
                |plan| &plan.name,
                &keep,
                |plan| lab.press(plan),
            )?;
            presses.extend(kept(
                "weighing",
                loads,
                |load| &load.name,
                &keep,
                |load| lab.load(load),
            )?);
            let recording = lab.recording(presses);
            recording.write_parquet(&folder.join("presses.parquet"))?;
            write_json(&folder.join("plans.json"), &plans)?;
            if loads.is_empty() {
                return Ok(());
            }
            write_json(&folder.join("loads.json"), &loads)
        })
    }

    /// What the emulated gel answers at the places of the plans, each kept as soon as it is computed.
    pub fn live_tables(&self, lab: &Lab, reality: &Reality, plans: &[PressPlan]) -> Result<Vec<LiveTable>> {
        let inputs = Inputs::new()?
            .settings("reality", reality)?
            .settings("plans", &plans)?
            .file(&self.folder.join("sensor.toml"))?;
        self.run_stage("lab", inputs, |folder| {
            kept(
                "computing",
                plans,
                |plan| &plan.name,
                folder,
                |plan| lab.live_table(plan),
            )
            .map(|_| ())
        })?;
        let folder = self.stage("lab");
        let table = |plan: &PressPlan| read_json(&kept_in(&folder, &plan.name));
        plans.iter().map(table).collect()
    }

    /// Makes the run's recordings of the logs of its presses, as far as they are done.
    pub fn collect(&self, logs: &Path, plans: &[PressPlan]) -> Result<()> {
        let files = twintac_press::done_logs(logs, plans)?;
        let mut inputs = Inputs::new()?;
        for file in &files {
            inputs = inputs.file(file)?;
        }
        self.run_stage("recordings", inputs, |folder| {
            let mut recording: Option<Recording> = None;
            let mut remarks = Vec::new();
            for file in &files {
                let mut read = twintac_log::read_presses(file, &ReadOptions::default())?;
                for press in &mut read.recording.presses {
                    // Every press has a log of its own; what they share is how the indenter was mounted.
                    press.mounting.clone_from(&press.indenter);
                }
                remarks.extend(read.remarks.into_iter().map(|remark| (file.clone(), remark)));
                match &mut recording {
                    None => recording = Some(read.recording),
                    Some(recording) => recording
                        .append(read.recording)
                        .with_context(|| file.display().to_string())?,
                }
            }
            let recording = recording.context("no press is done")?;
            self.check_sensor(&recording)?;
            recording.write_parquet(&folder.join("presses.parquet"))?;
            write_json(&folder.join("plans.json"), &plans)?;
            write_json(&folder.join("remarks.json"), &remarks)
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
pub fn import_files(import: &Path, files: &[PathBuf]) -> Result<(Recording, ImportSummary)> {
    let text = std::fs::read_to_string(import).with_context(|| format!("reading {}", import.display()))?;
    let import = Import::parse(&import.display().to_string(), &text)?;
    Ok(import.read_all(files)?)
}

/// Makes something of each of `plans` over all cores, with a bar; what `folder` already holds is not made again.
fn kept<P: Sync, T: Serialize + DeserializeOwned + Send>(
    what: &'static str,
    plans: &[P],
    name: impl Fn(&P) -> &String + Sync,
    folder: &Path,
    make: impl Fn(&P) -> Result<T, LabError> + Sync,
) -> Result<Vec<T>> {
    let bar = progress::bar(what, plans.len() as u64);
    let made = plans
        .par_iter()
        .with_max_len(1)
        .map(|plan| -> Result<T> {
            let path = kept_in(folder, name(plan));
            let made = match read_json(&path) {
                Ok(made) => made,
                Err(_) => {
                    let made = make(plan)?;
                    write_json(&path, &made)?;
                    made
                }
            };
            bar.inc(1);
            Ok(made)
        })
        .collect();
    bar.finish_and_clear();
    made
}

fn kept_in(folder: &Path, name: &str) -> PathBuf {
    folder.join(format!("{}.json", name.replace('#', "-")))
}

/// The presses that a protocol plans for a sensor.
pub fn plan(protocol: &Path, sensor: &Sensor, seed: u64) -> Result<Vec<PressPlan>> {
    let protocol = read_protocol(protocol)?;
    Ok(protocol.plan(&target(sensor), seed)?)
}

/// The weights that a protocol puts on a sensor.
pub fn plan_loads(protocol: &Path, sensor: &Sensor, seed: u64) -> Result<Vec<LoadPlan>> {
    let protocol = read_protocol(protocol)?;
    Ok(protocol.loads(&target(sensor), seed)?)
}

fn read_protocol(path: &Path) -> Result<Protocol> {
    let text = std::fs::read_to_string(path).with_context(|| format!("reading {}", path.display()))?;
    Ok(Protocol::parse(&path.display().to_string(), &text)?)
}

/// The presses that a protocol's text plans for a sensor.
pub fn plan_text(file: &str, text: &str, sensor: &Sensor, seed: u64) -> Result<Vec<PressPlan>> {
    Ok(Protocol::parse(file, text)?.plan(&target(sensor), seed)?)
}

fn target(sensor: &Sensor) -> Target {
    let indenters = sensor.indenters.iter().map(|indenter| indenter.name.clone());
    let taxels = sensor.taxels.iter();
    Target {
        indenters: indenters.collect(),
        taxels: taxels
            .map(|taxel| (taxel.name.clone(), [taxel.position_mm.x, taxel.position_mm.y]))
            .collect(),
    }
}
