//! Stage `recordings`: presses from a lab's files, from logs of a bench, or from the emulated bench at once.

use std::path::{Path, PathBuf};
use std::sync::Arc;

use anyhow::{Context, Result, bail};
use rayon::prelude::*;
use twintac_lab::{Bench, LiveTable, Reality};
use twintac_log::ReadOptions;
use twintac_protocol::{PressPlan, Protocol};
use twintac_recording::{Import, ImportSummary, Recording};

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

    /// What the emulated gel answers at the places of the plans, each kept as soon as it is computed.
    pub(crate) fn live_tables(
        &self,
        lab: &Bench,
        reality: &Reality,
        plans: &[PressPlan],
    ) -> Result<Vec<LiveTable>> {
        let inputs = Inputs::new()?
            .settings("reality", reality)?
            .settings("plans", &plans)?
            .file(&self.folder.join("sensor.toml"))?;
        let file = |folder: &Path, plan: &PressPlan| folder.join(format!("{}.json", file_stem(plan)));
        self.run_stage("lab", inputs, |folder| {
            for_each_plan("computing", plans, |plan| {
                let path = file(folder, plan);
                if read_json::<LiveTable>(&path).is_err() {
                    write_json(&path, &lab.live_table(plan)?)?;
                }
                Ok(())
            })
            .map(|_| ())
        })?;
        let folder = self.stage("lab");
        plans.iter().map(|plan| read_json(&file(&folder, plan))).collect()
    }

    /// Makes the run's recordings of the logs of its presses, as far as they are done.
    pub(crate) fn collect(&self, logs: &Path, plans: &[PressPlan]) -> Result<()> {
        let files = twintac_press::done_logs(logs, plans)?;
        let mut inputs = Inputs::new()?;
        for file in &files {
            inputs = inputs.file(file)?;
        }
        self.run_stage("recordings", inputs, |folder| {
            let mut recording: Option<Recording> = None;
            let mut remarks = Vec::new();
            for file in &files {
                let read = twintac_log::read_presses(file, &ReadOptions::default())?;
                remarks.extend(read.remarks.into_iter().map(|remark| (file.clone(), remark)));
                match &mut recording {
                    None => recording = Some(read.recording),
                    Some(recording) if recording.provenance == read.recording.provenance => {
                        recording.presses.extend(read.recording.presses);
                    }
                    Some(recording) => bail!(
                        "{} is {}, the logs before it are {}: keep them in folders of their own",
                        file.display(),
                        read.recording.provenance,
                        recording.provenance
                    ),
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
pub(crate) fn import_files(import: &Path, files: &[PathBuf]) -> Result<(Recording, ImportSummary)> {
    let text = std::fs::read_to_string(import).with_context(|| format!("reading {}", import.display()))?;
    let import = Import::parse(&import.display().to_string(), &text)?;
    Ok(import.read_all(files)?)
}

/// Performs presses over all cores; those that `folder` already holds are not repeated.
pub(crate) fn record_on_bench(bench: &Bench, plans: &[PressPlan], folder: &Path) -> Result<Recording> {
    let presses = for_each_plan("recording", plans, |plan| {
        let path = folder.join(format!("{}.json", file_stem(plan)));
        if let Ok(press) = read_json(&path) {
            return Ok(press);
        }
        let press = bench.press(plan)?;
        write_json(&path, &press)?;
        Ok(press)
    })?;
    Ok(bench.recording(presses))
}

/// Does something for each plan over all cores, with a bar.
fn for_each_plan<T: Send>(
    stage: &str,
    plans: &[PressPlan],
    work: impl Fn(&PressPlan) -> Result<T> + Sync,
) -> Result<Vec<T>> {
    let bar = progress::bar(stage, plans.len() as u64);
    let done = plans
        .par_iter()
        .with_max_len(1)
        .map(|plan| {
            let result = work(plan);
            bar.inc(1);
            result
        })
        .collect();
    bar.finish_and_clear();
    done
}

/// A press's name, fit for files.
fn file_stem(plan: &PressPlan) -> String {
    plan.name.replace('#', "-")
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
