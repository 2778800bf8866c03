//! Units that lines come in.

use serde::{Deserialize, Serialize};

/// A unit of time.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum TimeUnit {
    /// Seconds.
    S,
    /// Milliseconds: Arduino's `millis()`.
    Ms,
    /// Microseconds: Arduino's `micros()`.
    Us,
    /// Nanoseconds.
    Ns,
}

impl TimeUnit {
    /// How many s it is.
    pub(crate) const fn seconds(self) -> f64 {
        match self {
            Self::S => 1.0,
            Self::Ms => 1e-3,
            Self::Us => 1e-6,
            Self::Ns => 1e-9,
        }
    }

    /// Where a counter of it begins anew, if nothing else is said: at 2³², as a microcontroller's do.
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
    /// Counts of a converter: `gain` and `offset` make kPa of them.
    #[serde(rename = "counts")]
    Counts,
}

impl PressureUnit {
    /// How many kPa it is; 1 of counts.
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
