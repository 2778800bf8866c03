//! Each fault in turn.

use std::collections::BTreeMap;
use std::path::Path;

use anyhow::{Result, ensure};
use serde::{Deserialize, Serialize};
use twintac_log::Event;

use super::{LabBench, Summary, WORK, read};
use crate::files::write_whole;

/// Time of the bench at which a fault begins, s: the gel is pressed by then.
const BEGINS_S: f64 = 2.5;

/// Name, what as TOML, and how long it lasts, as TOML.
const FAULTS: [(&str, &str, Option<&str>); 20] = [
    ("a taxel is gone", "{ no_acknowledge = { channel = 2 } }", None),
    (
        "the switch is gone for 0.2 s",
        "{ no_acknowledge = {} }",
        Some("{ time_s = 0.2 }"),
    ),
    ("the switch is gone", "{ no_acknowledge = {} }", None),
    (
        "a channel is shorted to ground",
        "{ short = { channel = 3 } }",
        None,
    ),
    (
        "a barometer hangs the bus",
        "{ stuck_bus = { channel = 1 } }",
        None,
    ),
    ("the switch hangs the bus", "{ stuck_bus = {} }", None),
    (
        "the clock is stretched by 0.5 ms",
        "{ clock_stretch = { by_s = 0.0005 } }",
        None,
    ),
    (
        "the switch loses power for a moment",
        "\"switch_brown_out\"",
        None,
    ),
    (
        "a barometer loses power for a moment",
        "{ barometer_brown_out = { channel = 4 } }",
        None,
    ),
    (
        "a conversion never ends",
        "{ endless_conversion = { channel = 5 } }",
        None,
    ),
    (
        "10 datagrams are lost",
        "\"lost_datagrams\"",
        Some("{ count = 10 }"),
    ),
    ("all datagrams are lost", "\"lost_datagrams\"", None),
    (
        "10 datagrams are 20 ms late",
        "{ late_datagrams = { by_s = 0.02 } }",
        Some("{ count = 10 }"),
    ),
    ("datagrams are doubled", "\"doubled_datagrams\"", None),
    (
        "10 datagrams are out of order",
        "\"reordered_datagrams\"",
        Some("{ count = 10 }"),
    ),
    ("the force sensor saturates", "\"saturated_force\"", None),
    ("the robot's connections are reset", "\"connection_reset\"", None),
    (
        "the robot reports error 31",
        "{ robot_error = { code = 31 } }",
        None,
    ),
    (
        "the robot does not answer for 0.1 s",
        "\"unanswered_requests\"",
        Some("{ time_s = 0.1 }"),
    ),
    ("the robot does not answer", "\"unanswered_requests\"", None),
];

/// What became of a recording with one fault.
#[derive(Serialize, Deserialize)]
pub(crate) struct Outcome {
    pub(crate) fault: String,
    pub(crate) summary: Summary,
    /// Marks of gaps, a stream each.
    pub(crate) gaps: BTreeMap<String, usize>,
    /// What the log notes besides.
    pub(crate) notes: Vec<String>,
}

impl Outcome {
    /// Nothing is lost in silence, and what goes on says what was wrong unless nothing was.
    pub(crate) fn is_sound(&self) -> bool {
        self.summary.lost_unmarked == 0
    }
}

pub(crate) fn run(bench: &LabBench) -> Result<Vec<Outcome>> {
    FAULTS
        .iter()
        .map(|(name, what, lasts)| {
            let outcome = suffer(bench, name, what, *lasts)?;
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

fn suffer(bench: &LabBench, name: &str, what: &str, lasts: Option<&str>) -> Result<Outcome> {
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
    Ok(Outcome {
        fault: name.to_owned(),
        summary,
        gaps,
        notes,
    })
}
