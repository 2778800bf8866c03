//! Many touch sensors, each imperfect in its own way, stepped in one call.
//!
//! A [`SensorBatch`] goes from what touches to what barometers would read: the fast gel gives the pressures at the ports, a trained twin, if
//! there is one, its gains, port law and memory, and an [`Imperfection`] what no two sensors have alike. All of it is simulated.

mod batch;
mod hold;
mod imperfection;
mod sensor;

pub use batch::{SensorBatch, most_sensors};
pub use hold::Coupling;
pub use imperfection::Imperfection;
