//! What happens once.

use glam::DVec3;
use serde::{Deserialize, Serialize};
use twintac_recording::Control;

use crate::Stream;

/// Something that happened once. In files it is JSON, told apart by `event`.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(tag = "event", rename_all = "kebab-case")]
#[non_exhaustive]
pub enum Event {
    /// A press begins: the indenter does not touch the gel yet.
    PressBegun {
        /// Name of the press.
        name: String,
        /// Name of the indenter in the sensor description.
        indenter: String,
        /// What drives the indenter.
        control: Control,
    },
    /// A press is over: the indenter does not touch the gel any more.
    PressEnded {
        /// Name of the press.
        name: String,
    },
    /// Readings of the force/torque sensor that are no load, from now on; counted from the sensor's own zero.
    Tare {
        /// Force to take off, N, in the sensor's frame.
        force_n: DVec3,
        /// Torque to take off, N mm, in the sensor's frame.
        torque_n_mm: DVec3,
    },
    /// Messages are missing.
    Gap {
        /// Where; `None`: in all streams.
        stream: Option<Stream>,
        /// Why.
        cause: String,
        /// Its start on the bench's clock, ns.
        from_ns: u64,
        /// Its end on the bench's clock, ns.
        to_ns: u64,
        /// How many messages are missing, if that is known.
        lost: Option<u64>,
    },
    /// The bench stopped before its time.
    Stopped {
        /// Why.
        cause: String,
    },
    /// What a person wants to be remembered.
    Note {
        /// Their words.
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
