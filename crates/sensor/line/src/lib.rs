//! Frames of taxels out of a line's bytes: text, JSON or packets, as a description says.
//!
//! A [`Description`] is a TOML file that says how a microcontroller sends its readings. A [`Decoder`] takes the bytes as they come, in pieces of
//! any size, and gives [`Heard`]: frames, and what else was on the line. Nothing is lost without a word: what is no frame is counted by its kind
//! ([`Passed`]), and frames say how many are missing before them. Nothing here opens a port.
//!
//! ```
//! use twintac_line::{Decoder, Description, Heard};
//!
//! let description = Description::parse(
//!     "board.toml",
//!     r#"
//!     form = "text"
//!     fields = ["sequence", "time", "pressure * 2", "temperature"]
//!     time.unit = "ms"
//!     pressure.unit = "Pa"
//!     "#,
//! )?;
//! let mut decoder = Decoder::new(&description, 2);
//! let mut frames = Vec::new();
//! decoder.push(b"hello\r\n1,100,101325,nan,25.5\r\n3,120,101330,101200,25.5\r\n", &mut |heard| {
//!     if let Heard::Frame(frame) = heard {
//!         frames.push(frame);
//!     }
//! });
//! assert_eq!(frames[0].pressures_kpa, [Some(101.325), None]);
//! assert_eq!((frames[1].time_s, frames[1].lost_before), (Some(0.12), 1));
//! # Ok::<(), twintac_config::ConfigError>(())
//! ```
//!
//! Times are in s, pressures in kPa, temperatures in °C.

mod checksum;
mod counter;
mod decoder;
mod description;
mod field;
mod heard;
mod packet;
mod row;
mod text;
mod unit;

pub use checksum::Checksum;
pub use decoder::Decoder;
pub use description::{Binary, Description, Form, Pressure, Serial, Temperature, Text, Time};
pub use field::{Field, Meaning, Number};
pub use heard::{Heard, Passed, Tally};
pub use row::LineFrame;
pub use unit::{PressureUnit, TimeUnit};
