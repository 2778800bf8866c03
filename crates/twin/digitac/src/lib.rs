//! The digital twin of a barometric tactile sensor: from simulated pressures in the gel to the
//! readings of its barometers.
//!
//! In: measured presses (crate `twintac-recording`) with poses (mm), forces (N) and readings (kPa)
//! over time (s); the gel simulated at their locations, as tables over depth (crate
//! `twintac-depth-table`). Out: a [`Twin`], which predicts readings (kPa, above the zero) from the
//! pressures at the ports (kPa); an estimate of the test setup, the [`BenchEstimate`]; errors in %
//! of the largest reading; and 90 % intervals for the readings.
//!
//! The steps from a recording to a twin in use:
//!
//! 1. [`Places`] are the distinct locations of a recording. A
//!    [`DepthTableSource`](twintac_depth_table::DepthTableSource) simulates each of them.
//! 2. [`fit_bench`] and [`refine_bench`] fit the unknowns of the test setup (setup calibration).
//! 3. [`pair()`] puts measured and simulated frames side by side on one clock ([`Warp`]).
//! 4. A [`Split`] divides presses into training, validation and test presses. [`train()`] makes a
//!    [`Twin`] of each [`Variant`], [`choose()`] selects one.
//! 5. [`evaluate()`] computes its errors, [`calibrate()`] its intervals. A [`Model`] keeps
//!    everything in a folder.
//! 6. A twin in use is a [`TwinState`], or a [`TwinAtPlace`], stepped frame by frame. [`predict()`]
//!    takes it along planned presses. [`WithoutMemory`] goes the opposite way: from readings to
//!    those of a gel without viscoelastic relaxation.
//!
//! The crate depends neither on devices, nor on the way a gel is solved, nor on the emulated bench:
//! tables come through a trait, and the emulator's own physics cannot reach the twin.
//!
//! # How it works
//!
//! **Model of a reading.** A barometer reads `r + Σ c q`. Here `r` is the elastic reading: the
//! static nonlinearity of the port (in code: port law), applied to gain × pressure at the port. The
//! overstresses `q` follow each change of `r` and fade, each with a time constant of its own
//! (quasi-linear viscoelasticity; in code: memory). Viscoelastic relaxation goes on from press to
//! press: presses of one installation of an indenter (in code: mounting) on one clock follow each
//! other, and so do their overstresses. Measured readings and predictions are both set to zero over
//! the last second before the tip comes near the gel.
//!
//! **Setup calibration.** The unknowns are fitted in two steps, both by least absolute deviations
//! over the largest reading of each file (`physical_fit`):
//!
//! 1. [`fit_bench`] finds what the tables depend on, the radius of the tip or the stiffness of the
//!    gel, from few locations that are simulated for several radii.
//! 2. [`refine_bench`] finds all other unknowns from all training presses, with the tables of all
//!    locations: contact heights; locations and radius of the ports; gains, static nonlinearity and
//!    relaxation of the barometers. A correction factor ([`SmoothFactor`]), a smooth function of
//!    distance and depth that is the same for all ports, stands for the difference between the real
//!    and the simulated tip and gel. The part of the static nonlinearity that grows with the port
//!    pressure in the same way for all taxels belongs to the gel. Each taxel also has a part of its
//!    own, which is regularized.
//!
//! Relaxation is linear, so a column of the Jacobian is the derivative of the port's elastic
//! reading, put through the same relaxation. Port pressures come through the trait `Elastic`: from
//! the tables of a test setup, from known pressures, or from the curve of the parametric baseline.
//! Physical variants end there. A perceptron is trained on top of them, on readings from which the
//! relaxation after earlier presses has been subtracted.
//!
//! **Network.** The perceptron is small, has a fixed structure and is trained in seconds. Its
//! gradients are written by hand (`network`): a framework with automatic differentiation (`burn`)
//! took a third of the first build of the workspace.
//!
//! **Evaluation.** Every frame is scored, on the recording's own clock. Validation presses choose
//! the variant; a physical variant is then fitted once more with them. Test presses are used for
//! nothing else. The test setup is fitted to training and validation presses alike, so the variant
//! is chosen on presses that the setup calibration has seen.
//!
//! [`evaluate_fold()`] makes the whole fit again for one division of the presses. The command
//! `cross-validate` calls it for several seeds and for several ways to hold presses out
//! ([`HeldOut`]). Divisions share only tables: for a tip of unknown radius, tables are made once
//! for each of a few radii, and blended. If a file has no training presses, its contact height
//! comes from its first presses with clear readings ([`recalibrate`]); these are not scored.
//!
//! The parametric baseline (in code: kernel) is a power of depth times a smooth function of
//! distance, with gains and with relaxation that starts from rest, without a static nonlinearity.
//! Finite elements are justified only if a twin's error is below that of this baseline.
//!
//! **A twin in use.** A twin is stepped frame by frame (`prediction`): elastic readings from the
//! pressures at the ports, then the relaxation from the frames before. Whole presses and thousands
//! of sensors go through the same step; each row of a matrix product has the same bits, however
//! many rows there are. A sensor that one tool presses at one location is stepped with depths,
//! through its table ([`TwinAtPlace`]); along a path, it is stepped with the pressures that the
//! solver finds.
//!
//! **Uncertainty.** Intervals and the out-of-distribution score are described in
//! `src/certainty/mod.rs`; see [`calibrate()`] and [`Certainty`].
//!
//! The folders of this crate; each has a description at its front:
//!
//! ```text
//! numerics          searches, robust fits and small linear systems
//! features          the simulated gel along a press; gains, static nonlinearity and relaxation of
//!                   barometers
//! physical_fit      barometers and unknowns of the setup fitted to measured presses
//! bench_fit         the unknowns of the test setup, and tables read along presses
//! alignment         measured and simulated frames on one clock
//! network           the variants, their parameters and gradients
//! prediction        readings frame by frame, and along whole presses
//! evaluation        errors, baselines, repeatability of measured presses
//! adaptation        a twin adapted to another sensor from a few presses
//! training          divisions of presses, training of the variants
//! certainty         90 % intervals and the out-of-distribution score
//! cross_validation  everything fitted again for each division of the presses
//! model_folder      a model's folder, its record and its card
//! ```

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
    Certainty, CertaintyScore, Contact, PressCertainty, TrainingData, area_under_curve, calibrate,
    score_certainty,
};
pub use cross_validation::{Bench, FoldEvaluation, OodDetection, evaluate_fold};
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
