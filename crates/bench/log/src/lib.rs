//! Records the data streams of a test setup while it runs, and reads them back as presses.
//!
//! A log is an MCAP file with ROS 2 messages, which Foxglove, Rerun and `ros2 bag` open. It holds
//! tactile frames (counts, and pressures in Pa), wrenches (N and N mm), robot poses (mm) and
//! events. Each message has a time of the bench clock, beside the time of its source's own clock.
//! The file is flushed at least every half second: a log that ended with a power cut can be read up
//! to the last flush, and [`recover`] completes it.
//!
//! - [`Recorder`] writes a log on a separate thread.
//! - [`LogReader`] reads a log as an iterator over [`Message`]s.
//! - [`read_presses`] makes a [`Recording`](twintac_recording::Recording) of a log, which can be
//!   stored as Parquet and used for training.
//! - [`read_bag`] reads ROS 2 recordings of others, for an import description. [`export_bag`]
//!   writes a log as a ROS 2 bag with standard messages only, [`export_frames`] its frames as a
//!   Parquet table.
//!
//! ```
//! # use std::path::Path;
//! # use twintac_log::{Body, Description, Event, LogError, LogReader, Message, ReadOptions, Recorder, read_presses};
//! # fn record(path: &Path, description: &Description) -> Result<(), LogError> {
//! let recorder = Recorder::create(path, description)?;
//! let sender = recorder.sender(); // threads have copies
//! let text = "the gel was changed".to_owned();
//! sender.send(Message::at_s(0.25, Body::Event(Event::Note { text })))?;
//! recorder.finish()?;
//!
//! for message in LogReader::open(path)? {
//!     println!("{:?}", message?);
//! }
//! let recording = read_presses(path, &ReadOptions::default())?.recording;
//! # let _ = recording;
//! # Ok(())
//! # }
//! ```
//!
//! # How it works
//!
//! ```text
//! message, event, description   what is recorded, in the units of this project
//! ros, cdr     the same as ROS 2 messages: definitions, topics, bytes
//! mcap         the container: records, chunks, the linear scan
//! writer       messages in, a file out; recorder: the same on a separate thread, behind a bounded
//!              queue
//! reader       messages out of a file; channels: which messages are missing
//! recover, press, table   a complete file from a cut one; presses; tables of frames
//! bag          recordings of others: any message whose definition is in the file, as columns
//! ```
//!
//! **Messages.** Each reading is written twice: completely, in a message type of this project,
//! which is what is read back; and in standard messages, which every viewer shows. Their
//! definitions are in the file.
//!
//! **Chunks.** A chunk is one write and one sync, and covers at most half a second of the bench
//! clock. The description of the log is written before the first chunk. A file that was cut at any
//! byte is therefore a log up to its last chunk, and the same linear scan reads complete and cut
//! files. A file gets its final name only when it is complete.
//!
//! **Losses.** Every loss is reported. A message that the queue does not accept is an error for its
//! sender and a gap in the file. A disk that fails ends the log with an error. Damage costs the
//! chunk in which it is, and is read as a gap: after a record that is not valid, the scan searches
//! for the next chunk. Losses that no chunk shows are found by the checksums of data and summary,
//! the numbers of messages, and the counts in the summary (module `channels`). A test flips every
//! bit of a small log. Nothing is interpolated across gaps.
//!
//! **Bags of others.** They are read by the same scan, which also unpacks chunks of zstd and LZ4.
//! The module `bag` knows no message type: it reads the definitions in the file, so it also reads
//! messages that only another laboratory uses. An import description says what the columns mean:
//! `crates/sensor/recording` puts topics onto one clock (`import/bag`) and then reads the table
//! like one of a CSV file. That crate knows no file format: `Import::with_bags` takes the function
//! that reads one.
//!
//! **Own MCAP writer.** The container is written here and not by the crate `mcap` (tests read with
//! that crate), for three reasons. The order of records in the summary of `mcap` differs from run
//! to run. `mcap` seeks back into chunks that are already written. It brings twenty further crates.
//!
//! **Own CDR.** The encoding of ROS 2 messages (CDR, module `cdr`, about 200 lines) is written here
//! too, field by field. The crate `cdr-encoding` works through serde types. That would need a
//! second set of structures, which must be kept consistent with the message definitions.
//!
//! # What it does not depend on
//!
//! The crate knows no device and no protocol of a device, no solver and no training: it takes
//! messages from whoever has them.

mod accepts;
mod bag;
mod cdr;
mod channels;
mod description;
mod error;
mod event;
mod mcap;
mod message;
mod press;
mod reader;
mod recorder;
mod recover;
mod ros;
mod sink;
mod stream;
mod table;
mod writer;

pub use bag::read_bag;
pub use description::{CountTransfer, Description};
pub use error::LogError;
pub use event::Event;
pub use message::{Body, Message, PoseReading, TactileFrame, TaxelReading, WrenchReading};
pub use phystac::TaxelState;
pub use press::{ReadBack, ReadOptions, presses, read_presses};
pub use reader::{Ending, LogReader};
pub use recorder::{LogSender, Recorded, Recorder};
pub use recover::{Recovered, recover};
pub use ros::TopicNames;
pub use sink::{LogFile, Sink};
pub use stream::Stream;
pub use table::{Exported, export_bag, export_frames};
pub use writer::LogWriter;
