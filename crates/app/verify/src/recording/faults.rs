//! Recordings with one fault each.

use std::collections::BTreeMap;
use std::path::Path;

use anyhow::{Result, ensure};
use serde::{Deserialize, Serialize};
use twintac_log::Event;

use super::lab_bench::{LabBench, Summary, WORK, read};
use crate::files::write_whole;

/// Bench time at which a fault begins, s. The gel is pressed by then.
const BEGINS_S: f64 = 2.5;

/// Name, fault as TOML, duration as TOML, and how a recording with the fault must end.
const FAULTS: [(&str, &str, Option<&str>, Ends); 20] = [
    (
        "a taxel is gone",
        "{ no_acknowledge = { channel = 2 } }",
        None,
        Ends::Notes("missing"),
    ),
    (
        "the switch is gone for 0.2 s",
        "{ no_acknowledge = {} }",
        Some("{ time_s = 0.2 }"),
        Ends::Marks("tactile"),
    ),
    (
        "the switch is gone",
        "{ no_acknowledge = {} }",
        None,
        Ends::Stops("tactile sensor"),
    ),
    (
        "a channel is shorted to ground",
        "{ short = { channel = 3 } }",
        None,
        Ends::Notes("isolated"),
    ),
    (
        "a barometer hangs the bus",
        "{ stuck_bus = { channel = 1 } }",
        None,
        Ends::Notes("isolated"),
    ),
    (
        "the switch hangs the bus",
        "{ stuck_bus = {} }",
        None,
        Ends::Marks("tactile"),
    ),
    (
        "the clock is stretched by 0.5 ms",
        "{ clock_stretch = { by_s = 0.0005 } }",
        None,
        Ends::Whole,
    ),
    (
        "the switch loses power for a moment",
        "\"switch_brown_out\"",
        None,
        Ends::Whole,
    ),
    (
        "a barometer loses power for a moment",
        "{ barometer_brown_out = { channel = 4 } }",
        None,
        Ends::Whole,
    ),
    (
        "a conversion never ends",
        "{ endless_conversion = { channel = 5 } }",
        None,
        Ends::Notes("stuck"),
    ),
    (
        "10 datagrams are lost",
        "\"lost_datagrams\"",
        Some("{ count = 10 }"),
        Ends::Marks("wrench"),
    ),
    (
        "all datagrams are lost",
        "\"lost_datagrams\"",
        None,
        Ends::Stops("force sensor"),
    ),
    (
        "10 datagrams are 20 ms late",
        "{ late_datagrams = { by_s = 0.02 } }",
        Some("{ count = 10 }"),
        Ends::Marks("wrench"),
    ),
    (
        "datagrams are doubled",
        "\"doubled_datagrams\"",
        None,
        Ends::Whole,
    ),
    (
        "10 datagrams are out of order",
        "\"reordered_datagrams\"",
        Some("{ count = 10 }"),
        Ends::Marks("wrench"),
    ),
    (
        "the force sensor saturates",
        "\"saturated_force\"",
        None,
        Ends::Stops("saturation"),
    ),
    (
        "the robot's connections are reset",
        "\"connection_reset\"",
        None,
        Ends::Stops("the robot"),
    ),
    (
        "the robot reports error 31",
        "{ robot_error = { code = 31 } }",
        None,
        Ends::Stops("the robot reports an error"),
    ),
    (
        "the robot does not answer for 0.1 s",
        "\"unanswered_requests\"",
        Some("{ time_s = 0.1 }"),
        Ends::Stops("robot's answers"),
    ),
    (
        "the robot does not answer",
        "\"unanswered_requests\"",
        None,
        Ends::Stops("robot's answers"),
    ),
];

/// How a recording must end.
#[derive(Clone, Copy)]
enum Ends {
    /// Stopped, by a cause that contains this text.
    Stops(&'static str),
    /// Recorded to the end, with a gap marked in this stream.
    Marks(&'static str),
    /// Recorded to the end, with a note that contains this text.
    Notes(&'static str),
    /// Recorded to the end. Such a fault may cost no reading; a lost one is marked.
    Whole,
}

/// The result of a recording with one fault.
#[derive(Serialize, Deserialize)]
pub(crate) struct Outcome {
    pub(crate) fault: String,
    pub(crate) summary: Summary,
    /// Number of marked gaps in each stream.
    pub(crate) gaps: BTreeMap<String, usize>,
    /// Other notes of the log.
    pub(crate) notes: Vec<String>,
    /// Whether the recording ended as required.
    pub(crate) is_as_it_must: bool,
}

impl Outcome {
    /// Whether it ended as required, and every lost reading is marked.
    pub(crate) fn is_sound(&self) -> bool {
        self.is_as_it_must && self.summary.lost_unmarked == 0
    }
}

pub(crate) fn run(bench: &LabBench) -> Result<Vec<Outcome>> {
    FAULTS
        .iter()
        .map(|(name, what, lasts, ends)| {
            let outcome = suffer(bench, name, what, *lasts, *ends)?;
            let summary = &outcome.summary;
            eprintln!(
                "{name}: {}, gaps {:?}",
                summary.stopped.as_deref().unwrap_or("goes on"),
                outcome.gaps
            );
            Ok(outcome)
        })
        .collect()
}

fn suffer(bench: &LabBench, name: &str, what: &str, lasts: Option<&str>, ends: Ends) -> Result<Outcome> {
    bench.clear()?;
    let mut text = format!("[[faults]]\nwhat = {what}\nbegins = {{ time_s = {BEGINS_S} }}\n");
    if let Some(lasts) = lasts {
        text += &format!("lasts = {lasts}\n");
    }
    let file = Path::new(WORK).join("faults.toml");
    write_whole(&file, text.as_bytes())?;
    let summary = bench.record(Some(&file))?;
    let (mut gaps, mut notes, mut frames) = (BTreeMap::new(), Vec::new(), 0);
    for log in bench.log_files()? {
        let reading = read(&log)?;
        frames += reading.frames;
        for event in reading.events {
            match event {
                Event::Gap { stream, .. } => {
                    let stream =
                        stream.map_or("all".to_owned(), |stream| format!("{stream:?}").to_lowercase());
                    *gaps.entry(stream).or_insert(0) += 1;
                }
                Event::Note { text } if !text.starts_with("first touch") => notes.push(text),
                _ => {}
            }
        }
    }
    ensure!(
        frames == summary.frames,
        "{name}: {frames} frames in the logs, {} counted",
        summary.frames
    );
    notes.dedup();
    let is_as_it_must = match (ends, &summary.stopped) {
        (Ends::Stops(says), Some(cause)) => cause.contains(says),
        (Ends::Marks(stream), None) => gaps.contains_key(stream),
        (Ends::Notes(says), None) => notes.iter().any(|note| note.contains(says)),
        (Ends::Whole, None) => true,
        _ => false,
    };
    Ok(Outcome {
        fault: name.to_owned(),
        summary,
        gaps,
        notes,
        is_as_it_must,
    })
}
