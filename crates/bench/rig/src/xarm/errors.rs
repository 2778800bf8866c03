//! Error and warning codes of the robot's controller.

use std::fmt;

/// A code that the controller reports.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ControllerCode {
    /// The robot stopped.
    Error(u8),
    /// The robot continues, but not as asked.
    Warning(u8),
}

impl ControllerCode {
    /// The more severe of an error code and a warning code, if one of them is set.
    #[must_use]
    pub fn of(error: u8, warning: u8) -> Option<Self> {
        match (error, warning) {
            (0, 0) => None,
            (0, warning) => Some(Self::Warning(warning)),
            (error, _) => Some(Self::Error(error)),
        }
    }

    /// What it means.
    #[must_use]
    pub fn name(self) -> &'static str {
        self.words().0
    }

    /// What to do about it.
    #[must_use]
    pub fn hint(self) -> &'static str {
        self.words().1
    }

    fn words(self) -> (&'static str, &'static str) {
        match self {
            Self::Error(1..=3) => (
                "emergency stop",
                "make sure that all is safe, release the button, enable the robot again",
            ),
            Self::Error(10..=17) => ("a servo motor reports an error", "switch the robot off and on"),
            Self::Error(18 | 19 | 28) => (
                "no communication with the end effector",
                "check the cable and the end effector, then enable the robot again",
            ),
            Self::Error(21) => (
                "kinematic error",
                "choose poses in which the arm is less stretched or folded",
            ),
            Self::Error(22) => ("the arm would collide with itself", "choose another path"),
            Self::Error(23) => (
                "a joint is beyond its limit",
                "move the joint back by hand, choose other poses",
            ),
            Self::Error(24) => (
                "a joint is too fast",
                "go more slowly, or farther from singular poses",
            ),
            Self::Error(25) => ("the path cannot be planned", "choose another path"),
            Self::Error(31) => (
                "collision: a motor draws too much current",
                "find out what the arm has hit, and check payload and sensitivity",
            ),
            Self::Error(35) => ("outside the safety boundary", "choose poses inside the boundary"),
            Self::Error(40) => ("no joint angles reach this pose", "choose another pose"),
            Self::Error(50..=53) => (
                "the robot's own force/torque sensor reports an error",
                "check the sensor, then enable it again",
            ),
            Self::Warning(11) => ("the command queue is full", "send commands more slowly"),
            Self::Warning(12) => (
                "a command's parameter is not valid",
                "check the command's numbers",
            ),
            Self::Warning(14) => ("no joint angles reach this pose", "choose another pose"),
            Self::Error(_) | Self::Warning(_) => {
                ("unknown code", "look the code up in the controller's manual")
            }
        }
    }
}

impl fmt::Display for ControllerCode {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let (kind, code) = match self {
            Self::Error(code) => ("error", code),
            Self::Warning(code) => ("warning", code),
        };
        write!(f, "{kind} {code} ({}; {})", self.name(), self.hint())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn codes_have_names_and_remedies() {
        assert_eq!(ControllerCode::of(0, 0), None);
        assert_eq!(ControllerCode::of(0, 14), Some(ControllerCode::Warning(14)));
        let collision = ControllerCode::of(31, 14).unwrap();
        assert!(
            collision
                .to_string()
                .starts_with("error 31 (collision: a motor draws too much current; find")
        );
        let named = (1..=255).filter(|code| ControllerCode::Error(*code).name() != "unknown code");
        assert_eq!(named.count(), 3 + 8 + 3 + 5 + 1 + 1 + 1 + 4);
    }
}
