//! Stage `recordings`: presses from files of a laboratory, from logs of a bench, or computed for
//! the emulated bench.

use std::path::{Path, PathBuf};
use std::sync::Arc;

use rayon::prelude::*;
use serde::Serialize;
use twintac_lab::{EmulatorConfiguration, Lab, LiveTable};
use twintac_log::{ReadOptions, read_bag};
use twintac_protocol::{LoadPlan, PressPlan};
use twintac_recording::{Import, ImportSummary, Press, Recording, guess_bag_import};
use twintac_sensor::{Sensor, SensorFile};
use twintac_store::{Digest, Finished, Keyed, Recipe, Stage, Store, StoreError, read_json, write_json};
use twintac_temperature::Compensation;
use twintac_work::{At, Planned, Progress, Work, WorkError, read_text};

use crate::Run;

/// The name of the stage, and the commands that make it.
const RECORDINGS: (&str, &str) = ("recordings", "twintac import` or `twintac record");

/// Name of the file of presses.
const PRESSES: &str = "presses.parquet";

/// The presses of the stage.
///
/// # Errors
/// A file that cannot be read.
pub fn read_recording(stage: &Finished) -> Result<Recording, WorkError> {
    Ok(Recording::read_parquet(&stage.file(PRESSES))?)
}

/// Heights of a gel that differ by less are the same height, measured twice, mm.
const LEVEL_MM: f64 = 1.0;

/// An input file. Its name is that of a mounting (one installation of sensor and indenter). Its
/// content is identified by the digest; its path does not count.
#[derive(Serialize)]
struct LabFile<'a> {
    name: String,
    sha256: Digest,
    #[serde(skip)]
    path: &'a PathBuf,
}

/// Presses from files of any laboratory.
#[derive(Serialize)]
struct Importing<'a> {
    sensor: &'a Keyed<SensorFile>,
    import: Keyed<Import>,
    files: Vec<LabFile<'a>>,
    #[serde(skip_serializing_if = "Option::is_none")]
    temperature: Option<&'a Compensation>,
}

impl Stage for Importing<'_> {
    const NAME: &'static str = RECORDINGS.0;
    const MADE_BY: &'static str = RECORDINGS.1;
    type Follower = dyn Progress;
    type Error = WorkError;

    fn make(&self, folder: &Path, progress: &dyn Progress) -> Result<(), WorkError> {
        let files: Vec<PathBuf> = self.files.iter().map(|file| file.path.clone()).collect();
        check_heights(&self.sensor.sensor, &self.import, &files)?;
        let (mut recording, summary) = self.import.read_all(&files)?;
        tell(&summary, progress);
        check_sensor(&self.sensor.sensor, &recording)?;
        compensate(&mut recording, self.temperature, progress)?;
        recording.write_parquet(&folder.join(PRESSES))?;
        Ok(write_json(&folder.join("summary.json"), &summary)?)
    }
}

/// Checks that the import description and the sensor's have the top of the gel at the same height.
fn check_heights(sensor: &Sensor, import: &Import, files: &[PathBuf]) -> Result<(), WorkError> {
    let top_mm = sensor.gel.solid.bounds_mm(&sensor.surfaces).1.z;
    for file in files {
        let imported_mm = import.gel_top_mm(file)?;
        if (imported_mm - top_mm).abs() > LEVEL_MM {
            return Err(WorkError::Input(format!(
                "{}: `gel_top_mm` of the import description is {imported_mm}, but the gel of `{}` is {top_mm} mm high; give both the same height above the board",
                file.display(),
                sensor.name
            )));
        }
    }
    Ok(())
}

/// Reports files of which something was left out.
fn tell(summary: &ImportSummary, progress: &dyn Progress) {
    for file in summary.files.iter().filter(|file| file.is_notable()) {
        file.to_string().lines().for_each(|line| progress.note(line));
    }
}

/// Removes the drift of zeros with temperature, if coefficients are known, and reports it.
fn compensate(
    recording: &mut Recording,
    temperature: Option<&Compensation>,
    progress: &dyn Progress,
) -> Result<(), WorkError> {
    if let Some(temperature) = temperature {
        twintac_model::compensate(recording, temperature, progress)?;
    }
    Ok(())
}

/// Presses and weights, computed for the emulated bench without its devices.
#[derive(Serialize)]
struct Emulating<'a> {
    sensor: &'a Keyed<SensorFile>,
    emulator: &'a EmulatorConfiguration,
    plans: &'a [PressPlan],
    loads: &'a [LoadPlan],
}

