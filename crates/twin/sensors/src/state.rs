//! The state of one sensor.

use digitac::TwinMemory;

use crate::hold::Holds;
use crate::sensor::Sensor;

/// The state of one sensor: its deviations and the state of its random stream, the state of its
/// twin, and what its gel holds. A sensor that is set back to it with
/// [`SensorBatch::set_state`](crate::SensorBatch::set_state) continues with the same bits.
#[derive(Clone, Debug)]
pub struct SensorState {
    pub(crate) sensor: Sensor,
    pub(crate) holds: Holds,
    /// `None` without a twin.
    pub(crate) twin: Option<TwinMemory>,
    /// The last pressures of the gel, kPa. `[n_taxels]`
    pub(crate) pressure_kpa: Vec<f32>,
}

impl SensorState {
    /// Number of taxels of the sensor.
    #[must_use]
    pub fn n_taxels(&self) -> usize {
        self.pressure_kpa.len()
    }

    /// Whether the state belongs to a sensor with a twin.
    #[must_use]
    pub fn has_twin(&self) -> bool {
        self.twin.is_some()
    }
}
