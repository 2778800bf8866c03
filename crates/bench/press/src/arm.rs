//! What moves the indenter.

use twintac_rig::xarm::{Client, Wire};
use twintac_rig::{RigError, TcpPose};

/// A robot that follows servo poses.
pub trait Arm {
    /// Sends a pose, to be followed at once, and waits for nothing.
    ///
    /// # Errors
    /// The pose cannot be sent, or an earlier one was refused.
    fn servo(&mut self, pose: &TcpPose) -> Result<(), RigError>;

    /// Takes in the answers that have come, and waits for none; for how long the oldest one that is missing has been missing, s.
    ///
    /// # Errors
    /// A pose was refused.
    fn hear(&mut self) -> Result<f64, RigError>;

    /// Stops the robot until a person has it enabled anew: at once, then waits for it to confirm.
    ///
    /// # Errors
    /// The robot does not confirm: it may be moving.
    fn stop(&mut self) -> Result<(), RigError>;

    /// The error that it has, in words, if it has one and says so.
    fn error(&mut self) -> Option<String>;
}

/// After [`Client::begin_servo`].
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
