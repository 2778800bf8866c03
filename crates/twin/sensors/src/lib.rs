//! Many touch sensors, each with its own variation, stepped in one call.
//!
//! Inputs of a step are rigid bodies, their poses in the frame of each sensor, mm, and the time
//! since the last step, s. Outputs are the reading of each taxel, kPa, and the force, N, and
//! torque, N mm, on each gel. All outputs are `simulated`.
//!
//! - [`SensorBatch`]: sensors of one kind. The surrogate of the gel gives the pressures at the
//!   ports. A trained twin, if there is one, adds its gains, static nonlinearity of the ports and
//!   viscoelastic relaxation. [`SensorVariation`] adds what differs from sensor to sensor.
//! - [`CoupledBatch`]: the same, with friction and damping between bodies and gels ([`Coupling`]),
//!   for bodies that move freely.
//! - [`SensorVariation`]: the distributions that each sensor's deviations are drawn from, in TOML.
//! - [`SensorState`]: everything of one sensor that a step changes.
//!
//! # How it works
//!
//! ```text
//! poses ─► installation: the pose of each sensor, as it deviates from the described one
//!       ─► surrogate (twintac-fast): pressures at the ports, force and torque
//!       ─► CoupledBatch alone: friction and damping
//!       ─► twin (digitac), if there is one: what ideal barometers read
//!       ─► each sensor's variation: hysteresis, cross-talk, gain, growth, zero, temperature
//!          drift, noise, resolution, faults, frame rate
//!       ─► readings
//! ```
//!
//! ```text
//! batch         SensorBatch: many sensors on several threads
//! coupled, hold CoupledBatch, and what gels hold between steps
//! chunk         the sensors of one thread
//! sensor        the drawn deviations of one sensor, and how they change its readings
//! variation  the distributions, and their file
//! state         the state of one sensor
//! ```
//!
//! A [`SensorBatch`] gives each thread its own sensors, from poses to readings, in one parallel
//! region for each step. With a single thread the thread pool is not used.
//! `cargo xtask bench sensors` measures the rate, and
//! `crates/twin/sensors/examples/rate/profile.py` counts the instructions of a step by function.
//!
//! The deviations of a sensor are drawn from a random stream of the seed and the sensor's number.
//! They do not depend on the other sensors, or on the number of threads.
//!
//! Friction and damping are a type of their own, [`CoupledBatch`]. Its steps take a [`TouchId`]
//! with each touch, because the state of a contact belongs to the thing that touches, not to the
//! thing's shape or its position in a list.
//!
//! The crate does not depend on solvers or on the emulated bench.

mod batch;
mod chunk;
mod coupled;
mod hold;
mod sensor;
mod state;
mod variation;

pub use batch::{SensorBatch, most_sensors};
pub use coupled::{CoupledBatch, TouchedTwice};
pub use hold::{Coupling, HeldTouch, TouchId};
pub use state::SensorState;
pub use variation::SensorVariation;
