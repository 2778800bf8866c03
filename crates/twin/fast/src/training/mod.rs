//! Training on presses.

mod batch;
mod frames;
mod train;

pub(crate) use frames::{Frames, TrainingFrame};
pub(crate) use train::{Course, train};
pub use train::{REPORT_STEPS, TrainProgress, TrainSettings};
