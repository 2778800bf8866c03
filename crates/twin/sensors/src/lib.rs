//! Many touch sensors, each imperfect in its own way, stepped in one call.
//!
//! A [`SensorBatch`] goes from what touches to what barometers would read: the fast gel gives the pressures at the ports, a trained twin, if
//! there is one, its gains, port law and memory, and an [`Imperfection`] what no two sensors have
//! alike. A [`CoupledBatch`] holds what touches it, with friction and loss.
//! All of it is simulated.

mod batch;
mod chunk;
mod coupled;
mod hold;
mod imperfection;
mod sensor;
mod state;

pub use batch::{SensorBatch, most_sensors};
pub use coupled::{CoupledBatch, TouchedTwice};
pub use hold::{Coupling, HeldTouch, TouchId};
pub use imperfection::Imperfection;
pub use state::SensorState;