impl Stage for Emulating<'_> {
    const NAME: &'static str = RECORDINGS.0;
    const MADE_BY: &'static str = RECORDINGS.1;
    type Follower = dyn Progress;
    type Error = WorkError;

    fn make(&self, folder: &Path, progress: &dyn Progress) -> Result<(), WorkError> {
        let lab = keyed_lab(self.sensor, self.emulator)?;
        let store = Store::new(&folder.join("presses"), Self::NAME);
        let presses = |plan| EmulatedPress { lab: &lab, plan };
        let mut presses = all(progress, "recording", &store, self.plans.iter().map(presses))?;
        let weighing = |load| EmulatedLoad { lab: &lab, load };
        presses.extend(all(
            progress,
            "weighing",
            &store,
            self.loads.iter().map(weighing),
        )?);
        lab.recording(presses).write_parquet(&folder.join(PRESSES))?;
        write_json(&folder.join("plans.json"), &self.plans)?;
        if !self.loads.is_empty() {
            write_json(&folder.join("loads.json"), &self.loads)?;
        }
        Ok(())
    }
}

/// The emulated bench follows from the sensor and the emulator configuration.
fn keyed_lab(sensor: &Keyed<SensorFile>, emulator: &EmulatorConfiguration) -> Result<Keyed<Lab>, WorkError> {
    let lab = Lab::new(Arc::clone(&sensor.sensor), emulator.clone())?;
    Ok(Keyed::from_inputs(lab, &(sensor, emulator))?)
}

#[derive(Serialize)]
struct EmulatedPress<'a> {
    lab: &'a Keyed<Lab>,
    plan: &'a PressPlan,
}

impl Recipe for EmulatedPress<'_> {
    type Value = Press;
    type Error = WorkError;

    fn label(&self) -> String {
        self.plan.name.clone()
    }

    fn make(&self) -> Result<Press, WorkError> {
        Ok(self.lab.press(self.plan)?)
    }
}

#[derive(Serialize)]
struct EmulatedLoad<'a> {
    lab: &'a Keyed<Lab>,
    load: &'a LoadPlan,
}

impl Recipe for EmulatedLoad<'_> {
    type Value = Press;
    type Error = WorkError;

    fn label(&self) -> String {
        self.load.name.clone()
    }

    fn make(&self) -> Result<Press, WorkError> {
        Ok(self.lab.load(self.load)?)
    }
}

/// The response of the emulated gel at the locations of planned presses.
#[derive(Serialize)]
struct LiveTables<'a> {
    sensor: &'a Keyed<SensorFile>,
    emulator: &'a EmulatorConfiguration,
    plans: &'a [PressPlan],
}

/// Name of the file of tables, in the order of the plans.
const TABLES: &str = "tables.json";

impl Stage for LiveTables<'_> {
    const NAME: &'static str = "lab";
    const MADE_BY: &'static str = RECORDINGS.1;
    type Follower = dyn Progress;
    type Error = WorkError;

    fn make(&self, folder: &Path, progress: &dyn Progress) -> Result<(), WorkError> {
        let lab = keyed_lab(self.sensor, self.emulator)?;
        let store = Store::new(&folder.join("places"), Self::NAME);
        let recipes = self.plans.iter().map(|plan| LiveTableAt { lab: &lab, plan });
        let tables = all(progress, "computing", &store, recipes)?;
        Ok(write_json(&folder.join(TABLES), &tables)?)
    }
}

#[derive(Serialize)]
struct LiveTableAt<'a> {
    lab: &'a Keyed<Lab>,
    plan: &'a PressPlan,
}

impl Recipe for LiveTableAt<'_> {
    type Value = LiveTable;
    type Error = WorkError;

    fn label(&self) -> String {
        self.plan.name.clone()
    }

    fn make(&self) -> Result<LiveTable, WorkError> {
        Ok(self.lab.live_table(self.plan)?)
    }
}

/// Presses from the logs of a bench.
#[derive(Serialize)]
struct Collecting<'a> {
    sensor: &'a Keyed<SensorFile>,
    plans: &'a [PressPlan],
    logs: Vec<LabFile<'a>>,
    #[serde(skip_serializing_if = "Option::is_none")]
    temperature: Option<&'a Compensation>,
}

