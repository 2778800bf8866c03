//! Provenance of numbers.

use serde::{Deserialize, Serialize};

/// Provenance of a number. Every file and every result carries it.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Provenance {
    /// Measured on hardware.
    Real,
    /// Measured on the emulated test setup.
    Emulated,
    /// Computed by the twin's own simulation.
    Simulated,
}

impl std::fmt::Display for Provenance {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(match self {
            Self::Real => "real",
            Self::Emulated => "emulated",
            Self::Simulated => "simulated",
        })
    }
}
