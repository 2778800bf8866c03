//! Units of imported files, and their conversion to mm, N, s and kPa.

use serde::Deserialize;

/// A unit of one quantity.
pub(crate) trait Unit: Copy + Default {
    /// The factor that converts this unit to the project's unit.
    fn factor(self) -> f64;
}

/// Unit of a position.
#[derive(Clone, Copy, Debug, Default, Deserialize)]
#[serde(rename_all = "lowercase")]
pub(crate) enum Length {
    #[default]
    Mm,
    Cm,
    Um,
    M,
}

impl Unit for Length {
    fn factor(self) -> f64 {
        match self {
            Self::Mm => 1.0,
            Self::Cm => 10.0,
            Self::Um => 1e-3,
            Self::M => 1e3,
        }
    }
}

/// Unit of a time.
#[derive(Clone, Copy, Debug, Default, Deserialize)]
#[serde(rename_all = "lowercase")]
pub(crate) enum Time {
    #[default]
    S,
    Ms,
    Us,
    Ns,
    /// A time of day, or date and time, as text.
    Clock,
}

impl Unit for Time {
    fn factor(self) -> f64 {
        match self {
            Self::S | Self::Clock => 1.0,
            Self::Ms => 1e-3,
            Self::Us => 1e-6,
            Self::Ns => 1e-9,
        }
    }
}

/// Unit of a force.
#[derive(Clone, Copy, Debug, Default, Deserialize)]
pub(crate) enum Force {
    #[default]
    N,
    #[serde(rename = "mN")]
    Mn,
    #[serde(rename = "kgf")]
    Kgf,
}

impl Unit for Force {
    fn factor(self) -> f64 {
        match self {
            Self::N => 1.0,
            Self::Mn => 1e-3,
            Self::Kgf => 9.806_65,
        }
    }
}

/// Unit of a reading.
#[derive(Clone, Copy, Debug, Default, Deserialize)]
pub(crate) enum Pressure {
    #[default]
    #[serde(rename = "kPa")]
    Kpa,
    Pa,
    #[serde(rename = "hPa", alias = "mbar")]
    Hpa,
    #[serde(rename = "bar")]
    Bar,
    #[serde(rename = "psi")]
    Psi,
    /// Counts of a converter; their scale has to be given.
    #[serde(rename = "counts")]
    Counts,
}

impl Unit for Pressure {
    fn factor(self) -> f64 {
        match self {
            Self::Kpa | Self::Counts => 1.0,
            Self::Pa => 1e-3,
            Self::Hpa => 0.1,
            Self::Bar => 100.0,
            Self::Psi => 6.894_757_293_168,
        }
    }
}

/// Unit of a temperature.
#[derive(Clone, Copy, Debug, Default, Deserialize)]
pub(crate) enum Temperature {
    #[default]
    C,
    K,
    F,
}

impl Temperature {
    /// A temperature in this unit, °C.
    pub(crate) fn celsius(self, temperature: f64) -> f64 {
        match self {
            Self::C => temperature,
            Self::K => temperature - 273.15,
            Self::F => (temperature - 32.0) / 1.8,
        }
    }
}
