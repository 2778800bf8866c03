//! What can go wrong on the emulated bench.

use twintac_simulate::SimulateError;

/// Why a press or a weight could not be recorded.
#[derive(Debug, thiserror::Error)]
pub enum LabError {
    /// The press could not be set up.
    #[error("press `{press}`: {source}")]
    Simulate {
        /// The press's name.
        press: String,
        /// Why.
        source: SimulateError,
    },
    /// The gel's own solver gave up before the press was over.
    #[error("press `{press}`: the emulated gel did not converge {why}")]
    NotConverged {
        /// The press's name.
        press: String,
        /// Where and why.
        why: String,
    },
    /// The gel's form is in a file, which the lab does not stretch.
    #[error(
        "sensor `{sensor}`: a gel from an STL file can't be cast {ratio} times as high; give the reality a height_ratio of 1"
    )]
    Height {
        /// The sensor's name.
        sensor: String,
        /// Height over described height.
        ratio: f64,
    },
    /// The plan asks for an indenter that the sensor's description lacks.
    #[error("press `{press}`: there is no indenter `{indenter}` in the sensor's description")]
    NoIndenter {
        /// The press's name.
        press: String,
        /// The indenter's name.
        indenter: String,
    },
}
