//! The digital twin: from a simulated gel to what the barometers would read.
//!
//! A recording is cut into [`Places`]; a [`DepthTableSource`](twintac_depth_table::DepthTableSource)
//! simulates each; [`fit_bench`] finds what is unknown
//! about the bench; [`pair()`] puts measured and simulated frames side by side on one clock ([`Warp`]); a
//! [`Split`] says which presses teach and which judge; [`train()`] makes a [`Twin`] of each [`Variant`];
//! [`metric`] says how wrong it is; and a [`Model`] keeps it in a folder.

pub mod baseline;
mod batch;
mod bench;
mod bench_fit;
mod bench_problem;
mod dtw;
mod error;
mod estimate;
mod evaluate;
mod gains;
mod golden;
mod memory;
pub mod metric;
mod model;
mod model_dir;
mod network;
mod normalization;
mod paired;
#[cfg(test)]
mod pipeline_test;
mod places;
mod recalibrate;
mod repeatability;
mod robust;
mod seed;
mod split;
#[cfg(test)]
mod synthetic;
mod train;
mod twin;
mod variant;

pub use baseline::StaticPolynomial;
pub use bench::{Bench, BenchSettings};
pub use bench_fit::fit_bench;
pub use dtw::{Warp, WarpSettings};
pub use error::DigitacError;
pub use estimate::Estimate;
pub use evaluate::{Evaluation, PressEvaluation, evaluate};
pub use gains::{Gains, TIME_CONSTANTS_S};
pub use metric::{Errors, Mean, Scale, Score, score};
pub use model::{Model, ModelRecord, Origin};
pub use normalization::Normalization;
pub use paired::{Features, PairSettings, PairedPress, features, pair};
pub use places::{PlaceSettings, Places};
pub use recalibrate::{Recalibration, recalibrate};
pub use repeatability::{Repeatability, repeatability};
pub use split::{Split, SplitSettings};
pub use train::{Epoch, Progress, TrainSettings, Trained, choose, train};
pub use twin::Twin;
pub use variant::Variant;
