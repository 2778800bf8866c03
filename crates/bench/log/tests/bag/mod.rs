//! Bags that another program wrote, made here with the format's own library.

#![allow(clippy::unwrap_used, dead_code)] // helpers of several tests

use std::collections::BTreeMap;
use std::io::Cursor;
use std::path::{Path, PathBuf};

use mcap::records::MessageHeader;
use mcap::{Compression, WriteOptions, Writer};
use tempfile::TempDir;
use twintac_log::read_bag;
use twintac_recording::{Import, ImportSummary, Recording, RecordingError};

/// Start of the bags, ns since 1970.
pub(crate) const START_NS: u64 = 1_700_000_000_000_000_000;

pub(crate) const MS: u64 = 1_000_000;

pub(crate) const ARRAY: &str = "MultiArrayLayout layout\nfloat32[] data\n\
    ================================================================================\n\
    MSG: std_msgs/MultiArrayLayout\nMultiArrayDimension[] dim # of each\nuint32 data_offset\n\
    ================================================================================\n\
    MSG: std_msgs/MultiArrayDimension\nstring label\nuint32 size\nuint32 stride\n";

/// A definition with a header, as many messages have.
pub(crate) fn stamped(fields: &str) -> String {
    format!(
        "std_msgs/Header header\n{fields}\
         ===\nMSG: std_msgs/Header\nbuiltin_interfaces/Time stamp\nstring frame_id\n\
         ===\nMSG: builtin_interfaces/Time\nint32 sec\nuint32 nanosec\n\
         ===\nMSG: geometry_msgs/Vector3\nfloat64 x\nfloat64 y\nfloat64 z\n\
         ===\nMSG: geometry_msgs/Point\nfloat64 x\nfloat64 y\nfloat64 z\n\
         ===\nMSG: geometry_msgs/Quaternion\nfloat64 x 0\nfloat64 y 0\nfloat64 z 0\nfloat64 w 1\n\
         ===\nMSG: geometry_msgs/Wrench\nVector3 force\nVector3 torque\n\
         ===\nMSG: geometry_msgs/Pose\nPoint position\nQuaternion orientation\n\
         ===\nMSG: geometry_msgs/Transform\nVector3 translation\nQuaternion rotation\n"
    )
}

/// A message in CDR.
#[derive(Clone, Default)]
pub(crate) struct Cdr(Vec<u8>);

impl Cdr {
    fn put(mut self, bytes: &[u8]) -> Self {
        while !self.0.len().is_multiple_of(bytes.len()) {
            self.0.push(0);
        }
        self.0.extend(bytes);
        self
    }

    pub(crate) fn u32(self, number: u32) -> Self {
        self.put(&number.to_le_bytes())
    }

    pub(crate) fn i32(self, number: i32) -> Self {
        self.put(&number.to_le_bytes())
    }

    pub(crate) fn f32(self, number: f32) -> Self {
        self.put(&number.to_le_bytes())
    }

    pub(crate) fn f64s(self, numbers: &[f64]) -> Self {
        numbers
            .iter()
            .fold(self, |cdr, number| cdr.put(&number.to_le_bytes()))
    }

    pub(crate) fn text(self, text: &str) -> Self {
        let mut cdr = self.u32(text.len() as u32 + 1);
        cdr.0.extend(text.as_bytes());
        cdr.0.push(0);
        cdr
    }

    /// A header with a stamp.
    pub(crate) fn header(self, stamp_ns: u64) -> Self {
        let (seconds, rest) = (stamp_ns / 1_000_000_000, stamp_ns % 1_000_000_000);
        self.i32(seconds as i32).u32(rest as u32).text("base")
    }

    /// The layout of an array of one dimension.
    pub(crate) fn layout(self, length: u32) -> Self {
        self.u32(1).text("taxels").u32(length).u32(length).u32(0)
    }

    pub(crate) fn floats(self, numbers: &[f32]) -> Self {
        let cdr = self.layout(numbers.len() as u32).u32(numbers.len() as u32);
        numbers.iter().fold(cdr, |cdr, number| cdr.f32(*number))
    }

    fn message(self) -> Vec<u8> {
        [vec![0, 1, 0, 3], self.0].concat() // some writers state how many padding bytes they added
    }
}

/// A bag that is being made.
pub(crate) struct Made {
    writer: Writer<Cursor<Vec<u8>>>,
    channels: BTreeMap<String, (u16, u32)>,
}

impl Made {
    pub(crate) fn new(compression: Option<Compression>) -> Self {
        Self::with(WriteOptions::new().compression(compression))
    }

    pub(crate) fn with(options: WriteOptions) -> Self {
        let options = options.profile("ros2").chunk_size(Some(4096));
        Self {
            writer: options.create(Cursor::default()).unwrap(),
            channels: BTreeMap::new(),
        }
    }

    pub(crate) fn topic(&mut self, topic: &str, kind: &str, definition: &str) {
        self.topic_in(topic, kind, definition, "ros2msg", "cdr");
    }

    pub(crate) fn topic_in(
        &mut self,
        topic: &str,
        kind: &str,
        definition: &str,
        schemas: &str,
        messages: &str,
    ) {
        let schema = self
            .writer
            .add_schema(kind, schemas, definition.as_bytes())
            .unwrap();
        let quality = BTreeMap::from([("offered_qos_profiles".to_owned(), String::new())]);
        let id = self
            .writer
            .add_channel(schema, topic, messages, &quality)
            .unwrap();
        self.channels.insert(topic.to_owned(), (id, 0));
    }

    /// A message that is recorded at a time since the start.
    pub(crate) fn add(&mut self, topic: &str, after_ns: u64, cdr: Cdr) {
        let (channel_id, sequence) = self.channels.get_mut(topic).unwrap();
        *sequence += 1;
        let header = MessageHeader {
            channel_id: *channel_id,
            sequence: *sequence,
            log_time: START_NS + after_ns,
            publish_time: START_NS + after_ns,
        };
        self.writer
            .write_to_known_channel(&header, &cdr.message())
            .unwrap();
    }

    pub(crate) fn bytes(mut self) -> Vec<u8> {
        self.writer.finish().unwrap();
        self.writer.into_inner().into_inner()
    }

    /// The bag as a file in its own folder.
    pub(crate) fn file(self) -> InFolder {
        InFolder::new("bag.mcap", &self.bytes())
    }
}

/// A file in its own folder.
pub(crate) struct InFolder {
    folder: TempDir,
    name: String,
}

impl InFolder {
    pub(crate) fn new(name: &str, bytes: &[u8]) -> Self {
        let folder = tempfile::tempdir().unwrap();
        std::fs::write(folder.path().join(name), bytes).unwrap();
        Self {
            folder,
            name: name.to_owned(),
        }
    }

    pub(crate) fn path(&self) -> PathBuf {
        self.folder.path().join(&self.name)
    }

    /// Imports it with a description.
    pub(crate) fn import(&self, description: &str) -> Result<(Recording, ImportSummary), RecordingError> {
        import(&self.path(), description)
    }

    /// The error of importing it.
    pub(crate) fn problem(&self, description: &str) -> String {
        self.import(description).unwrap_err().to_string()
    }
}

pub(crate) fn import(path: &Path, description: &str) -> Result<(Recording, ImportSummary), RecordingError> {
    Import::parse("bench.toml", description)?
        .with_bags(read_bag)
        .read_csv(path)
}

/// Fails unless a text contains all the words.
pub(crate) fn has(text: &str, words: &[&str]) {
    for word in words {
        assert!(text.contains(word), "no `{word}` in: {text}");
    }
}
