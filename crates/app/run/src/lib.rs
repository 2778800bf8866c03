//! Runs: from a sensor's description and its recordings to a judged twin and a report, stage by stage.
//!
//! ```no_run
//! use std::path::Path;
//! use twintac_run::{Caller, Run, RunSettings, SensorFile};
//!
//! # fn main() -> Result<(), twintac_run::RunError> {
//! let sensor = SensorFile::read(Path::new("sensors/strip4-gel-d.toml"))?;
//! let settings = RunSettings::default();
//! let run = Run::start(Path::new("runs/mine"), sensor, "three files", 1, settings, Caller::default())?;
//! run.import(Path::new("imports/strip4.toml"), &["press-1.csv".into()])?;
//! let metrics = run.finish()?; // minutes: simulate, align, train, evaluate, report
//! if let Some(percent) = metrics.twin.overall.nearest_in_contact_percent {
//!     println!("{percent:.1} %, see {}", run.report_path().display());
//! }
//! # Ok(())
//! # }
//! ```
//!
//! A [`Run`] is a folder that a person can open:
//!
//! ```text
//! run.json       what the run is made from, and its settings
//! sensor.toml    the sensor description, as it was (surfaces beside it)
//! logs/          of a bench: one for each press (MCAP)
//! lab/           of the emulated bench: what its gel answers at the places of the presses
//! recordings/    presses.parquet, summary.json
//! mesh/          the gel's mesh for ParaView and Gmsh, quality.json
//! simulation/    split.json, bench.json, and a table over depth for each place
//! pairs/         measured and simulated frames side by side
//! training/      a twin that never saw the test presses, a twin of all presses, losses
//! evaluation/    the errors
//! cross_validation/  the errors for several seeds and ways to hold presses out, if they were asked for
//! model/         the twin of all presses, to be used elsewhere
//! report.html, metrics.json
//! ```
//!
//! This crate prints nothing, reads no environment and ends no process: how work goes, [`Progress`] hears. What is wrong is a [`RunError`].
//!
//! Beside runs: [`evaluate_elsewhere`] judges a model on other recordings, [`adapt_model`] adapts one to another sensor, a [`Predictor`] takes one along a path or a protocol, a [`Locator`] finds what touches by one, [`calibration`] fits a gel's material, [`characterization`] reads
//! what a sensor does, [`simulated`] presses a gel along a protocol or a path, [`dataset`] makes many presses in shards, [`mesh`] writes meshes, [`bench`](mod@bench) carries presses
//! out, [`export`](mod@export) makes tables of logs.

mod adaptation;
pub mod bench;
pub mod built_in;
pub mod calibration;
mod caller;
pub mod characterization;
mod cross_validation;
pub mod dataset;
mod demo;
mod depth_tables;
mod doubtful;
mod error;
pub mod export;
pub mod fast;
mod files;
mod locate;
pub mod mesh;
mod metrics;
mod model;
pub mod paper;
mod predict;
mod press_checksum;
mod progress;
mod protocol;
mod report;
mod run;
mod settings;
pub mod simulated;
mod stages;
mod unseen;

pub use adaptation::{
    AdaptationCurve, AdaptationPlan, AdaptationPoint, AdaptedModel, CurvePlan, adapt_model, adaptation_curve,
};
pub use caller::Caller;
pub use cross_validation::{
    CertaintySpread, CrossValidated, CrossValidation, CrossValidationPlan, OfSeed, Spread, Without,
};
pub use digitac::HeldOut;
pub use error::RunError;
pub use files::sha256_of_file;
pub use locate::{Located, LocatedFrame, LocatedPress, LocationErrors, Locator, LocatorTracker};
pub use metrics::{BaselineFigures, Figures, Metrics, TwinFigures};
pub use predict::{Predicted, Predictor};
pub use progress::{Progress, Silent};
pub use protocol::Planned;
pub use run::{Run, RunRecord};
pub use settings::{RunSettings, simulate_settings};
pub use stages::recordings::{import_files, read_recordings};
pub use twintac_sensor::SensorFile;
pub use twintac_store::{Outcome, StoreError};
pub use unseen::{UnseenEvaluation, evaluate_elsewhere};
