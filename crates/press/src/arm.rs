//! What moves the indenter.

use twintac_rig::xarm::{Client, Wire};
use twintac_rig::{RigError, TcpPose};

/// A robot that follows servo poses.
pub trait Arm {
    /// Sends a pose, to be followed at once.
    ///
    /// # Errors
    /// The robot did not take it.
    fn servo(&mut self, pose: &TcpPose) -> Result<(), RigError>;

    /// Stops the robot until a person has it enabled anew.
    ///
    /// # Errors
    /// The robot does not confirm: it may be moving.
    fn stop(&mut self) -> Result<(), RigError>;
}

/// After [`Client::begin_servo`].
impl<W: Wire> Arm for Client<W> {
    fn servo(&mut self, pose: &TcpPose) -> Result<(), RigError> {
        self.servo(pose)
    }

    fn stop(&mut self) -> Result<(), RigError> {
        self.stop()
    }
}
