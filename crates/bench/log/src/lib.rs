//! Records what a bench streams, as it happens, and reads it back as presses.
//!
//! A log is an MCAP file with ROS 2 messages, which Foxglove, Rerun and `ros2 bag` open. It holds tactile frames, wrenches, robot poses
//! and events. Each message has a time of the bench's clock, beside the time of its source's own clock. The file is flushed at least every
//! second: a log that a power cut ended can be read up to the last flush, and [`recover`] completes it. [`Recorder`] writes a log on a thread
//! of its own, [`LogReader`] reads it, and [`read_presses`] makes a [`Recording`](twintac_recording::Recording) of it, which can be
//! stored as Parquet and learned from. [`read_bag`] reads the ROS 2 recordings of others, for an import description.
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
