//! The robot: a UFACTORY xArm's controller, as its clients see it on their sockets.
//!
//! Frames are made and read by the codecs of `twintac-rig`, in the other direction. What the manufacturer's client, xArm-Python-SDK, asks
//! beyond them is answered as far as that client needs it. The arm has no kinematics: poses are followed, joint angles stay as they are.

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