impl Stage for Collecting<'_> {
    const NAME: &'static str = RECORDINGS.0;
    const MADE_BY: &'static str = RECORDINGS.1;
    type Follower = dyn Progress;
    type Error = WorkError;

    fn make(&self, folder: &Path, progress: &dyn Progress) -> Result<(), WorkError> {
        let mut recording: Option<Recording> = None;
        let mut remarks = Vec::new();
        for LabFile { path, name, .. } in &self.logs {
            let mut read = twintac_log::read_presses(path, &ReadOptions::default())?;
            for press in &mut read.recording.presses {
                // Every press has a log of its own. Presses with the same indenter share its
                // mounting.
                press.mounting.clone_from(&press.indenter);
            }
            remarks.extend(read.remarks.into_iter().map(|remark| (name.clone(), remark)));
            match &mut recording {
                None => recording = Some(read.recording),
                Some(recording) => recording
                    .append(read.recording)
                    .at(|| path.display().to_string())?,
            }
        }
        let mut recording = recording.ok_or_else(|| WorkError::Input("no press is done".to_owned()))?;
        check_sensor(&self.sensor.sensor, &recording)?;
        compensate(&mut recording, self.temperature, progress)?;
        recording.write_parquet(&folder.join(PRESSES))?;
        write_json(&folder.join("plans.json"), &self.plans)?;
        Ok(write_json(&folder.join("remarks.json"), &remarks)?)
    }
}

/// A change of the recordings of another run. Its fields are all the inputs of the change.
pub trait Change: Serialize {
    /// The recordings, changed.
    fn changed(&self, recording: Recording) -> Recording;
}

/// The changed recordings of another run.
#[derive(Serialize)]
struct Taking<'a, C> {
    sensor: &'a Keyed<SensorFile>,
    recordings: Finished,
    change: &'a C,
}

impl<C: Change> Stage for Taking<'_, C> {
    const NAME: &'static str = RECORDINGS.0;
    const MADE_BY: &'static str = RECORDINGS.1;
    type Follower = dyn Progress;
    type Error = WorkError;

    fn make(&self, folder: &Path, _: &dyn Progress) -> Result<(), WorkError> {
        let changed = self.change.changed(read_recording(&self.recordings)?);
        Ok(changed.write_parquet(&folder.join(PRESSES))?)
    }
}

impl Run {
    /// The presses as recorded.
    ///
    /// # Errors
    /// There are none yet, they are of another sensor than the run, or they cannot be read.
    pub fn recording(&self) -> Result<Recording, WorkError> {
        read_recording(&self.recordings()?)
    }

    /// Makes the run's recordings from files of any laboratory, which the import description
    /// `import` says how to read. All of them must belong to the run's sensor.
    ///
    /// # Errors
    /// A file that cannot be read as described, or that is of another sensor.
    pub fn import(&self, import: &Path, files: &[PathBuf]) -> Result<(), WorkError> {
        let (description, text) = read_import_text(import)?;
        self.run_stage(&Importing {
            sensor: self.keyed_sensor(),
            import: Keyed::of_bytes(description, text.as_bytes()),
            files: lab_files(files)?,
            temperature: self.settings().temperature.as_ref(),
        })
        .map(drop)
    }

    /// Computes what the emulated bench would record of planned presses and weights, without
    /// devices and without waiting. Each result is kept as soon as it is done.
    ///
    /// # Errors
    /// A press that the gel cannot carry out.
    pub fn emulate(&self, emulator: &EmulatorConfiguration, planned: &Planned) -> Result<(), WorkError> {
        self.run_stage(&Emulating {
            sensor: self.keyed_sensor(),
            emulator,
            plans: &planned.presses,
            loads: &planned.loads,
        })
        .map(drop)
    }

    /// Makes the run's recordings from those of another run, with a change.
    ///
    /// # Errors
    /// The other run has no recordings; a file that cannot be written.
    pub fn take(&self, other: &Self, change: &impl Change) -> Result<(), WorkError> {
        self.run_stage(&Taking {
            sensor: self.keyed_sensor(),
            recordings: other.recordings()?,
            change,
        })
        .map(drop)
    }

    /// The response of the emulated gel at the locations of the plans. Each is kept as soon as it
    /// is computed.
    pub(crate) fn live_tables(
        &self,
        emulator: &EmulatorConfiguration,
        plans: &[PressPlan],
    ) -> Result<Vec<LiveTable>, WorkError> {
        let finished = self.run_stage(&LiveTables {
            sensor: self.keyed_sensor(),
            emulator,
            plans,
        })?;
        Ok(read_json(&finished.file(TABLES))?)
    }

    /// Makes the run's recordings from the logs of those presses that are done.
    ///
    /// # Errors
    /// Logs that cannot be read or are of another sensor; none at all.
    pub fn collect(&self, logs: &Path, plans: &[PressPlan]) -> Result<(), WorkError> {
        let files = twintac_press::done_logs(logs, plans)?;
        self.run_stage(&Collecting {
            sensor: self.keyed_sensor(),
            plans,
            logs: lab_files(&files)?,
            temperature: self.settings().temperature.as_ref(),
        })
        .map(drop)
    }

