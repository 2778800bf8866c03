//! Simulation, reading and learning for barometric touch sensors, and their digital twin.
//!
//! A barometric touch sensor consists of pressure chips (MEMS barometers) under rubber. They are
//! cheap and robust, and they read the pressure at a few points, not the contact. This library
//!
//! - presses the rubber in simulation, by finite elements or by a network that is trained on them
//!   (microseconds a reading);
//! - reads such sensors, on an I²C bus, a serial line, by UDP, or emulated;
//! - trains a *digital twin* on recordings of a real sensor, which predicts what its barometers
//!   read, with intervals;
//! - estimates contacts from readings: location, depth, force and shape.
//!
//! It has the sensor PhysTac built in (eight barometers, 34 × 18 × 8.5 mm), and takes any other
//! from a description in a TOML file.
//!
//! ```toml
//! [dependencies]
//! twintac = { path = "crates/app/twintac" }  # of a checkout; twintac is not published yet
//! ```
//!
//! This program presses a ball into PhysTac, and prints the pressures at its eight ports:
//!
//! ```
//! use twintac::{Error, Gel, Press, Pressed, Sensor};
//!
//! fn main() -> Result<(), Error> {
//!     let sensor = Sensor::phystac()?;
//!     let ball = Press::with("sphere-25").at_mm(-4.0, 4.0).depth_mm(1.0);
//!     let pressed = Gel::of(&sensor).press(&ball)?;
//!     for (taxel, pressure_kpa) in sensor.taxels().zip(pressed.readings_kpa()) {
//!         println!("{taxel} {pressure_kpa:6.2} kPa, {}", Pressed::PROVENANCE);
//!     }
//!     Ok(())
//! }
//! ```
//!
//! The sensor as its description says
//! (`twintac sensor show sensors/phystac.toml --draw phystac.svg`):
//!
#![doc = concat!("<div style=\"background: white; padding: 1em\">", include_str!("../phystac.svg"), "</div>")]
//!
//! # How the parts fit together
//!
//! ```text
//! description (TOML) ──► Sensor ──► Gel ──► Pressed, GelState        finite elements
//!                           │        └────► FastGel, SensorBatch     surrogate, many sensors
//!                           │
//!                           ├─────► Reader ──► Reading ───────────── a sensor, real or emulated
//!                           │
//! recordings (CSV, logs) ───┴─────► Run ─────► Twin ──► Prediction   trained on recordings
//!                                                └────► Locator      contacts from readings
//! ```
//!
//! A barometer does not read the pressure at its port exactly: it has a gain, a static
//! nonlinearity, and viscoelastic relaxation of the rubber around it. The [`Gel`] computes the
//! pressures at the ports; the [`Twin`] has learned the rest from recordings.
//!
//! # Main types
//!
//! | type | what it is | feature |
//! |---|---|---|
//! | [`Sensor`] | a sensor's description: gel, taxels, indenters | |
//! | [`Press`] | a press: with which indenter, where, how deep, how fast | |
//! | [`Gel`], [`Pressed`] | the sensor's gel, and its response to a press: forces, and pressures at the ports | |
//! | [`GelState`] | the gel, pressed frame by frame with poses as they come | |
//! | [`PressPath`], [`Followed`] | a path of poses and forces, and the gel's response along it | |
//! | [`PressureMap`] | pressure between the taxels, and a picture of it | `map` |
//! | [`Recording`], [`Import`] | recorded presses, from Parquet or from CSV files of any laboratory | `recording` |
//! | [`Reader`], [`Reading`] | frames of a sensor on an I²C bus or a serial line, or of an emulated one | `live` |
//! | [`Run`] | a folder in which recordings become a trained and evaluated twin, and a report | `run` |
//! | [`Twin`], [`Prediction`] | a trained twin, and its predicted readings along a press | `twin` |
//! | [`TwinAtPlace`], [`TwinState`] | a twin, stepped frame by frame: at one location, or with given port pressures for thousands of sensors | `twin` |
//! | [`FastGel`], [`FastBatch`], [`Friction`] | the surrogate of the gel: 6 to 8 µs a reading, thousands of sensors in one call; friction of sliding contacts | `fast` |
//! | [`SensorBatch`], [`SensorVariation`], [`CoupledBatch`] | the same with a twin's gains and relaxation, with sensor variation, and with friction of bodies that move freely | `sensors` |
//! | [`Tasks`], [`Kind`] | tasks for reinforcement learning, many environments in one call | `tasks` |
//! | [`Inverse`], [`Tracker`], [`Contact`] | contact estimation: from readings to location, depth, force, and which of the known shapes | `fast` |
//! | [`Locator`], [`LocatorTracker`] | contact estimation by a trained twin, which accounts for relaxation | `run` |
//! | [`Dataset`] | many simulated presses, made in shards on any number of machines | `run` |
//!
//! Errors are one type, [`Error`]: its text says what is wrong and what to do, and [`Error::place`]
//! names file, line and field.
//!
//! # Units, frames, provenance
//!
//! Lengths are in mm, forces in N, pressures in kPa, times in s, angles in radians. The gel's frame
//! has z up and z = 0 at the board; presses go along -z. The origin of an indenter is the point
//! that first touches a flat gel. Every number states its provenance: `real`, `emulated` (devices
//! in software, read over their own protocols) or `simulated`.
//!
//! # Examples
//!
//! The pressure between the taxels, from their readings:
//!
//! ```
//! # #[cfg(feature = "map")] {
//! use twintac::{PressureMap, Sensor};
//!
//! let sensor = Sensor::phystac()?;
//! let map = PressureMap::of(&sensor, &[0.0, 2.0, 7.5, 1.0, 0.0, 1.5, 6.0, 0.8])?;
//! assert_eq!(map.pressure_kpa().len(), 96 * 64);
//! # }
//! # Ok::<(), twintac::Error>(())
//! ```
//!
//! Reading a sensor, here an emulated one:
//!
//! ```
//! # #[cfg(feature = "live")] {
//! use twintac::{Reader, Sensor};
//!
//! let mut reader = Reader::emulated(&Sensor::phystac()?)?;
//! let reading = reader.read()?;
//! println!("{:.3} s, {}: {:?} kPa", reading.time_s, reader.provenance(), reading.readings_kpa);
//! # }
//! # Ok::<(), twintac::Error>(())
//! ```
//!
//! A twin of PhysTac, trained on the emulated bench in about a minute, and its prediction along a
//! press:
//!
//! ```no_run
//! # #[cfg(feature = "run")] {
//! use std::path::Path;
//! use twintac::{Caller, Press, Run, Twin};
//!
//! let run = Run::demo(Path::new("runs/demo"), 1, Caller::default())?;
//! let metrics = run.finish()?;
//! if let Some(percent) = metrics.twin.overall.nearest_in_contact_percent {
//!     println!("errs by {percent:.1} % on presses that it never saw");
//! }
//! let twin = Twin::load(run.model_folder())?;
//! let predicted = twin.predict(&Press::with("sphere-25").depth_mm(1.2).hold_s(1.0))?;
//! println!("{:?} kPa at first touch", predicted.readings_kpa[0]);
//! # }
//! # Ok::<(), twintac::Error>(())
//! ```
//!
//! The same twin, stepped with depths as they come:
//!
//! ```no_run
//! # #[cfg(feature = "twin")] {
//! use twintac::{Press, Twin};
//!
//! let twin = Twin::load("runs/demo/model")?;
//! let mut pressed = twin.at(&Press::with("sphere-25").depth_mm(1.2))?;
//! let mut readings_kpa = [0.0; 8];
//! for depth_mm in [0.0, 0.3, 0.6, 0.9, 1.2] {
//!     pressed.step(0.018, depth_mm, &mut readings_kpa);
//!     println!("{:.2} N, {readings_kpa:.2?} kPa", pressed.force_n());
//! }
//! # }
//! # Ok::<(), twintac::Error>(())
//! ```
//!
//! The surrogate of the gel for learning, 6 to 8 µs a reading, with any number of bodies of any
//! shape:
//!
//! ```
//! # #[cfg(feature = "fast")] {
//! use twintac::{Body, FastGel, Pose, Shape};
//!
//! let cube = Shape::Box { size_mm: [10.0; 3], edge_radius_mm: 0.8 };
//! let cube = Body::new(&cube, &Default::default())?;
//! let mut reader = FastGel::phystac()?.reader();
//! let (mut pressure_kpa, mut wrench) = ([0.0; 8], [0.0; 6]);
//! let one_mm_deep = Pose::from_position([-4.0, 4.0, 7.5].into());
//! reader.read(&[(&cube, one_mm_deep)], &mut pressure_kpa, &mut wrench);
//! println!("{:.1} N, {pressure_kpa:.2?} kPa", -wrench[2]);
//! # }
//! # Ok::<(), twintac::Error>(())
//! ```
//!
//! Contact estimation, frame by frame, from readings to location, depth and force:
//!
//! ```
//! # #[cfg(feature = "fast")] {
//! use twintac::{FastGel, Inverse, InverseSettings, KnownShape, Shape};
//!
//! let ball = KnownShape { name: "ball".into(), shape: Shape::Sphere { radius_mm: 5.0 } };
//! let inverse = Inverse::of_fast_gel(&FastGel::phystac()?, &[ball], &Default::default(), InverseSettings::default())?;
//! let mut tracker = inverse.start();
//! if let Some(contact) = tracker.update(0.01, &[0.1, 0.9, 1.0, 0.1, 0.8, 8.7, 0.9, 0.2])? {
//!     println!("{:.1} mm, {:.2} mm deep, {:.2} N", contact.place_mm, contact.depth_mm, contact.force_n);
//! }
//! # }
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! The folder `examples/` has complete programs, among them one that trains a twin on CSV files of
//! your own.
//!
//! # Features
//!
//! All features are on by default. `default-features = false` leaves the finite-element gel alone,
//! which compiles in a fraction of the time: no network, no Parquet.
//!
//! | feature | what it adds |
//! |---|---|
//! | `fast` | the surrogate of the gel, without finite elements, and contact estimation |
//! | `sensors` | many imperfect sensors stepped in one call; includes `fast` and `twin` |
//! | `tasks` | tasks for reinforcement learning; includes `map` and `sensors` |
//! | `map` | pressure maps and pictures |
//! | `recording` | recorded presses: Parquet, CSV |
//! | `live` | reading a sensor; includes `recording` |
//! | `twin` | trained twins: a neural network; includes `recording` |
//! | `run` | the pipeline from recordings to a trained and evaluated twin; includes `twin` |
//!
//! # Limits
//!
//! Twins have been trained on recordings of three real strips and two castings of an array, made by
//! others. No PhysTac has been
//! built yet, and the drivers have not been tested on hardware: figures of PhysTac are `emulated`
//! or `simulated`. Sensors with cameras under gel are out of scope.
//!
//! # The crates below
//!
//! This crate re-exports what a user needs. The crates below have the details: `twintac-simulate`
//! and `twintac-softbody` the finite elements, `digitac` the twin, `phystac` the `no_std` drivers,
//! `twintac-run` the pipeline. The library reads no environment variable and no argument, and
//! prints nothing.

