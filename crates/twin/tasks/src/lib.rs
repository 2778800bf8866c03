//! Tasks of touch for reinforcement learning.
//!
//! A [`Tasks`] holds many environments of one [`Task`]: in each, a sensor with imperfections of its own touches something that nobody sees. One call steps all
//! of them: from actions to poses, through the fast gel and the sensor's imperfections to readings, rewards and the next observations. All of it is simulated.
//!
//! Everything moves slowly enough that the gel is in balance in every frame. Nothing turns or tilts; there is no friction. Places are seen from the gel: x and y along
//! its sides, z out of it, as if the sensor lay still and the object were moved over it; the robot may as well hold the sensor.

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
pub use usual::usual_imperfection;