    /// The stage of recordings, of the sensor as it is described now.
    ///
    /// # Errors
    /// It does not exist, or is of another sensor.
    pub fn recordings(&self) -> Result<Finished, WorkError> {
        let (name, made_by) = RECORDINGS;
        let finished = self.stages().finished(name, made_by).map_err(StoreError::from)?;
        let sensor = Digest::of_value(self.keyed_sensor()).ok();
        if finished.made_from().part("sensor") == sensor {
            return Ok(finished);
        }
        Err(WorkError::Input(format!(
            "{}: the recordings were made for another description of the sensor; make them again with `{made_by}`",
            self.folder().display()
        )))
    }
}

fn lab_files(files: &[PathBuf]) -> Result<Vec<LabFile<'_>>, WorkError> {
    let files = files.iter().map(|path| {
        Ok(LabFile {
            name: path
                .file_name()
                .unwrap_or_default()
                .to_string_lossy()
                .into_owned(),
            sha256: Digest::of_file(path)?,
            path,
        })
    });
    files.collect()
}

fn check_sensor(sensor: &Sensor, recording: &Recording) -> Result<(), WorkError> {
    if recording.sensor != sensor.name {
        return Err(WorkError::Input(format!(
            "the recordings are of sensor `{}`, the description is of `{}`",
            recording.sensor, sensor.name
        )));
    }
    let taxels: Vec<&String> = sensor.taxels.iter().map(|taxel| &taxel.name).collect();
    if !recording.taxels.iter().eq(taxels.iter().copied()) {
        return Err(WorkError::Input(format!(
            "the recordings have taxels {:?}, the description has {taxels:?}",
            recording.taxels
        )));
    }
    Ok(())
}

/// The values of all recipes, made in parallel.
fn all<R>(
    progress: &dyn Progress,
    work: &str,
    store: &Store,
    recipes: impl ExactSizeIterator<Item = R>,
) -> Result<Vec<R::Value>, WorkError>
where
    R: Recipe<Error = WorkError> + Sync + Send,
    R::Value: Send,
{
    let work = Work::start(progress, work, recipes.len());
    let recipes: Vec<R> = recipes.collect();
    recipes
        .par_iter()
        .with_max_len(1)
        .map(|recipe| {
            work.go_on()?;
            let kept = store.get(recipe)?;
            kept.made_again.iter().for_each(|why| progress.note(why));
            work.step("");
            Ok(kept.value)
        })
        .collect()
}

/// Reads files of a laboratory according to the import description `import`.
///
/// # Errors
/// A file that cannot be read as described.
pub fn import_files(import: &Path, files: &[PathBuf]) -> Result<(Recording, ImportSummary), WorkError> {
    Ok(read_import(import)?.read_all(files)?)
}

/// Reads an import description, of CSV files or of bags of ROS 2.
///
/// # Errors
/// A file that cannot be read, or is wrong.
pub fn read_import(import: &Path) -> Result<Import, WorkError> {
    read_import_text(import).map(|(import, _)| import)
}

fn read_import_text(import: &Path) -> Result<(Import, String), WorkError> {
    let text = read_text(import)?;
    let description = Import::parse(&import.display().to_string(), &text)?;
    Ok((description.with_bags(read_bag), text))
}

/// Guesses a first import description of a CSV file or a bag of ROS 2, as text to be checked. What
/// the file does not contain is marked with TODO.
///
/// # Errors
/// A file that cannot be read, or in which nothing looks like readings.
pub fn guess_import(file: &Path) -> Result<String, WorkError> {
    let guess = guess_bag_import(file, read_bag);
    Ok(guess.unwrap_or_else(|| twintac_recording::guess_import(file))?)
}

/// Reads `presses.parquet` files of runs as one recording.
///
/// # Errors
/// A file of another kind, or that cannot be read; recordings that do not belong together.
pub fn read_recordings(files: &[PathBuf]) -> Result<Recording, WorkError> {
    let mut all: Option<Recording> = None;
    for file in files {
        if file.extension().is_none_or(|extension| extension != "parquet") {
            return Err(WorkError::Input(format!(
                "{} is not a Parquet file; give --import to read it",
                file.display()
            )));
        }
        let next = Recording::read_parquet(file)?;
        match &mut all {
            None => all = Some(next),
            Some(all) => all.append(next).at(|| file.display().to_string())?,
        }
    }
    all.ok_or_else(|| WorkError::Input("there are no recordings".to_owned()))
}