mod error;
mod gel;
#[cfg(feature = "map")]
mod map;
#[cfg(feature = "map")]
mod picture;
mod press;
#[cfg(feature = "live")]
mod reader;
mod sensor;
#[cfg(feature = "twin")]
mod twin;

pub use error::{Error, ErrorPlace};
pub use gel::{Gel, Pressed};
#[cfg(feature = "map")]
pub use map::PressureMap;
pub use press::Press;
#[cfg(feature = "live")]
pub use reader::{Reader, Reading};
pub use sensor::Sensor;
#[cfg(feature = "twin")]
pub use twin::Twin;

#[cfg(feature = "twin")]
pub use digitac::{Prediction, PressCertainty, TwinAtPlace, TwinState};
#[cfg(feature = "run")]
pub use twintac_dataset::{Dataset, DatasetPlan, FastSource, Shard, check_dataset, merge_dataset};
pub use twintac_depth_table::PressFrame;
#[cfg(feature = "fast")]
pub use twintac_fast::{
    Body, FastBatch, FastFileError, FastGel, FastGelMismatch, FastReader, Friction, PortElsewhere, Touch,
};
#[cfg(feature = "fast")]
pub use twintac_inverse::{
    Contact, FastModel, FloorMap, Inverse, InverseError, InverseSettings, KnownShape, ReadingTable,
    TableModel, Tracker,
};
#[cfg(feature = "run")]
pub use twintac_model::{Locator, LocatorTracker, Predicted};
pub use twintac_protocol::{PathError, Point, PressPath, Waypoint, Zero};
#[cfg(feature = "run")]
pub use twintac_recorded::Recorded;
#[cfg(all(feature = "recording", not(feature = "run")))]
pub use twintac_recording::guess_import;
#[cfg(feature = "recording")]
pub use twintac_recording::{Column, FileSummary, Import, ImportSummary, Provenance, Recording};
#[cfg(feature = "run")]
pub use twintac_run::{Metrics, Run, RunSettings, guess_import, import_files, read_recordings};
pub use twintac_sensor::SensorFile;
#[cfg(feature = "sensors")]
pub use twintac_sensors::{
    CoupledBatch, Coupling, HeldTouch, SensorBatch, SensorState, SensorVariation, TouchId, TouchedTwice,
    most_sensors,
};
pub use twintac_shape::{
    Distance, LengthUnit, Part, Pose, Shape, SignedDistance, SurfaceFile, Surfaces, TriangleSurface,
};
pub use twintac_simulate::{Followed, FollowedFrame, GelState, SimulateSettings};
#[cfg(feature = "run")]
pub use twintac_store::Outcome;
#[cfg(feature = "tasks")]
pub use twintac_tasks::{Answers, Autoreset, Kind, PICTURE_PX, TaskError, Tasks, usual_variation};
#[cfg(feature = "run")]
pub use twintac_work::{Caller, Progress, Silent, WorkError, sha256_of_file};

/// Snippets of pages of the checkout. They are run as tests.
#[cfg(doctest)]
#[allow(rustdoc::invalid_codeblock_attributes)] // titles of blocks that are not Rust
mod pages {
    #[doc = include_str!("../../../../README.md")]
    struct Readme;
    #[doc = include_str!("../../../../docs/reference/rust.md")]
    struct Rust;
}
