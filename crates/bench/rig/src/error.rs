//! Errors of devices and of the test setup.

use std::fmt;
use std::time::Duration;

use twintac_config::ConfigError;

use crate::netft::Status;
use crate::xarm::ControllerCode;

/// A kind of device.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Device {
    /// The robot arm's controller.
    Robot,
    /// The force/torque sensor.
    ForceSensor,
}

impl fmt::Display for Device {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Robot => "robot",
            Self::ForceSensor => "force sensor",
        })
    }
}

/// What was expected of the test setup and what was found.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum RigError {
    /// The operating system could not send to or receive from a device.
    #[error("{device}: {what}: {source}")]
    Transport {
        /// The device.
        device: Device,
        /// What was being done.
        what: String,
        /// What the operating system says.
        source: std::io::Error,
    },
    /// A device did not answer in time.
    #[error("{device}: no answer to {what} within {} s", after.as_secs_f64())]
    Timeout {
        /// The device.
        device: Device,
        /// The request.
        what: String,
        /// How long was waited.
        after: Duration,
    },
    /// A device sent bytes that do not follow its protocol.
    #[error("{device}: {field}: expected {expected}, found {found}")]
    Malformed {
        /// The device.
        device: Device,
        /// The part of the message.
        field: &'static str,
        /// What the protocol has there.
        expected: String,
        /// What was there.
        found: String,
    },
    /// The robot's controller reports an error or a warning.
    #[error("robot: {code} after {command}")]
    Controller {
        /// What it reports.
        code: ControllerCode,
        /// The command that it answered with it.
        command: &'static str,
    },
    /// The robot does not carry out a command, without an error code.
    #[error("robot: {command}: {problem}; {hint}")]
    Robot {
        /// The command.
        command: &'static str,
        /// Why it does not.
        problem: String,
        /// What to do about it.
        hint: &'static str,
    },
    /// The force sensor says that its readings cannot be trusted.
    #[error("force sensor: status {status}")]
    ForceSensorStatus {
        /// Its status bits.
        status: Status,
    },
    /// The force sensor does not do what it was asked to.
    #[error("force sensor: {problem}; {hint}")]
    ForceSensor {
        /// What is wrong.
        problem: String,
        /// What to do about it.
        hint: &'static str,
    },
    /// A limit is set higher than the sensor's description allows.
    #[error(
        "the {limit} limit is set to {asked} {unit}, but the sensor's description allows {allowed} {unit} at most"
    )]
    LimitRaised {
        /// Which limit.
        limit: &'static str,
        /// The value that was asked for.
        asked: f64,
        /// The sensor's own.
        allowed: f64,
        /// Unit of both.
        unit: &'static str,
    },
    /// The setup of the supervisor is not usable.
    #[error("safety: `{field}` {problem}; {hint}")]
    Setup {
        /// The field.
        field: &'static str,
        /// What is wrong, read after the field's name.
        problem: String,
        /// What to do about it.
        hint: &'static str,
    },
    /// A file that people write is wrong.
    #[error(transparent)]
    Description(#[from] ConfigError),
    /// A file or a device's web page lacks something or has something unusable.
    #[error("{file}: {problem}")]
    File {
        /// The file or the address, with a line where there is one.
        file: String,
        /// What is wrong.
        problem: String,
    },
}

impl RigError {
    pub(crate) fn malformed(
        device: Device,
        field: &'static str,
        expected: impl fmt::Display,
        found: impl fmt::Display,
    ) -> Self {
        Self::Malformed {
            device,
            field,
            expected: expected.to_string(),
            found: found.to_string(),
        }
    }

    pub(crate) fn file(file: &str, problem: impl Into<String>) -> Self {
        Self::File {
            file: file.to_owned(),
            problem: problem.into(),
        }
    }
}
