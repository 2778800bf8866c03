//! Tasks of touch for reinforcement learning, with many environments in one call.
//!
//! A [`Tasks`] holds environments of one task, a [`Kind`]. In each environment, a sensor with its
//! own variation touches an object that is not observed. One step takes the actions of all
//! environments, each number from -1 to 1, moves the robots, computes the readings with the
//! surrogate of the gel and the sensors' variation, and returns observations, rewards, ends of
//! episodes and figures that are true but not observed ([`Answers`]). [`Tasks::picture`] draws an
//! environment. All readings are `simulated`.
//!
//! Motions are slow enough for the gel to be in equilibrium in every frame. Nothing turns or tilts,
//! and there is no friction. Positions are in the gel's frame, mm: x and y along its sides, z
//! outward, as if the sensor were fixed and the object were moved over it. Whether the robot moves
//! the object or the sensor makes no difference.
//!
//! # How it works
//!
//! ```text
//! kind          the tasks by name; explore_shape, hold_force, follow_edge (with edge): one file
//!               each
//! task          what a task defines for one environment: begin, act, touch, feel, observe
//! chunk         the environments of one thread: all of a step, for any task
//! batch         all environments: one parallel region for each step, autoreset, seeds
//! environment   seed and number of an environment's episode
//! picture       drawing of the readings and of the contact
//! answers       the outputs of a step
//! outline       outlines of shapes, for pictures and for edges that are followed
//! usual         the default sensor variation
//! ```
//!
//! A task knows one environment and no sensor: it returns what touches the sensor, and gets the
//! readings. A `SensorBatch` of `twintac-sensors` is between both, divided into one part for each
//! thread (`into_parts`), so that a step uses the thread pool once. The outputs of all environments
//! are contiguous arrays. The hidden state of an environment takes some hundred bytes, which a step
//! uses once.
//!
//! An episode and its sensor are drawn from a random stream of the environment's seed and the
//! number of the episode. They do not depend on the number of environments, on the ends of other
//! episodes, or on the kind of [`Autoreset`]. An episode begins without contact and with readings
//! of zero, so no sensor has to be evaluated alone.
//!
//! `HoldForce` solves for the equilibrium of gel and spring with one evaluation of the gel for each
//! frame: one step of Newton's method from the frame before, with the slope between the last two
//! evaluations. A test compares the force with that of the spring.
//!
//! The crate does not depend on solvers or on the emulated bench.

mod answers;
mod batch;
mod chunk;
mod edge;
mod environment;
mod explore_shape;
mod follow_edge;
mod hold_force;
mod kind;
mod outline;
mod picture;
mod task;
mod usual;

pub use answers::{Answers, Autoreset};
pub use batch::Tasks;
pub use kind::{Kind, TaskError};
pub use picture::PICTURE_PX;
pub use usual::usual_variation;
