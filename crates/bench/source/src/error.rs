//! What can go wrong between a sensor and its frames.

use twintac_config::ConfigError;
use twintac_log::LogError;

/// What was expected of a sensor or a wire, and what was found.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum SourceError {
    /// The description is of a sensor that is not read this way.
    #[error("sensor {sensor}: {problem}")]
    Sensor {
        /// Name of the description.
        sensor: String,
        /// What is wrong with it.
        problem: String,
    },
    /// Frames on the line are of another sensor.
    #[error(
        "the sensor has {n_taxels} taxels; frames that the line's description describes have {n_pressures} pressures"
    )]
    Taxels {
        /// Taxels of the sensor.
        n_taxels: usize,
        /// Pressures of a frame.
        n_pressures: usize,
    },
    /// The wire could not be opened.
    #[error("cannot open {wire}: {problem}")]
    Open {
        /// The bus, port or address as the user named it.
        wire: String,
        /// What the operating system says.
        problem: String,
    },
    /// The wire gives no frame.
    #[error("no frame comes from the sensor: {problem}")]
    Wire {
        /// What the driver or the operating system says.
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
    /// Somebody says what counts stand for, of chips that say so themselves.
    #[error("the sensor's chips say themselves what they count; leave the scale out (`--scale`)")]
    NothingToScale,
    /// Chips that know their scale do not read free air.
    #[error(
        "{n_free} of {n_read} taxels read free air: {notes}; lift what touches the sensor, or say how high the place is (`--altitude-m`)"
    )]
    NotFreeAir {
        /// Taxels that read free air.
        n_free: usize,
        /// Taxels that read anything.
        n_read: usize,
        /// What is odd, a sentence each.
        notes: String,
    },
    /// How the line is written is not as described.
    #[error(transparent)]
    Line(#[from] ConfigError),
    /// A log could not be played.
    #[error(transparent)]
    Log(#[from] LogError),
    /// The reading thread could not be started, or it died.
    #[error("the reading thread: {problem}")]
    Thread {
        /// What is known of it.
        problem: String,
    },
    /// The source has no further frames.
    #[error("there are no further frames")]
    Over,
}

pub(crate) fn bus_error<E: std::fmt::Debug>(error: phystac::Error<E>) -> SourceError {
    SourceError::Wire {
        problem: error.to_string(),
    }
}
