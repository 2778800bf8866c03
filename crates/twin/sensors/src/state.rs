//! What a sensor is and remembers at a moment.

use digitac::TwinMemory;

use crate::hold::Holds;
use crate::sensor::Sensor;

/// What a sensor is and remembers at a moment: its imperfections and the random numbers to come,
/// its twin's memory, and what its gel holds. Set back with
/// [`SensorBatch::set_state`](crate::SensorBatch::set_state), the sensor goes on to the same bits.
#[derive(Clone, Debug)]
pub struct SensorState {
    pub(crate) sensor: Sensor,
    pub(crate) holds: Holds,
    /// `None` without a twin.
    pub(crate) twin: Option<TwinMemory>,
    /// What the gel showed last. `[n_taxels]`
    pub(crate) pressure_kpa: Vec<f32>,
}

impl SensorState {
    /// Number of taxels of the sensor.
    #[must_use]
    pub fn n_taxels(&self) -> usize {
        self.pressure_kpa.len()
    }

    /// Whether it is that of a sensor with a twin.
    #[must_use]
    pub fn has_twin(&self) -> bool {
        self.twin.is_some()
    }
}
