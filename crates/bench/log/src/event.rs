//! Single events.

use glam::DVec3;
use serde::{Deserialize, Serialize};
use twintac_recording::Control;

use crate::Stream;

/// Something that happened once. In files it is JSON, with the kind in the field `event`.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(tag = "event", rename_all = "kebab-case")]
#[non_exhaustive]
pub enum Event {
    /// A press begins. The indenter does not touch the gel yet.
    PressBegun {
        /// Name of the press.
        name: String,
        /// Name of the indenter in the sensor description.
        indenter: String,
        /// What drives the indenter.
        control: Control,
    },
    /// A press has ended. The indenter does not touch the gel any more.
    PressEnded {
        /// Name of the press.
        name: String,
    },
    /// The readings of the force/torque sensor that are zero load from now on, relative to the
    /// sensor's own zero.
    Tare {
        /// Force to subtract, N, in the sensor's frame.
        force_n: DVec3,
        /// Torque to subtract, N mm, in the sensor's frame.
        torque_n_mm: DVec3,
    },
    /// Messages are missing.
    Gap {
        /// The stream. `None`: all streams.
        stream: Option<Stream>,
        /// The cause.
        cause: String,
        /// Its start on the bench clock, ns.
        from_ns: u64,
        /// Its end on the bench clock, ns.
        to_ns: u64,
        /// Number of missing messages, if known.
        lost: Option<u64>,
    },
    /// The test setup stopped early.
    Stopped {
        /// The cause.
        cause: String,
    },
    /// A note of a person.
    Note {
        /// The text.
        text: String,
    },
}

impl Event {
    /// Whether every number can be written as JSON.
    pub(crate) fn is_finite(&self) -> bool {
        match self {
            Self::Tare { force_n, torque_n_mm } => force_n.is_finite() && torque_n_mm.is_finite(),
            _ => true,
        }
    }
}
