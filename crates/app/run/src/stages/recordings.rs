//! Stage `recordings`: presses from a lab's files, from logs of a bench, or from the emulated bench at once.

use std::path::{Path, PathBuf};
use std::sync::Arc;

use rayon::prelude::*;
use serde::Serialize;
use serde::de::DeserializeOwned;
use twintac_lab::{Lab, LabError, LiveTable, Reality};
use twintac_log::ReadOptions;
use twintac_protocol::PressPlan;
use twintac_recording::{Import, ImportSummary, Recording};

use crate::error::At;
use crate::files::{read_json, read_text, write_json};
use crate::progress::Work;
use crate::{Planned, Progress, Run, RunError};

impl Run {
    /// Makes the run's recordings of files of any laboratory, which the description `import` says how to read. All of them must belong to
    /// the run's sensor.
    ///
    /// # Errors
    /// A file that cannot be read as described, or that is of another sensor.
    pub fn import(&self, import: &Path, files: &[PathBuf]) -> Result<(), RunError> {
        let mut inputs = self.inputs().file(import)?;
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

    /// Computes what the emulated bench would record of planned presses and weights, without devices and without waiting. Each is kept as
    /// soon as it is done.
    ///
    /// # Errors
    /// A press that the gel cannot carry out.
    pub fn emulate(&self, reality: &Reality, planned: &Planned) -> Result<(), RunError> {
        let Planned {
            presses: plans,
            loads,
        } = planned;
        let inputs = self
            .inputs()
            .settings("reality", reality)?
            .settings("plans", &plans)?
            .settings("loads", &loads)?
            .file(&self.folder.join("sensor.toml"))?;
        self.run_stage("recordings", inputs, |folder| {
            let lab = Lab::new(Arc::clone(&self.sensor.sensor), reality.clone())?;
            let keep = folder.join("presses");
            let mut presses = kept(
                self.progress(),
                "recording",
                plans,
                |plan| &plan.name,
                &keep,
                |plan| lab.press(plan),
            )?;
            presses.extend(kept(
                self.progress(),
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

    /// Takes the recordings of another run, changed; `how` is what the change depends on.
    ///
    /// # Errors
    /// The other run has no recordings; a file that cannot be written.
    pub(crate) fn take(
        &self,
        other: &Self,
        how: &impl Serialize,
        change: impl FnOnce(Recording) -> Recording,
    ) -> Result<(), RunError> {
        let inputs = self.inputs().settings("change", how)?;
        self.run_stage(
            "recordings",
            inputs.stage(&other.stage("recordings"))?,
            |folder| {
                let changed = change(other.recording()?);
                Ok(changed.write_parquet(&folder.join("presses.parquet"))?)
            },
        )
    }

    /// What the emulated gel answers at the places of the plans, each kept as soon as it is computed.
    pub(crate) fn live_tables(
        &self,
        lab: &Lab,
        reality: &Reality,
        plans: &[PressPlan],
    ) -> Result<Vec<LiveTable>, RunError> {
        let inputs = self
            .inputs()
            .settings("reality", reality)?
            .settings("plans", &plans)?
            .file(&self.folder.join("sensor.toml"))?;
        self.run_stage("lab", inputs, |folder| {
            kept(
                self.progress(),
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
    ///
    /// # Errors
    /// Logs that cannot be read or are of another sensor; none at all.
    pub fn collect(&self, logs: &Path, plans: &[PressPlan]) -> Result<(), RunError> {
        let files = twintac_press::done_logs(logs, plans)?;
        let mut inputs = self.inputs();
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
                        .at(|| file.display().to_string())?,
                }
            }
            let recording = recording.ok_or_else(|| RunError::Input("no press is done".to_owned()))?;
            self.check_sensor(&recording)?;
            recording.write_parquet(&folder.join("presses.parquet"))?;
            write_json(&folder.join("plans.json"), &plans)?;
            write_json(&folder.join("remarks.json"), &remarks)
        })
    }

    fn check_sensor(&self, recording: &Recording) -> Result<(), RunError> {
        let sensor = &self.sensor.sensor;
        if recording.sensor != sensor.name {
            return Err(RunError::Input(format!(
                "the recordings are of sensor `{}`, the description is of `{}`",
                recording.sensor, sensor.name
            )));
        }
        let taxels: Vec<&String> = sensor.taxels.iter().map(|taxel| &taxel.name).collect();
        if !recording.taxels.iter().eq(taxels.iter().copied()) {
            return Err(RunError::Input(format!(
                "the recordings have taxels {:?}, the description has {taxels:?}",
                recording.taxels
            )));
        }
        Ok(())
    }
}

/// Reads files of a laboratory as the description `import` says.
///
/// # Errors
/// A file that cannot be read as described.
pub fn import_files(import: &Path, files: &[PathBuf]) -> Result<(Recording, ImportSummary), RunError> {
    let import = Import::parse(&import.display().to_string(), &read_text(import)?)?;
    Ok(import.read_all(files)?)
}

/// Reads `presses.parquet` files of runs as one recording.
///
/// # Errors
/// A file of another kind, or that cannot be read; recordings that do not belong together.
pub fn read_recordings(files: &[PathBuf]) -> Result<Recording, RunError> {
    let mut all: Option<Recording> = None;
    for file in files {
        if file.extension().is_none_or(|extension| extension != "parquet") {
            return Err(RunError::Input(format!(
                "{} is no Parquet file; say with --import how to read it",
                file.display()
            )));
        }
        let next = Recording::read_parquet(file)?;
        match &mut all {
            None => all = Some(next),
            Some(all) => all.append(next).at(|| file.display().to_string())?,
        }
    }
    all.ok_or_else(|| RunError::Input("there are no recordings".to_owned()))
}

/// Makes something of each of `plans` over all cores; what `folder` already holds is not made again.
fn kept<P: Sync, T: Serialize + DeserializeOwned + Send>(
    progress: &dyn Progress,
    work: &str,
    plans: &[P],
    name: impl Fn(&P) -> &String + Sync,
    folder: &Path,
    make: impl Fn(&P) -> Result<T, LabError> + Sync,
) -> Result<Vec<T>, RunError> {
    let work = Work::start(progress, work, plans.len());
    plans
        .par_iter()
        .with_max_len(1)
        .map(|plan| -> Result<T, RunError> {
            work.go_on()?;
            let path = kept_in(folder, name(plan));
            let made = match read_json(&path) {
                Ok(made) => made,
                Err(_) => {
                    let made = make(plan)?;
                    write_json(&path, &made)?;
                    made
                }
            };
            work.step("");
            Ok(made)
        })
        .collect()
}

fn kept_in(folder: &Path, name: &str) -> PathBuf {
    folder.join(format!("{}.json", name.replace('#', "-")))
}
