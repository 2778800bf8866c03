//! Press protocols (TOML files), planned for a sensor.

use std::path::Path;

use twintac_protocol::{LoadPlan, PressPlan, Protocol, Target};
use twintac_sensor::Sensor;

use crate::WorkError;
use crate::files::read_text;

/// The presses and loads of a protocol on one sensor.
#[derive(Clone, Debug, PartialEq)]
pub struct Planned {
    /// The presses, in order.
    pub presses: Vec<PressPlan>,
    /// The weights that are put on after the presses.
    pub loads: Vec<LoadPlan>,
}

impl Planned {
    /// Reads a protocol and plans it. The seed decides what the protocol draws at random.
    ///
    /// # Errors
    /// A file that cannot be read or is wrong; indenters or taxels that the sensor does not have.
    pub fn read(protocol: &Path, sensor: &Sensor, seed: u64) -> Result<Self, WorkError> {
        Self::parse(
            &protocol.display().to_string(),
            &read_text(protocol)?,
            sensor,
            seed,
        )
    }

    /// Plans a protocol from its text. Error messages name `file`.
    ///
    /// # Errors
    /// Those of [`read`](Self::read).
    pub fn parse(file: &str, text: &str, sensor: &Sensor, seed: u64) -> Result<Self, WorkError> {
        Self::of(&Protocol::parse(file, text)?, sensor, seed)
    }

    /// Plans a protocol.
    ///
    /// # Errors
    /// Indenters or taxels that the sensor does not have.
    pub fn of(protocol: &Protocol, sensor: &Sensor, seed: u64) -> Result<Self, WorkError> {
        let target = target(sensor);
        Ok(Self {
            presses: protocol.plan(&target, seed)?,
            loads: protocol.loads(&target, seed)?,
        })
    }
}

/// The part of a sensor's description that a protocol needs.
#[must_use]
pub fn target(sensor: &Sensor) -> Target {
    let indenters = sensor.indenters.iter().map(|indenter| indenter.name.clone());
    let taxels = sensor.taxels.iter();
    Target {
        indenters: indenters.collect(),
        taxels: taxels
            .map(|taxel| (taxel.name.clone(), [taxel.position_mm.x, taxel.position_mm.y]))
            .collect(),
    }
}
