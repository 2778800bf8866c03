//! A log's presses, as a recording.

mod baseline;
mod collect;
mod frames;
mod options;
mod track;

use std::io::Read;
use std::path::Path;

use twintac_recording::Recording;

use crate::{Ending, LogError, LogReader};
use collect::Collected;

pub use options::ReadOptions;

/// What a log gave.
#[derive(Clone, Debug, PartialEq)]
pub struct ReadBack {
    /// The presses.
    pub recording: Recording,
    /// How the log ends.
    pub ending: Ending,
    /// What a person should know of it: damage, presses left out or not ended, taxels without a baseline or without readings, gaps.
    pub remarks: Vec<String>,
}

/// Reads the presses of a log, whole or cut, at the times of its tactile frames (when they were triggered).
///
/// - Force and pose are interpolated linearly (rotations along the shortest arc). Where they cannot be, next to a gap or before
///   the first reading, the frame's readings are all invalid and force and pose those of the nearest reading.
/// - `force_n` is the wrench, less the last tare, along [`Description::force_axis`](crate::Description::force_axis); there is
///   none in a log without wrenches.
/// - `taxels_raw` are counts, or Pa of a taxel that does not count. `taxels_kpa` are above the mean of the last second before
///   the press, as far as no other press was on; a taxel without a value then is invalid for the whole press. What is missing is
///   NaN and invalid.
/// - Memory grows with the log: a reading takes about 100 bytes.
/// - A press that was not ended goes on until the next one begins or the log ends. A name that is there twice gets a number.
///
/// # Errors
/// A file that cannot be read or is no log; presses without any robot pose.
pub fn read_presses(path: &Path, options: &ReadOptions) -> Result<ReadBack, LogError> {
    let name = path.file_name().unwrap_or_default().to_string_lossy();
    presses(LogReader::open(path)?, &name, options)
}

/// As [`read_presses`], from a reader that was opened; `name` is the file's name without folders.
///
/// # Errors
/// As [`read_presses`].
pub fn presses<R: Read>(
    mut reader: LogReader<R>,
    name: &str,
    options: &ReadOptions,
) -> Result<ReadBack, LogError> {
    let collected = Collected::of(&mut reader, options)?;
    let ending = reader.ending().unwrap_or(Ending::Cut);
    if collected.poses.is_empty() && !collected.spans.is_empty() {
        return Err(LogError::NoPoses {
            file: reader.file().to_owned(),
        });
    }
    let description = reader.description();
    let mut remarks = collected.remarks.clone();
    match ending {
        Ending::Whole => {}
        Ending::Damaged => remarks.push(
            "the log is damaged: its bytes have changed since it was written; where no gap says what is missing, what it says of the sensor or the \
             bench may be wrong"
                .to_owned(),
        ),
        Ending::Cut => remarks.push("the log was cut: it has what was flushed before".to_owned()),
    }
    let mut presses = Vec::new();
    for place in 0..collected.spans.len() {
        presses.extend(frames::press(
            &collected,
            description,
            place,
            name,
            options,
            &mut remarks,
        ));
    }
    let recording = Recording {
        sensor: description.sensor.clone(),
        provenance: description.provenance,
        taxels: description.taxels.clone(),
        presses,
    };
    recording.check()?;
    Ok(ReadBack {
        recording,
        ending,
        remarks,
    })
}
