//! ATI Net F/T: a force/torque sensor that streams records by UDP (RDT, raw data transfer) and
//! gives its configuration by HTTP.

mod client;
mod codec;
mod configuration;
mod page;
mod sequence;
mod status;

pub use client::{BiasTolerance, Client};
pub use codec::{
    Command, PORT, RECORD_BYTES, REQUEST_BYTES, Record, Request, decode_records, encode_records,
};
pub use configuration::{Configuration, PAGE};
pub use sequence::{Arrival, SequenceReport, SequenceTracker, TICKS_PER_SECOND, Tracked};
pub use status::{Health, Status};
