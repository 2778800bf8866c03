//! Export of a log: its tactile frames as a table, and all of it as a bag of standard messages.

use std::path::Path;

use twintac_recording::{FrameTable, TaxelCell};

use crate::{Body, Ending, Event, LogError, LogFile, LogReader, LogWriter, Stream, TaxelReading, TopicNames};

/// Result of an export.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Exported {
    /// Frames in the table or the bag.
    pub frames: u64,
    /// Gaps in them: those that the log marks, and those from damage.
    pub gaps: u64,
    /// Time of the last frame on the bench clock, s; 0 without frames.
    pub last_s: f64,
    /// How the log ends.
    pub ending: Ending,
}

/// Writes the tactile frames of a log, complete or cut, as a Parquet table with one row per frame.
/// It needs little memory.
///
/// # Errors
/// A log that cannot be read; a table that cannot be written.
pub fn export_frames(log: &Path, table: &Path) -> Result<Exported, LogError> {
    let mut reader = LogReader::open(log)?;
    let about = reader.description();
    let mut table = FrameTable::create(table, &about.sensor, about.provenance, &about.taxels)?;
    let (mut gaps, mut last_s, mut is_gap) = (0, 0.0, false);
    for message in &mut reader {
        let message = message?;
        match &message.body {
            Body::Event(Event::Gap { stream, .. }) => {
                is_gap |= matches!(stream, None | Some(Stream::Tactile));
            }
            Body::Tactile(frame) => {
                last_s = message.bench_ns as f64 * 1e-9;
                gaps += u64::from(is_gap);
                table.push(last_s, std::mem::take(&mut is_gap), frame.taxels.iter().map(cell))?;
            }
            _ => {}
        }
    }
    Ok(Exported {
        frames: table.finish()?,
        gaps: gaps + u64::from(is_gap), // a gap after the last frame
        last_s,
        ending: reader.ending().unwrap_or(Ending::Cut),
    })
}

/// Writes a log, complete or cut, as a ROS 2 bag with standard messages only (MCAP). It needs
/// little memory. The bag has the pressures of all taxels, Pa (`std_msgs/msg/Float32MultiArray`);
/// for each taxel pressure (`sensor_msgs/msg/FluidPressure`) and temperature
/// (`sensor_msgs/msg/Temperature`); the wrench (`geometry_msgs/msg/WrenchStamped`, N and N m,
/// without subtracting a tare); the robot's pose (`geometry_msgs/msg/PoseStamped`, m); and events
/// (`std_msgs/msg/String`).
///
/// # Errors
/// A log that cannot be read; two topics with the same name; a bag that exists already or cannot be
/// written.
pub fn export_bag(log: &Path, bag: &Path, names: &TopicNames) -> Result<Exported, LogError> {
    let mut reader = LogReader::open(log)?;
    let mut writer = LogWriter::standard(LogFile::remake(bag)?, reader.description(), names)?;
    let (mut frames, mut gaps, mut last_s) = (0, 0, 0.0);
    for message in &mut reader {
        let message = message?;
        match &message.body {
            Body::Event(Event::Gap { .. }) => gaps += 1,
            Body::Tactile(_) => (frames, last_s) = (frames + 1, message.bench_ns as f64 * 1e-9),
            _ => {}
        }
        writer.write(&message)?;
    }
    writer.finish()?;
    Ok(Exported {
        frames,
        gaps,
        last_s,
        ending: reader.ending().unwrap_or(Ending::Cut),
    })
}

fn cell(taxel: &TaxelReading) -> TaxelCell {
    TaxelCell {
        absolute_kpa: taxel.pressure_pa.filter(|pa| pa.is_finite()).map(|pa| 1e-3 * pa),
        counts: taxel.counts,
        temperature_c: taxel.temperature_c.filter(|c| c.is_finite()),
        fault: taxel.state.fault(),
    }
}
