//! Errors of the emulated bench.

use twintac_simulate::SimulateError;

/// Why a press or a weight could not be recorded.
#[derive(Debug, thiserror::Error)]
pub enum LabError {
    /// The press could not be set up.
    #[error("press `{press}`: {source}")]
    Simulate {
        /// The press's name.
        press: String,
        /// The cause.
        source: SimulateError,
    },
    /// The solver of the gel did not converge before the end of the press.
    #[error("press `{press}`: the emulated gel did not converge {why}")]
    NotConverged {
        /// The press's name.
        press: String,
        /// Where and why it did not converge.
        why: String,
    },
    /// The shape of the gel is given by a file, and such a shape cannot be stretched.
    #[error(
        "sensor `{sensor}`: a gel from an STL file can't be cast {ratio} times as high; set `height_ratio` to 1 in the emulator configuration"
    )]
    Height {
        /// The sensor's name.
        sensor: String,
        /// Ratio of the height to the described height.
        ratio: f64,
    },
    /// The plan names an indenter that the sensor's description lacks.
    #[error("press `{press}`: there is no indenter `{indenter}` in the sensor's description")]
    NoIndenter {
        /// The press's name.
        press: String,
        /// The indenter's name.
        indenter: String,
    },
}
