//! What can go wrong between a sensor and an eye.

use twintac_log::LogError;
use twintac_map::MapError;

/// What was expected of a sensor, a terminal or a file, and what was found.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum LiveError {
    /// The description is of a sensor that is not read this way.
    #[error("sensor {sensor}: {problem}")]
    Sensor {
        /// Name of the description.
        sensor: String,
        /// What is wrong with it.
        problem: String,
    },
    /// The bus could not be opened.
    #[error("cannot open {bus}: {problem}")]
    Open {
        /// The bus as the user named it.
        bus: String,
        /// What the operating system says.
        problem: String,
    },
    /// The bus or the switch gives no frame.
    #[error("no frame comes from the sensor: {problem}")]
    Bus {
        /// What the driver says.
        problem: String,
    },
    /// Nobody has confirmed what counts stand for.
    #[error("{found}; counts are no pressure until somebody who knows the parts confirms it: {advice}")]
    ScaleUnconfirmed {
        /// What free air says.
        found: String,
        /// What to type or to write.
        advice: String,
    },
    /// The confirmed scale makes no free air of what most taxels read.
    #[error(
        "with {} counts per Pa {n_free} of {n_read} taxels read free air: {found}; lift what touches the sensor, correct the scale, or say how high the place is (`--altitude-m`)",
        1.0 / pa_per_count
    )]
    ScaleContradicted {
        /// The confirmed scale, Pa per count.
        pa_per_count: f32,
        /// Taxels that read free air.
        n_free: usize,
        /// Taxels that read anything.
        n_read: usize,
        /// What the taxels read, and with which scale it would be free air.
        found: String,
    },
    /// The emulated bench could not be set up.
    #[error("the emulated bench: {0}")]
    Emulate(#[from] twintac_emulate::EmulateError),
    /// The reading thread could not be started, or it died.
    #[error("the reading thread: {problem}")]
    Thread {
        /// What is known of it.
        problem: String,
    },
    /// Rows could not be written.
    #[error("cannot write rows: {0}")]
    Write(std::io::Error),
    /// There is no terminal to draw on.
    #[error("the dashboard: {0}; without a terminal ask for rows, as CSV or JSON lines")]
    Terminal(std::io::Error),
    /// A recording could not be written.
    #[error(transparent)]
    Log(#[from] LogError),
    /// A map could not be prepared.
    #[error(transparent)]
    Map(#[from] MapError),
}

pub(crate) fn bus_error<E: std::fmt::Debug>(error: phystac::Error<E>) -> LiveError {
    LiveError::Bus {
        problem: error.to_string(),
    }
}
