//! The experiments of the TwinTac paper (arXiv 2509.10063), repeated on the emulated bench, from
//! nothing to one page.
//!
//! [`Paper::start`] takes a folder, an [`Effort`] (the paper's counts, or a quick trial) and a
//! seed; [`Paper::finish`] makes everything and returns [`PaperMetrics`]: errors of the twin in %,
//! sensitivity in kPa/N, maps in kPa, accuracies of shape classification in %. The sensor's
//! readings are `emulated`, those of the twins `simulated`. The command is
//! `twintac reproduce --paper`.
//!
//! The folder has a run for each recording, and a stage for each experiment:
//!
//! ```text
//! presses/           a run: the paper's presses, as the bench records them
//! force-presses/     a run: presses of every shape, for their forces
//! material/          the gel's material and friction, fitted to these forces
//! data/              a run: the paper's presses on the levelled and fitted gel, and twins trained
//!                    on them
//! pairs/             every frame of the bench beside the simulation, as one array, and a data card
//! trials/            a run: presses of the bench from which shapes are classified
//! simulated/         the same presses, with the readings of the twins (Parquet)
//! shapes/            classifiers, and their accuracies
//! five-shapes/       a run: the presses of the pressure maps
//! maps/              readings of sensor and twin for the maps
//! under-a-ball/      a run: presses that characterize the sensor
//! characterization/  report, data sheet and figures of these
//! report.html, metrics.json
//! ```
//!
//! # How it works
//!
//! - Each experiment, its figures and its page are a file of this crate. Runs and stages are kept
//!   like all others (`crates/app/run`), so a program that was killed continues.
//! - Poses are recorded in the bench's frame, as a robot knows them. `level` finds the tilt of the
//!   sensor from the first contacts of a ball. It transforms poses into the gel's frame before a
//!   twin is trained, and planned presses before a twin simulates them.
//! - `material` fits the gel's material and its friction to forces (`crates/twin/calibrate`).
//!   Fitted without friction, the gel came out too stiff at large strain, and flat shapes were
//!   mistaken for each other. The twin never uses the bench's own gel.
//! - Shapes are classified by a transformer (`crates/twin/classify`). Its input is series of
//!   readings alone; it depends on neither twin nor bench. Its gradients are written by hand:
//!   `burn` with its smallest backend for processors took seven processor minutes to build, as long
//!   as all the rest.
//! - A press is sampled at equal steps of load: with equal steps of time, speeds and holds hide the
//!   shape.
//! - The figures that the documentation cites are kept in `docs/results/metrics.json` with their
//!   commit. `cargo xtask results` writes the table of docs/results.md from it and says when it is
//!   out of date.
//!
//! The crate reads no environment variable and no argument, and prints nothing.

mod blocks;
mod data;
mod effort;
mod experiments;
mod finish;
mod level;
mod maps;
mod material;
mod metrics;
mod mixture;
mod page;
mod pairs;
mod shapes;
mod shapes_section;
mod structured_array;
mod trials;
mod under_a_ball;

pub use effort::Effort;
pub use experiments::Paper;
pub use maps::ShapeMap;
pub use material::GelMaterial;
pub use metrics::PaperMetrics;
pub use mixture::{Mixture, Simulated};
pub use shapes::ShapesResult;
pub use under_a_ball::SensorFigures;
