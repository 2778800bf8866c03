//! Why a request is not answered.

/// Why a request is not answered. The texts of what people write are those that the command line has.
#[derive(Debug, thiserror::Error)]
pub(crate) enum EngineError {
    /// A text that is no request.
    #[error("this is no request: {0}")]
    Request(#[from] serde_json::Error),
    /// A request that needs a sensor.
    #[error("there is no sensor yet: open a description first")]
    NoSensor,
    /// A request that needs a mesh.
    #[error("there is no mesh yet: prepare a press first")]
    NoPress,
    /// A request that needs a sensor on the desk.
    #[error("there is no sensor on the desk: connect one first")]
    NoDesk,
    /// A sensor on the desk of another kind.
    #[error(
        "frames have {n_pressures} pressures, and the description of the sensor has {n_taxels} taxels: open the description of the sensor that is connected"
    )]
    Taxels {
        /// Of the description.
        n_taxels: usize,
        /// Of a frame.
        n_pressures: usize,
    },
    /// A description that can't be used.
    #[error(transparent)]
    Sensor(#[from] twintac_sensor::SensorError),
    /// A press that can't be.
    #[error(transparent)]
    Simulate(#[from] twintac_simulate::SimulateError),
    /// A shape that can't be.
    #[error(transparent)]
    Shape(#[from] twintac_shape::ShapeError),
    /// A setting out of its range.
    #[error("`{field}` is {found}; give {expected}")]
    Setting {
        /// The setting.
        field: &'static str,
        /// What was found.
        found: f64,
        /// What was expected.
        expected: &'static str,
    },
}
