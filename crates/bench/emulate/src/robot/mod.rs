//! The robot: the controller of a UFACTORY xArm, as its clients see it on their sockets.
//!
//! The codecs of `twintac-rig` make and read the frames, in the other direction. Further requests
//! of the manufacturer's client, xArm-Python-SDK, are answered as far as that client needs it. The
//! arm has no kinematics: its tool follows poses, and its joint angles never change.

mod arm;
mod controller;
mod other;
mod report;
mod server;
mod settings;

pub(crate) use arm::Arm;
pub use arm::ArmSettings;
pub use controller::Controller;
pub use server::RobotServer;
pub(crate) use server::listen;
pub use settings::{Rates, RobotSettings};
