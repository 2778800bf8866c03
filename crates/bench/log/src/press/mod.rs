//! The presses of a log as a recording.

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

/// The result of reading a log.
#[derive(Clone, Debug, PartialEq)]
pub struct ReadBack {
    /// The presses.
    pub recording: Recording,
    /// How the log ends.
    pub ending: Ending,
    /// Remarks for people: damage, presses left out or not ended, taxels without a baseline or
    /// without readings, gaps.
    pub remarks: Vec<String>,
}

/// Reads the presses of a log, complete or cut, at the times of its tactile frames (when they were
/// triggered).
///
/// - Force and pose are interpolated linearly (rotations along the shortest arc). Where this is not
///   possible, next to a gap or before the first reading, all readings of the frame are invalid,
///   and force and pose are those of the nearest reading.
/// - `force_n` is the wrench after subtracting the last tare, along
///   [`Description::force_axis`](crate::Description::force_axis). A log without wrenches has none.
/// - `taxels_raw` are counts, or Pa for a taxel without counts. `taxels_kpa` are relative to the
///   mean of the last second before the press, without the times of other presses. A taxel without
///   a value in this second is invalid for the whole press. Missing values are NaN and invalid.
/// - Memory grows with the log: a reading takes about 100 bytes.
/// - A press that was not ended lasts until the next one begins or the log ends. If a name occurs
///   twice, the second one gets a number.
///
/// # Errors
/// A file that cannot be read or is no log; presses without any robot pose.
pub fn read_presses(path: &Path, options: &ReadOptions) -> Result<ReadBack, LogError> {
    let name = path.file_name().unwrap_or_default().to_string_lossy();
    presses(LogReader::open(path)?, &name, options)
}

/// As [`read_presses`], from an open reader. `name` is the file's name without folders.
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
            "the log is damaged: its bytes have changed since it was written; where no gap is marked, its data of the sensor or the \
             test setup may be wrong"
                .to_owned(),
        ),
        Ending::Cut => remarks.push("the log is truncated: it has what was flushed before".to_owned()),
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
