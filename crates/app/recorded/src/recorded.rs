//! Recorded presses of a sensor, read to characterize it.

use std::path::{Path, PathBuf};

use twintac_characterize::{
    Characterization, CharacterizeOptions, UnloadedCourse, characterize, write_pages,
};
use twintac_log::{Body, Event, LogReader, ReadBack, ReadOptions, TaxelState, read_presses};
use twintac_recording::Recording;
use twintac_sensor::Sensor;
use twintac_store::write_json;
use twintac_work::{At, Progress, WorkError};

/// Recorded presses, and what logs say of temperatures.
#[derive(Clone, Debug)]
pub struct Recorded {
    /// The presses of all files.
    pub recording: Recording,
    /// Temperature and pressure of each taxel outside of presses; `[n_taxels]`.
    pub unloaded: Vec<UnloadedCourse>,
}

impl Recorded {
    /// Reads `presses.parquet` files and MCAP logs, also cut ones. Logs that were set aside, cut ones beside what was recovered of them,
    /// and presses in which the bench stopped are left out, and `progress` is told.
    ///
    /// # Errors
    /// A file that is neither, or cannot be read; recordings that do not belong together; none that is left.
    pub fn read(files: &[PathBuf], progress: &dyn Progress) -> Result<Self, WorkError> {
        let mut all: Option<Recording> = None;
        let mut unloaded: Vec<UnloadedCourse> = Vec::new();
        for file in to_read(files, progress)? {
            let next = if is_log(&file) {
                let log = Log::read(&file, progress)?;
                unloaded.extend(log.unloaded);
                log.recording
            } else {
                Recording::read_parquet(&file)?
            };
            match &mut all {
                None => all = Some(next),
                Some(all) => all.append(next).at(|| file.display().to_string())?,
            }
        }
        let recording = all.ok_or_else(|| {
            let problem = "every log given was set aside by `record`, as its press was not finished";
            WorkError::Input(problem.to_owned())
        })?;
        let courses = recording.taxels.iter().map(|taxel| {
            let of_taxel = unloaded.iter().filter(|course| course.taxel == *taxel);
            UnloadedCourse {
                taxel: taxel.clone(),
                readings: of_taxel
                    .flat_map(|course| course.readings.iter().copied())
                    .collect(),
            }
        });
        let unloaded = courses.collect();
        Ok(Self { recording, unloaded })
    }

    /// What the sensor does, as far as the presses tell.
    ///
    /// # Errors
    /// Presses of another sensor, or none.
    pub fn characterize(&self, sensor: &Sensor) -> Result<Characterization, WorkError> {
        Ok(characterize(
            &self.recording,
            &self.unloaded,
            sensor,
            &CharacterizeOptions::default(),
        )?)
    }

    /// Writes `report.html`, `datasheet.html` and `characterization.json` of what was found.
    ///
    /// # Errors
    /// A file that cannot be written.
    pub fn write(&self, found: &Characterization, sensor: &Sensor, folder: &Path) -> Result<(), WorkError> {
        write_pages(folder, found, &self.recording, sensor)?;
        Ok(write_json(&folder.join("characterization.json"), found)?)
    }
}

impl From<Recording> for Recorded {
    /// Presses without temperatures.
    fn from(recording: Recording) -> Self {
        let unloaded = recording.taxels.iter().map(|taxel| UnloadedCourse {
            taxel: taxel.clone(),
            readings: Vec::new(),
        });
        Self {
            unloaded: unloaded.collect(),
            recording,
        }
    }
}

/// The files to read: without logs that were set aside, and without cut ones beside what was recovered of them.
fn to_read(files: &[PathBuf], progress: &dyn Progress) -> Result<Vec<PathBuf>, WorkError> {
    let mut kept = Vec::new();
    for file in files {
        let ends_with = |end: &str| file.extension().is_some_and(|extension| extension == end);
        if !is_log(file) && !ends_with("parquet") {
            return Err(WorkError::Input(format!(
                "{} is no Parquet file and no MCAP log; `twintac import` makes Parquet files of others",
                file.display()
            )));
        }
        let name = file.file_name().unwrap_or_default().to_string_lossy();
        if is_log(file) && name.contains(".try-") {
            progress.note(&format!("{} was set aside and is left out", file.display()));
        } else if ends_with("partial") && files.contains(&file.with_extension("")) {
            progress.note(&format!("{} is there whole and is left out", file.display()));
        } else {
            kept.push(file.clone());
        }
    }
    Ok(kept)
}

fn is_log(file: &Path) -> bool {
    let name = file.to_string_lossy();
    name.ends_with(".mcap") || name.ends_with(".mcap.partial")
}

/// What a log tells.
struct Log {
    recording: Recording,
    /// Temperature and pressure of the taxels outside of presses.
    unloaded: Vec<UnloadedCourse>,
}

impl Log {
    /// Reads a log, without the press in which the bench stopped. What is odd about it is noted.
    fn read(file: &Path, progress: &dyn Progress) -> Result<Self, WorkError> {
        let reader = LogReader::open(file)?;
        let course = |taxel: &String| UnloadedCourse {
            taxel: taxel.clone(),
            readings: Vec::new(),
        };
        let mut unloaded: Vec<UnloadedCourse> = reader.description().taxels.iter().map(course).collect();
        let mut messages = reader.collect::<Result<Vec<_>, _>>()?;
        messages.sort_by_key(|message| message.bench_ns);
        let mut begun_ns = None;
        let mut unfinished_ns = None;
        for message in messages {
            match message.body {
                Body::Event(Event::PressBegun { .. }) => begun_ns = Some(message.bench_ns),
                Body::Event(Event::PressEnded { .. }) => begun_ns = None,
                Body::Event(Event::Stopped { .. }) => unfinished_ns = begun_ns,
                Body::Tactile(frame) if begun_ns.is_none() => {
                    for (course, taxel) in unloaded.iter_mut().zip(&frame.taxels) {
                        let reading = taxel.temperature_c.zip(taxel.pressure_pa);
                        let is_good = |(c, pa): &(f64, f64)| {
                            taxel.state == TaxelState::Good && c.is_finite() && pa.is_finite()
                        };
                        let good = reading.filter(is_good);
                        course.readings.extend(good.map(|(c, pa)| [c, pa / 1000.0]));
                    }
                }
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
                        "{}: press `{}` was not finished when the bench stopped, and is left out",
                        file.display(),
                        press.name
                    ));
                }
                is_finished
            });
        }
        Ok(Self { recording, unloaded })
    }
}
