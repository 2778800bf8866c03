//! Shows and records the frames of a tactile sensor as they come: as rows of text, as a log, or as
//! a dashboard on the terminal.
//!
//! A [`FrameSource`](twintac_source::FrameSource) reads the sensor on a separate thread.
//! [`Live::open`] opens it from any [`Origin`]: an I²C bus, a serial port, datagrams, a log, or the
//! emulated sensor ([`emulated_phystac`]). [`stream_rows`] writes rows, [`record_frames`] writes a
//! log, and [`dashboard::run`] draws the dashboard.
//!
//! ```
//! use twintac_emulate::LabClock;
//! use twintac_live::emulated_phystac;
//! use twintac_source::{FrameReader, Known, power_on};
//!
//! let sensor = twintac_sensor::Sensor::read("../../../sensors/phystac.toml")?;
//! let mut phystac = emulated_phystac(&sensor, LabClock::virtual_time(), &[])?;
//! assert!(power_on(&mut phystac, &sensor, &Known::default()).is_err()); // nobody has confirmed a scale
//! let known = Known { counts_per_pa: Some(8), ..Known::default() };
//! let checked = power_on(&mut phystac, &sensor, &known)?;
//! let reading = FrameReader::new(phystac, &checked).read()?;
//! assert!((reading.frame.taxels[0].pressure_pa.unwrap() - 101_325.0).abs() < 200.0);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! Pressures in rows and on the dashboard are in kPa above a tare ([`Tare`]); times are in s of the
//! bench clock.
//!
//! # How it works
//!
//! - One thread reads and never waits. Frames go into a bounded channel. Frames that find no room
//!   are counted, and the frame numbers show which they were.
//! - Counts are not pressures until a person has confirmed the scale. A reading in free air gives a
//!   hint for the scale. Nothing is streamed on a hint alone.
//! - The tare is the mean of the first [`Taring::FRAMES`] frames, so nothing may touch the sensor
//!   then.
//! - The dashboard's picture is a function of a state, [`dashboard::DashboardState`], so that tests
//!   can check it. The loop around it draws 15 times a second.
//! - A recording contains the frames that were taken, and marks for the missing ones. At its end a
//!   Parquet table is written beside it.
//! - A pressure map is linear in its readings. Therefore the share of each taxel in each cell is
//!   computed only once (`PreparedMap` in `crates/sensor/map`).
//!
//! # What it does not depend on
//!
//! No solver, no twin and not the physics of the emulated bench (`twintac-lab`): the emulated
//! sensor here is pressed by a ball in closed form (Hertz's contact).

mod about;
pub mod dashboard;
mod emulated;
mod error;
mod live;
mod rows;
mod stream;
mod tare;
mod touch_recording;

pub use about::About;
pub use emulated::{EmulatedPhysTac, emulated_board, emulated_phystac};
pub use error::LiveError;
pub use live::{Live, Origin};
pub use rows::{Format, RowWriter};
pub use stream::{StopAfter, Streamed, record_frames, stream_rows};
pub use tare::{Tare, Taring};
pub use touch_recording::TouchRecording;
