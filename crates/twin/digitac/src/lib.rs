//! The digital twin: from a simulated gel to what the barometers would read.
//!
//! A recording is cut into [`Places`]; a [`DepthTableSource`](twintac_depth_table::DepthTableSource)
//! simulates each; [`fit_bench`] finds what is unknown
//! about the bench; [`pair()`] puts measured and simulated frames side by side on one clock ([`Warp`]); a
//! [`Split`] divides presses into training, validation and test; [`train()`] makes a [`Twin`] of each [`Variant`];
//! [`evaluate()`] computes its errors; and a [`Model`] keeps it in a folder. A twin in use is a [`TwinState`], or a [`TwinAtPlace`]: stepped frame
//! by frame. [`predict()`] takes it along planned presses. [`WithoutMemory`] goes the other way, from readings to those of a gel without memory.
//!
//! *Memory* means that a reading depends on earlier frames: beside the elastic reading it has overstresses, each of which follows every
//! change of the elastic reading and fades with a time constant of its own (quasi-linear viscoelasticity). Each room, as the folders of this
//! crate are called, says at its front what it does; `numerics` and `features` come first, then `bench_fit`, `alignment`, `network`,
//! `prediction`, `evaluation`, `adaptation`, `training`, `cross_validation` and `model_folder`.

mod adaptation;
mod alignment;
mod bench_fit;
mod certainty;
mod cross_validation;
mod error;
mod evaluation;
mod features;
mod model_folder;
#[cfg(test)]
mod model_test;
mod network;
mod numerics;
mod physical_fit;
#[cfg(test)]
mod pipeline_test;
mod prediction;
mod seed;
#[cfg(test)]
mod settings_test;
#[cfg(test)]
mod synthetic;
mod training;

pub use adaptation::{Adaptation, Adapted, NewSensor, adapt, choose_presses};
pub use alignment::{PairSettings, PairedPress, Warp, WarpSettings, pair};
pub use bench_fit::{
    BenchEstimate, BenchSettings, Estimate, PlaceSettings, Places, PortCorrection, PortEstimate,
    SmoothFactor, Taxels, features, fit_bench, refine_bench,
};
pub use certainty::{
    Certainty, CertaintyScore, Contact, Lessons, PressCertainty, area_under_curve, calibrate, score_certainty,
};
pub use cross_validation::{Bench, Judgement, ToldApart, judge};
pub use error::DigitacError;
pub use evaluation::{
    Baselines, Errors, Evaluation, Mean, PressEvaluation, Recalibration, Repeatability, Scale, Score,
    evaluate, recalibrate, repeatability,
};
pub use features::{Features, Gains};
pub use model_folder::{Model, ModelRecord, Origin};
pub use network::{Twin, Variant};
pub use prediction::{
    Prediction, TwinAtPlace, TwinMemory, TwinState, WithoutMemory, at_place, predict, simulated_recording,
    unread_press,
};
pub use training::{
    Epoch, Fold, HeldOut, Progress, Split, SplitSettings, TrainSettings, Trained, TrainedWith, choose, train,
};
