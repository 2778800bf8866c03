//! Frames of a sensor as they come: as rows of text, or as a dashboard on the terminal.
//!
//! A [`FrameSource`](twintac_source::FrameSource) reads a sensor on a thread of its own. The sensor is on a wire of its own, or an emulated one
//! ([`emulated_phystac`]). [`stream_rows`] writes rows, [`record_frames`] a log, [`dashboard::run`] draws.
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
//! Pressures are in kPa above a tare, times in s of the bench's clock.

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
