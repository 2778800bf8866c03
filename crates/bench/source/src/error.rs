//! Errors between a sensor and its frames.

use twintac_config::ConfigError;
use twintac_log::LogError;

/// What was expected of a sensor or a connection, and what was found.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum SourceError {
    /// The description is of a sensor that cannot be read by this driver.
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
    /// The bus, port or address could not be opened.
    #[error("cannot open {wire}: {problem}")]
    Open {
        /// The bus, port or address as the user named it.
        wire: String,
        /// What the operating system says.
        problem: String,
    },
    /// The bus or line gives no frame.
    #[error("the sensor sends no frames: {problem}")]
    Wire {
        /// What the driver or the operating system says.
        problem: String,
    },
    /// Nobody has confirmed the scale of the counts.
    #[error(
        "{found}; somebody who knows the parts must confirm the scale before counts are read as pressures: {advice}"
    )]
    ScaleUnconfirmed {
        /// The hint from free air.
        found: String,
        /// What to type or to write.
        advice: String,
    },
    /// With the confirmed scale most taxels do not read free air.
    #[error(
        "with {} counts per Pa {n_free} of {n_read} taxels read free air: {found}; lift what touches the sensor, correct the scale, or give the altitude (`--altitude-m`)",
        1.0 / pa_per_count
    )]
    ScaleContradicted {
        /// The confirmed scale, Pa per count.
        pa_per_count: f32,
        /// Number of taxels that read free air.
        n_free: usize,
        /// Number of taxels that gave a reading.
        n_read: usize,
        /// What the taxels read, and the scale with which it would be free air.
        found: String,
    },
    /// A scale was given for chips that know their own scale.
    #[error("the scale of the sensor's chips is known; leave it out (`--scale`)")]
    NothingToScale,
    /// Chips that know their own scale do not read free air.
    #[error(
        "{n_free} of {n_read} taxels read free air: {notes}; lift what touches the sensor, or give the altitude (`--altitude-m`)"
    )]
    NotFreeAir {
        /// Number of taxels that read free air.
        n_free: usize,
        /// Number of taxels that gave a reading.
        n_read: usize,
        /// Observations, one sentence each.
        notes: String,
    },
    /// The description of the line is wrong.
    #[error(transparent)]
    Line(#[from] ConfigError),
    /// A log could not be played.
    #[error(transparent)]
    Log(#[from] LogError),
    /// The reading thread could not be started, or has ended unexpectedly.
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
