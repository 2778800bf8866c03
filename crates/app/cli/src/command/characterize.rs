//! `twintac characterize`: what a sensor does, from recorded presses.

use std::path::{Path, PathBuf};

use anyhow::{Context, Result, ensure};
use twintac_characterize::{Options, UnloadedCourse, characterize, write_pages};
use twintac_log::{Body, Event, LogReader, ReadBack, ReadOptions, TaxelState, read_presses};
use twintac_recording::Recording;

use super::files::expand;
use crate::arguments::Characterize;
use twintac_run::cache::write_json;
use twintac_run::progress::say;
use twintac_run::sensor_file::read_sensor;

/// Characterizes, and prints or writes what was found.
pub(crate) fn run(arguments: &Characterize) -> Result<()> {
    let sensor = read_sensor(&arguments.sensor)?.sensor;
    let (recording, unloaded) = read(&arguments.recordings)?;
    let found = characterize(&recording, &unloaded, &sensor, &Options::default())?;
    if let Some(folder) = &arguments.out {
        write_pages(folder, &found, &recording, &sensor)?;
        write_json(&folder.join("characterization.json"), &found)?;
    }
    if arguments.json {
        return super::print(&serde_json::to_string_pretty(&found)?);
    }
    for [name, value, condition] in found.rows(&sensor) {
        super::print(&format!("{name:<26} {value:<28} {condition}"))?;
    }
    if let Some(folder) = &arguments.out {
        super::print(&format!("report  {}", folder.join("report.html").display()))?;
    }
    Ok(())
}

/// The presses of all files as one recording, and what logs say of temperatures.
fn read(patterns: &[String]) -> Result<(Recording, Vec<UnloadedCourse>)> {
    let mut all: Option<Recording> = None;
    let mut unloaded: Vec<UnloadedCourse> = Vec::new();
    for file in recorded(patterns)? {
        let next = if is_log(&file) {
            let log = Log::read(&file)?;
            unloaded.extend(log.unloaded);
            log.recording
        } else {
            Recording::read_parquet(&file)?
        };
        match &mut all {
            None => all = Some(next),
            Some(all) => all.append(next).with_context(|| file.display().to_string())?,
        }
    }
    let recording =
        all.context("every log given was set aside by `record`, as its press was not finished")?;
    let courses = recording.taxels.iter().map(|taxel| {
        let of_taxel = unloaded.iter().filter(|course| course.taxel == *taxel);
        UnloadedCourse {
            taxel: taxel.clone(),
            readings: of_taxel
                .flat_map(|course| course.readings.iter().copied())
                .collect(),
        }
    });
    let courses = courses.collect();
    Ok((recording, courses))
}

/// The files to read: without logs that `record` set aside, and without cut ones beside what was recovered of them.
fn recorded(patterns: &[String]) -> Result<Vec<PathBuf>> {
    let files = expand(patterns)?;
    let mut kept = Vec::new();
    for file in &files {
        let ends_with = |end: &str| file.extension().is_some_and(|extension| extension == end);
        ensure!(
            is_log(file) || ends_with("parquet"),
            "{} is no Parquet file and no MCAP log; `twintac import` makes Parquet files of others",
            file.display()
        );
        let name = file.file_name().unwrap_or_default().to_string_lossy();
        if is_log(file) && name.contains(".try-") {
            say(&format!("{} was set aside and is left out", file.display()));
        } else if ends_with("partial") && files.contains(&file.with_extension("")) {
            say(&format!("{} is there whole and is left out", file.display()));
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
    /// Reads a log, without the press in which the bench stopped. What is odd about it goes to standard error.
    fn read(file: &Path) -> Result<Self> {
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
                        let good = reading.filter(|_| taxel.state == TaxelState::Good);
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
            say(&format!("{}: {remark}", file.display()));
        }
        if let Some(unfinished_ns) = unfinished_ns {
            recording.presses.retain(|press| {
                let is_finished = press.time_s[0] < unfinished_ns as f64 * 1e-9;
                if !is_finished {
                    say(&format!(
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
