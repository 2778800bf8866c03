//! ROS 2 recordings of others as columns. An import description says what the columns mean.

mod definition;
mod fields;
mod first_bytes;
mod topic;

use std::collections::BTreeMap;
use std::fs::File;
use std::io::{BufReader, Read};
use std::path::Path;

use twintac_recording::{Bag, Provenance, RecordingError};

use crate::mcap::{Found, Scanner};
use crate::writer::{DESCRIPTION, EXPORTED};
use first_bytes::{Is, look};
use topic::{Topic, by_topic};

/// Reads a ROS 2 bag (MCAP, messages in CDR with definitions `ros2msg`, chunks with zstd, LZ4 or
/// without compression), complete or cut, for
/// [`Import::with_bags`](twintac_recording::Import::with_bags). `columns` are `/topic:field`. A
/// field is a path such as `wrench.force.z` or `data.0`, or the end of a path, such as `force.z`,
/// if only one number has it. The file is read once, and memory grows with the requested columns.
///
/// `None` if the file is no recording of ROS.
///
/// # Errors
/// [`RecordingError::Bag`]: a recording in another container, or with another compression.
/// [`RecordingError::Read`].
#[must_use]
pub fn read_bag(path: &Path, columns: &[&str]) -> Option<Result<Bag, RecordingError>> {
    let file = path.display().to_string();
    match look(path) {
        Is::NoBag => None,
        Is::Other(problem) => Some(Err(RecordingError::Bag {
            file,
            problem: problem.to_owned(),
        })),
        Is::Mcap => Some(
            File::open(path)
                .map_err(|source| unread(&file, source))
                .and_then(|source| bag(BufReader::new(source), &file, columns)),
        ),
    }
}

fn bag(source: impl Read, file: &str, columns: &[&str]) -> Result<Bag, RecordingError> {
    let fields = by_topic(columns);
    let mut topics: Vec<Topic> = Vec::new();
    let mut places = BTreeMap::new();
    let (mut provenance, mut notes, mut n_damaged) = (None, Vec::new(), 0_u64);
    let refused = |problem: String| RecordingError::Bag {
        file: file.to_owned(),
        problem,
    };
    let mut scanner = Scanner::open(source)
        .map_err(|source| unread(file, source))?
        .ok_or_else(|| refused("does not start as an MCAP file".to_owned()))?;
    loop {
        match scanner.next().map_err(|source| unread(file, source))? {
            Found::Channel {
                id,
                topic,
                encoding,
                schema,
            } => {
                let name = format!("/{}", topic.trim_start_matches('/'));
                let is_same = |known: &Topic| known.read.name == name && known.read.kind == schema.name;
                let place = topics.iter().position(is_same).unwrap_or_else(|| {
                    let fields = fields.get(&*name).map(Vec::as_slice);
                    topics.push(Topic::new(&name, &encoding, &schema, fields));
                    topics.len() - 1
                });
                places.insert(id, place);
            }
            Found::Message {
                channel,
                time_ns,
                data,
                ..
            } => {
                if let Some(place) = places.get(&channel) {
                    topics[*place].push(time_ns, data);
                }
            }
            Found::Metadata { name, map } if name == DESCRIPTION || name == EXPORTED => {
                let said = map.get("provenance");
                provenance = said.and_then(|said| serde_json::from_str::<Provenance>(said).ok());
            }
            Found::Metadata { .. } => {}
            Found::Damage => n_damaged += 1,
            Found::Compressed(how) => {
                return Err(refused(format!(
                    "is compressed with `{how}`, expected zstd, lz4 or none; `mcap decompress` undoes that"
                )));
            }
            Found::End => break,
            Found::Cut => {
                notes.push("is truncated; it is read up to that point".to_owned());
                break;
            }
        }
    }
    if n_damaged > 0 {
        notes.push(format!(
            "is damaged in {n_damaged} places; only the undamaged messages are read"
        ));
    }
    let mut bag = Bag {
        topics: Vec::new(),
        provenance,
        notes,
    };
    for topic in topics {
        let (topic, note) = topic.finish();
        bag.topics.push(topic);
        bag.notes.extend(note);
    }
    Ok(bag)
}

fn unread(file: &str, source: std::io::Error) -> RecordingError {
    RecordingError::Read {
        file: file.to_owned(),
        source,
    }
}
