//! Barometric touch sensors and their digital twin.
//!
//! Press a simulated gel, read a sensor, learn from recordings what its barometers make of the gel's pressure, and ask the trained twin
//! what it would read.
//!
//! ```toml
//! [dependencies]
//! twintac = { path = "crates/app/twintac" }  # of a checkout; twintac is not published yet
//! ```
//!
//! A ball, pressed into PhysTac, and what reaches its eight ports:
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
//! What is pressed, as its description says (`twintac sensor show sensors/phystac.toml --draw phystac.svg`):
//!
#![doc = concat!("<div style=\"background: white; padding: 1em\">", include_str!("../phystac.svg"), "</div>")]
//!
//! # What there is
//!
//! | type | what it is | feature |
//! |---|---|---|
//! | [`Sensor`] | a sensor as its description says: gel, taxels, indenters | |
//! | [`Press`] | where, with what, how deep and how fast to press | |
//! | [`Gel`], [`Pressed`] | the sensor's gel, and what it does under a press: forces, and pressures at the ports | |
//! | [`GelState`]; [`PressPath`], [`Followed`] | the gel pressed frame by frame, as poses come; a path of poses and forces, and what the gel does along it | |
//! | [`PressureMap`] | pressure between the taxels, and a picture of it | `map` |
//! | [`Recording`] | recorded presses, as Parquet or from CSV files of any laboratory ([`Import`]) | `recording` |
//! | [`Reader`], [`Reading`] | frames of a sensor on an I²C bus, or of an emulated one | `live` |
//! | [`Twin`], [`Prediction`] | a trained twin, and what it would read along a press | `twin` |
//! | [`TwinAtPlace`], [`TwinState`] | a twin that is stepped frame by frame: at one place, or with port pressures, for thousands of sensors | `twin` |
//! | [`FastGel`], [`FastBatch`], [`Friction`] | the gel without finite elements: microseconds a reading, thousands of sensors in one call; friction of what slides | `fast` |
//! | [`SensorBatch`], [`Imperfection`], [`CoupledBatch`] | the same with a twin's gains and memory, with what no two sensors have alike, and with friction of bodies that move freely | `sensors` |
//! | [`Tasks`], [`Kind`] | many environments of a task for reinforcement learning | `tasks` |
//! | [`Inverse`], [`Tracker`], [`Contact`] | from readings back to what touches: place, depth, force, which of the known shapes | `fast` |
//! | [`Locator`], [`LocatorTracker`] | the same by a trained twin, whose memory is taken off the readings | `run` |
//! | [`Dataset`] | many simulated presses, made in shards by as many machines as there are | `run` |
//! | [`Run`] | a folder in which recordings become a judged twin and a report | `run` |
//!
//! Lengths are in mm, forces in N, pressures in kPa, times in s, angles in radians. The gel's frame has z up and z = 0 at the board; presses go
//! along -z. Numbers say where they come from: `real`, `emulated` or `simulated`.
//!
//! # Five lines more
//!
//! A picture of what the taxels read:
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
//! A sensor that is read, here an emulated one:
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
//! A twin of PhysTac, trained on the emulated bench in minutes, and what it would read along a press:
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
//! The same twin, stepped as depths come:
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
//! Touch for learning, about ten microseconds a reading, with any number of bodies of any shape:
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
//! And back, frame by frame, from readings to what touches:
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
//! The folder `examples/` has these as programs, and one that trains a twin on CSV files of your own.
//!
//! # Features
//!
//! All are on by default. `default-features = false` leaves the gel alone, which compiles in a fraction of the time: no network, no Parquet.
//!
//! | feature | what it adds |
//! |---|---|
//! | `fast` | touch for learning, without finite elements, and back from readings to contacts |
//! | `sensors` | many imperfect sensors stepped in one call; brings `fast` and `twin` |
//! | `tasks` | tasks of touch for reinforcement learning; brings `map` and `sensors` |
//! | `map` | pressure maps and pictures |
//! | `recording` | recorded presses: Parquet, CSV |
//! | `live` | reading a sensor; brings `recording` |
//! | `twin` | trained twins: a neural network; brings `recording` |
//! | `run` | the pipeline from recordings to a judged twin; brings `twin` |
//!
//! What is below this crate has the details: `twintac-simulate` and `twintac-softbody` the finite elements, `digitac` the twin, `phystac` the
//! `no_std` drivers, `twintac-run` the pipeline.

mod error;
mod gel;
#[cfg(feature = "map")]
mod map;
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
    Body, FastBatch, FastFileError, FastGel, FastGelMismatch, FastReader, Friction, Touch,
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
    CoupledBatch, Coupling, HeldTouch, Imperfection, SensorBatch, SensorState, TouchId, TouchedTwice,
    most_sensors,
};
pub use twintac_shape::{
    Distance, LengthUnit, Part, Pose, Shape, SignedDistance, SurfaceFile, Surfaces, TriangleSurface,
};
pub use twintac_simulate::{Followed, FollowedFrame, GelState, SimulateSettings};
#[cfg(feature = "run")]
pub use twintac_store::Outcome;
#[cfg(feature = "tasks")]
pub use twintac_tasks::{Answers, Autoreset, Kind, PICTURE_PX, TaskError, Tasks, usual_imperfection};
#[cfg(feature = "run")]
pub use twintac_work::{Caller, Progress, Silent, WorkError, sha256_of_file};

/// Snippets of the checkout's pages, which are tests.
#[cfg(doctest)]
#[allow(rustdoc::invalid_codeblock_attributes)] // titles of blocks that are not Rust
mod pages {
    #[doc = include_str!("../../../../README.md")]
    struct Readme;
    #[doc = include_str!("../../../../docs/reference/rust.md")]
    struct Rust;
}
