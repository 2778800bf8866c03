//! Training on presses.

mod batch;
mod frames;
mod train;

pub(crate) use frames::{Frames, TaughtFrame};
pub(crate) use train::{Course, train};
pub use train::{REPORT_STEPS, TrainProgress, TrainSettings};
