//! Recordings of a sensor, read for characterization.

use std::path::{Path, PathBuf};

use twintac_characterize::{Characterization, CharacterizeOptions, characterize, write_pages};
use twintac_log::{Body, Event, LogReader, ReadBack, ReadOptions, TactileFrame, TaxelState, read_presses};
use twintac_recording::{Frames, Import, Recording, Stored};
use twintac_sensor::Sensor;
use twintac_store::{write_file, write_json};
use twintac_work::{At, Progress, WorkError};

/// Name of the file of coefficients of temperature compensation.
pub const COMPENSATION: &str = "temperature.toml";

/// Recorded presses, and frames outside of presses.
#[derive(Clone, Debug)]
pub struct Recorded {
    /// The presses of all files; there may be none.
    pub recording: Recording,
    /// Frames outside of presses, each log on a clock of its own.
    pub logs: Vec<Frames>,
}

impl Recorded {
    /// Reads Parquet files of presses or of frames, MCAP logs (also cut ones), and, with an import
    /// description, logs of other laboratories. It leaves out logs that were set aside, cut logs
    /// beside their recovered copies, and presses in which the bench stopped, and notes this in
    /// `progress`.
    ///
    /// # Errors
    /// A file of another format, or one that cannot be read; recordings that do not belong
    /// together; no file that is left.
    pub fn read(
        files: &[PathBuf],
        import: Option<&Import>,
        progress: &dyn Progress,
    ) -> Result<Self, WorkError> {
        let mut all: Option<Recording> = None;
        let mut logs: Vec<Frames> = Vec::new();
        for file in to_read(files, import.is_some(), progress)? {
            let next = match import {
                _ if is_log(&file) && (import.is_none() || LogReader::open(&file).is_ok()) => {
                    let Log { recording, alone } = Log::read(&file, progress)?;
                    logs.push(alone);
                    recording
                }
                Some(import) if !is_parquet(&file) => imported(&file, import, &mut logs, progress)?,
                _ => match Stored::read_parquet(&file)? {
                    Stored::Presses(recording) => recording,
                    Stored::Frames(frames) => {
                        let recording = without_presses(&frames);
                        logs.push(frames);
                        recording
                    }
                },
            };
            match &mut all {
                None => all = Some(next),
                Some(all) => all.append(next).at(|| file.display().to_string())?,
            }
        }
        let recording = all.ok_or_else(|| {
            let problem =
                "all of these logs were set aside by `record`, because their presses were not finished";
            WorkError::Input(problem.to_owned())
        })?;
        Ok(Self { recording, logs })
    }

    /// What the sensor does, as far as the presses show it.
    ///
    /// # Errors
    /// Presses of another sensor, or none.
    pub fn characterize(&self, sensor: &Sensor) -> Result<Characterization, WorkError> {
        Ok(characterize(
            &self.recording,
            &self.logs,
            sensor,
            &CharacterizeOptions::default(),
        )?)
    }

    /// Writes `report.html`, `datasheet.html` and `characterization.json`. If the logs show how
    /// zeros move with temperature, it also writes `temperature.toml`, the coefficients with which
    /// readings are compensated.
    ///
    /// # Errors
    /// A file that cannot be written.
    pub fn write(&self, found: &Characterization, sensor: &Sensor, folder: &Path) -> Result<(), WorkError> {
        write_pages(folder, found, &self.recording, sensor)?;
        write_json(&folder.join("characterization.json"), found)?;
        if let Some(compensation) = found.compensation() {
            write_file(&folder.join(COMPENSATION), compensation.to_toml().as_bytes())?;
        }
        Ok(())
    }
}

impl From<Recording> for Recorded {
    /// A recording of presses alone.
    fn from(recording: Recording) -> Self {
        Self {
            recording,
            logs: Vec::new(),
        }
    }
}

/// A recording without presses, of the sensor of these frames.
fn without_presses(frames: &Frames) -> Recording {
    Recording {
        sensor: frames.sensor.clone(),
        provenance: frames.provenance,
        taxels: frames.taxels.clone(),
        presses: Vec::new(),
    }
}

/// A log of another laboratory: its presses are returned, or its frames are added to `logs`.
fn imported(
    file: &Path,
    import: &Import,
    logs: &mut Vec<Frames>,
    progress: &dyn Progress,
) -> Result<Recording, WorkError> {
    let (recording, summaries) = if import.has_presses() {
        let (recording, summary) = import.read_csv(file)?;
        (recording, summary.files)
    } else {
        let (frames, summary) = import.read_frames(file)?;
        let recording = without_presses(&frames);
        logs.push(frames);
        (recording, vec![summary])
    };
    for summary in summaries.iter().filter(|summary| summary.is_notable()) {
        summary.to_string().lines().for_each(|line| progress.note(line));
    }
    Ok(recording)
}

