//! Units on a line.

use serde::{Deserialize, Serialize};

/// A unit of time.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum TimeUnit {
    /// Seconds.
    S,
    /// Milliseconds, as from Arduino's `millis()`.
    Ms,
    /// Microseconds, as from Arduino's `micros()`.
    Us,
    /// Nanoseconds.
    Ns,
}

impl TimeUnit {
    /// The unit in s.
    pub(crate) const fn seconds(self) -> f64 {
        match self {
            Self::S => 1.0,
            Self::Ms => 1e-3,
            Self::Us => 1e-6,
            Self::Ns => 1e-9,
        }
    }

    /// The default value at which a counter in this unit rolls over: 2³² for ms and µs, as on a
    /// microcontroller.
    pub(crate) const fn usual_wrap(self) -> Option<f64> {
        match self {
            Self::Ms | Self::Us => Some(4_294_967_296.0),
            Self::S | Self::Ns => None,
        }
    }
}

/// A unit of pressure.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub enum PressureUnit {
    /// Pascal.
    Pa,
    /// Hectopascal, the same as a millibar.
    #[serde(rename = "hPa", alias = "mbar")]
    Hectopascal,
    /// Kilopascal.
    #[serde(rename = "kPa")]
    Kilopascal,
    /// Bar.
    #[serde(rename = "bar")]
    Bar,
    /// Pounds per square inch.
    #[serde(rename = "psi")]
    Psi,
    /// Counts of a converter; `gain` and `offset` convert them to kPa.
    #[serde(rename = "counts")]
    Counts,
}

impl PressureUnit {
    /// The unit in kPa; 1 for counts.
    pub(crate) const fn kilopascals(self) -> f64 {
        match self {
            Self::Pa => 1e-3,
            Self::Hectopascal => 0.1,
            Self::Kilopascal | Self::Counts => 1.0,
            Self::Bar => 100.0,
            Self::Psi => 6.894_757_293_168_361,
        }
    }
}
