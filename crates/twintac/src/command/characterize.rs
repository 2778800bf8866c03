//! `twintac characterize`: what a sensor does, from recorded presses.

use std::path::Path;

use anyhow::{Context, Result, ensure};
use twintac_characterize::{Options, UnloadedCourse, characterize, write_pages};
use twintac_log::{Body, Event, LogReader, ReadOptions, read_presses};
use twintac_recording::Recording;

use super::files::expand;
use crate::arguments::Characterize;
use crate::sensor_file::read_sensor;
use crate::stage::write_json;

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
    for file in expand(patterns)? {
        let is_log = file.extension().is_some_and(|extension| extension == "mcap");
        let next = if is_log {
            unloaded.extend(unloaded_course(&file)?);
            read_presses(&file, &ReadOptions::default())?.recording
        } else {
            Recording::read_parquet(&file)?
        };
        let Some(all) = &mut all else {
            all = Some(next);
            continue;
        };
        ensure!(
            next.sensor == all.sensor && next.taxels == all.taxels && next.provenance == all.provenance,
            "{} is of sensor `{}` ({}), the files before it of `{}` ({}); characterize each on its own",
            file.display(),
            next.sensor,
            next.provenance,
            all.sensor,
            all.provenance
        );
        for mut press in next.presses {
            let is_taken = |name: &str| all.presses.iter().any(|other| other.name == name);
            let numbered = (2..).map(|number| format!("{} ({number})", press.name));
            if is_taken(&press.name)
                && let Some(free) = numbered.into_iter().find(|name| !is_taken(name))
            {
                press.name = free;
            }
            all.presses.push(press);
        }
    }
    let recording = all.context("there are no recordings")?;
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

/// Temperature and pressure of the taxels of a log, outside its presses.
fn unloaded_course(file: &Path) -> Result<Vec<UnloadedCourse>> {
    let reader = LogReader::open(file)?;
    let mut courses: Vec<UnloadedCourse> = reader
        .description()
        .taxels
        .iter()
        .map(|taxel| UnloadedCourse {
            taxel: taxel.clone(),
            readings: Vec::new(),
        })
        .collect();
    let mut messages = reader.collect::<Result<Vec<_>, _>>()?;
    messages.sort_by_key(|message| message.bench_ns);
    let mut is_pressed = false;
    for message in messages {
        match message.body {
            Body::Event(Event::PressBegun { .. }) => is_pressed = true,
            Body::Event(Event::PressEnded { .. }) => is_pressed = false,
            Body::Tactile(frame) if !is_pressed => {
                for (course, taxel) in courses.iter_mut().zip(&frame.taxels) {
                    let reading = taxel.temperature_c.zip(taxel.pressure_pa);
                    let good = reading.filter(|_| taxel.state == twintac_log::TaxelState::Good);
                    course.readings.extend(good.map(|(c, pa)| [c, pa / 1000.0]));
                }
            }
            _ => {}
        }
    }
    Ok(courses)
}