/// The files to read: without logs that were set aside, and without cut logs beside their recovered
/// copies.
fn to_read(files: &[PathBuf], imports: bool, progress: &dyn Progress) -> Result<Vec<PathBuf>, WorkError> {
    let mut kept = Vec::new();
    for file in files {
        let ends_with = |end: &str| file.extension().is_some_and(|extension| extension == end);
        if !is_log(file) && !is_parquet(file) && !imports {
            return Err(WorkError::Input(format!(
                "{} is neither a Parquet file nor an MCAP log; other files need an import description, `--import`, which `twintac import --guess` \
                 drafts",
                file.display()
            )));
        }
        let name = file.file_name().unwrap_or_default().to_string_lossy();
        if is_log(file) && name.contains(".try-") {
            progress.note(&format!("{} was set aside and is left out", file.display()));
        } else if ends_with("partial") && files.contains(&file.with_extension("")) {
            progress.note(&format!("{} has a complete copy and is left out", file.display()));
        } else {
            kept.push(file.clone());
        }
    }
    Ok(kept)
}

fn is_parquet(file: &Path) -> bool {
    file.extension().is_some_and(|extension| extension == "parquet")
}

fn is_log(file: &Path) -> bool {
    let name = file.to_string_lossy();
    name.ends_with(".mcap") || name.ends_with(".mcap.partial")
}

/// The content of a log.
struct Log {
    recording: Recording,
    /// Its frames outside of presses.
    alone: Frames,
}

impl Log {
    /// Reads a log, without the press in which the bench stopped. Remarks of the reader are noted
    /// in `progress`.
    fn read(file: &Path, progress: &dyn Progress) -> Result<Self, WorkError> {
        let reader = LogReader::open(file)?;
        let description = reader.description();
        let mut alone = Frames::new(&description.sensor, description.provenance, &description.taxels);
        let mut messages = reader.collect::<Result<Vec<_>, _>>()?;
        messages.sort_by_key(|message| message.bench_ns);
        let (mut begun_ns, mut was_pressed) = (None, false);
        let mut unfinished_ns = None;
        for message in messages {
            match message.body {
                Body::Event(Event::PressBegun { .. }) => begun_ns = Some(message.bench_ns),
                Body::Event(Event::PressEnded { .. }) => begun_ns = None,
                Body::Event(Event::Stopped { .. }) => unfinished_ns = begun_ns,
                Body::Tactile(frame) if begun_ns.is_none() => {
                    push_frame(&mut alone, message.bench_ns, &frame, was_pressed);
                    was_pressed = false;
                }
                Body::Tactile(_) => was_pressed = true,
                _ => {}
            }
        }
        let ReadBack {
            mut recording,
            remarks,
            ..
        } = read_presses(file, &ReadOptions::default())?;
        for remark in remarks {
            progress.note(&format!("{}: {remark}", file.display()));
        }
        if let Some(unfinished_ns) = unfinished_ns {
            recording.presses.retain(|press| {
                let is_finished = press.time_s[0] < unfinished_ns as f64 * 1e-9;
                if !is_finished {
                    progress.note(&format!(
                        "{}: press `{}` was not finished when the test setup stopped, and is left out",
                        file.display(),
                        press.name
                    ));
                }
                is_finished
            });
        }
        Ok(Self { recording, alone })
    }
}

/// Adds a frame of a log, unless it is no later than the last one.
fn push_frame(frames: &mut Frames, bench_ns: u64, frame: &TactileFrame, gap_before: bool) {
    let time_s = bench_ns as f64 * 1e-9;
    if frames.time_s.last().is_some_and(|last_s| time_s <= *last_s) {
        return;
    }
    let known = |number: Option<f64>| number.filter(|number| number.is_finite()).unwrap_or(f64::NAN);
    let taxels = || frame.taxels.iter();
    let readings_kpa = taxels().map(|taxel| match taxel.state {
        TaxelState::Good => known(taxel.pressure_pa) / 1000.0,
        _ => f64::NAN,
    });
    frames.time_s.push(time_s);
    frames.gap_before.push(gap_before);
    frames.readings_kpa.push(readings_kpa.collect());
    frames
        .temperature_c
        .push(taxels().map(|taxel| known(taxel.temperature_c)).collect());
}
