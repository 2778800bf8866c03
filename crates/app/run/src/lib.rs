//! Runs: from a sensor's description and its recordings to a judged twin and a report, stage by stage.
//!
//! ```no_run
//! use std::path::Path;
//! use twintac_run::{Run, RunSettings};
//! use twintac_sensor::SensorFile;
//! use twintac_work::{Caller, WorkError};
//!
//! # fn main() -> Result<(), WorkError> {
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
//! This crate prints nothing, reads no environment and ends no process: how work goes, [`Progress`](twintac_work::Progress) hears. What is wrong is a
//! [`WorkError`](twintac_work::WorkError).

mod adaptation_curve;
mod bench;
pub mod built_in;
mod cross_validation;
mod demo;
mod metrics;
mod report;
mod run;
mod settings;
mod stages;

pub use adaptation_curve::{AdaptationCurve, AdaptationPoint, CurvePlan, SeedOfPoint, adaptation_curve};
pub use bench::check_logs;
pub use cross_validation::{
    CertaintySpread, CrossValidated, CrossValidation, CrossValidationPlan, OfSeed, Spread, Without,
};
pub use digitac::HeldOut;
pub use metrics::Metrics;
pub use run::{Run, RunRecord};
pub use settings::RunSettings;
pub use stages::pairs::read_pairs;
pub use stages::recordings::{
    Change, guess_import, import_files, read_import, read_recording, read_recordings,
};
pub use stages::simulation::Simulation;
pub use stages::training::COMPLETE;
