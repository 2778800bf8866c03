//! Decodes frames of taxels from the bytes of a line: text, JSON or packets, in a format that a
//! file describes.
//!
//! Input is a [`Description`], a TOML file that says how a microcontroller sends its readings, and
//! the bytes of the line. A [`Decoder`] takes the bytes as they arrive, in pieces of any size.
//! Output is [`Heard`]: frames ([`LineFrame`]), and everything else on the line. Times are in s,
//! pressures in kPa, temperatures in °C.
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
//! # How it works
//!
//! Bytes are split at line ends, at zeros (COBS), or at packets that begin with fixed bytes. The
//! numbers of a line or packet are assigned to their fields and converted to units. Checksums and
//! the expected number of values detect torn lines.
//!
//! Every loss is counted: bytes that are not a frame are counted by kind ([`Passed`], [`Tally`]),
//! and each frame has the number of missing frames before it, found from frame numbers or times.
//! Roll-overs of counters are undone. A frame number that falls far back means that the board
//! restarted; a small decrease means a late or repeated frame.
//!
//! The crate opens no port and uses no threads, network or clock. It depends on no sensor.

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
