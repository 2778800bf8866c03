//! Frames of a sensor as they come: as rows of text, or as a dashboard on the terminal.
//!
//! A [`FrameSource`] reads a sensor on a thread of its own and hands its frames out through a bounded channel. Frames that do not fit are counted
//! as missed: the bus waits for nobody. The sensor is on any bus of `embedded_hal`: `/dev/i2c-N` of Linux, or an
//! emulated one ([`emulated_phystac`]). [`stream_rows`] writes rows, [`dashboard::run`] draws.
//!
//! ```
//! use twintac_live::{FrameReader, Known, emulated_phystac, power_on};
//! use twintac_emulate::LabClock;
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
mod full_scale;
#[cfg(target_os = "linux")]
mod linux;
mod live;
mod reader;
mod rows;
mod scale;
mod screening;
mod source;
mod stream;
mod tare;

pub use about::{About, driver_settings};
pub use emulated::{EmulatedPhysTac, emulated_board, emulated_phystac};
pub use error::LiveError;
#[cfg(target_os = "linux")]
pub use linux::{LinuxBus, LinuxPhysTac, open_linux};
pub use live::Live;
pub use reader::{FrameReader, Reading};
pub use rows::{Format, RowWriter};
pub use scale::{Known, PowerOn, power_on};
pub use screening::{Screening, confirmed_transfer};
pub use source::{FrameSource, Tally};
pub use stream::{StopAfter, Streamed, stream_rows};
pub use tare::{Tare, Taring};

/// Taxels of a sensor that is read here: as many as the switch has channels.
pub const TAXELS: usize = 8;

/// A clock that may go to another thread.
pub type BoxedClock = Box<dyn Fn() -> u64 + Send>;
