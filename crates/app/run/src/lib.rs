//! Runs: the pipeline from a sensor's description and recordings to a trained, evaluated twin and
//! its report.
//!
//! Input: a sensor's description, recordings of presses (CSV files of any laboratory, logs of a
//! test setup, or an emulated one), [`RunSettings`] and a seed. Output: a folder with a model,
//! `metrics.json` ([`Metrics`]: errors in % of the largest reading) and `report.html`. [`Run`] is
//! the main type; [`Run::cross_validate`] repeats training and evaluation for several seeds and
//! ways to hold presses out, and [`adaptation_curve`] measures how few presses suffice to adapt a
//! twin to another sensor.
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
//! # How it works
//!
//! A [`Run`] is a folder of stages, and each stage is a folder that a person can open:
//!
//! ```text
//! run.json       inputs of the run, and its settings
//! sensor.toml    the sensor's description at the start (surface files beside it)
//! logs/          of a test setup: one log for each press (MCAP)
//! lab/           of the emulated bench: what its gel answers at the locations of the presses
//! recordings/    presses.parquet, summary.json
//! mesh/          the gel's mesh for ParaView and Gmsh, quality.json
//! simulation/    split.json, bench.json, and a table over depth for each location
//! pairs/         measured and simulated frames side by side
//! training/      a twin that was trained without the test presses, a twin trained on all presses,
//!                losses
//! evaluation/    the errors
//! cross_validation/  the errors for several seeds and ways to hold presses out, if asked for
//! model/         the twin that was trained on all presses, for use elsewhere
//! report.html, metrics.json
//! ```
//!
//! The stages, in order:
//!
//! 1. `recordings`: [`Run::import`] reads files of any laboratory, [`Run::emulate`] computes what
//!    the emulated bench would record, [`Run::press`] carries presses out on a bench and collects
//!    the logs.
//! 2. `mesh` ([`Run::mesh`]): the gel at rest, for people to look at.
//! 3. `simulation` ([`Run::simulate`]): divides the presses into training, validation and test
//!    presses, fits the unknowns of the test setup (setup calibration) to training and validation
//!    presses, and solves a table over depth for each location.
//! 4. `pairs` ([`Run::pair`]): puts measured and simulated frames on one clock.
//! 5. `training` ([`Run::train`]): trains every variant of the twin without the test presses; the
//!    variant that is best on the validation presses is trained again with the test presses as
//!    well, and becomes the model.
//! 6. `evaluation` ([`Run::evaluate`]): scores the twin that was trained without the test presses
//!    on these, beside the baselines. [`Run::report`] writes the page.
//!
//! A stage works in `<name>.partial` and is renamed when it is done. Its `stage.json` lists all its
//! inputs, and the SHA-256 of its outputs. With the same inputs (and the same build of the program)
//! a stage is not run again. After a kill, the next run continues with what the partial folder
//! holds. A stage refuses to read an earlier one that does not match its present inputs, and the
//! error names the difference. While a run is open, no other process can open it.
//!
//! The crate carries copies of the files that are used when none is named ([`built_in`]):
//! protocols, emulator configurations and a hardware configuration.
//!
//! It prints nothing, reads no environment variable and no argument, and ends no process: progress
//! goes to the caller's `Progress`, and an error is a `WorkError` (both of `crates/app/work`).

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
