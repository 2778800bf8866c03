//! The robot that moves the indenter.

use twintac_rig::xarm::{Client, Wire};
use twintac_rig::{RigError, TcpPose};

/// A robot that follows servo poses.
pub trait Arm {
    /// Sends a pose that the robot follows at once, and does not wait.
    ///
    /// # Errors
    /// The pose cannot be sent, or an earlier one was refused.
    fn servo(&mut self, pose: &TcpPose) -> Result<(), RigError>;

    /// Takes in the responses that have arrived, and does not wait. Returns for how long the oldest
    /// missing response has been missing, s.
    ///
    /// # Errors
    /// A pose was refused.
    fn hear(&mut self) -> Result<f64, RigError>;

    /// Stops the robot at once, then waits for its confirmation. A person must enable it again.
    ///
    /// # Errors
    /// The robot does not confirm, so it may be moving.
    fn stop(&mut self) -> Result<(), RigError>;

    /// The present error of the robot as a text, if it has one and reports it.
    fn error(&mut self) -> Option<String>;
}

/// For use after [`Client::begin_servo`].
impl<W: Wire> Arm for Client<W> {
    fn servo(&mut self, pose: &TcpPose) -> Result<(), RigError> {
        self.servo(pose)
    }

    fn hear(&mut self) -> Result<f64, RigError> {
        self.hear().map(|missing| missing.as_secs_f64())
    }

    fn stop(&mut self) -> Result<(), RigError> {
        self.stop()
    }

    fn error(&mut self) -> Option<String> {
        let code = self.errors().ok().flatten();
        code.map(|code| format!("the robot's controller says: {code}"))
    }
}
