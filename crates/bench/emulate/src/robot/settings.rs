//! Settings of the robot.

use glam::DVec3;
use serde::{Deserialize, Serialize};
use twintac_rig::TcpPose;

use super::ArmSettings;
use crate::EmulateError;
use crate::error::check_positive;

/// Settings of the robot and its sockets.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct RobotSettings {
    /// TCP ports for commands, normal, rich and development reports. 0: any free port.
    pub ports: [u16; 4],
    /// The version text: axes, type, serial numbers of arm and control box, firmware.
    pub version: String,
    /// Pose of the tool at the start.
    pub first_pose: TcpPose,
    /// Corners of the box that the tool can reach, mm.
    pub reach_mm: [DVec3; 2],
    /// Longest step from one servo pose to the next, mm.
    pub max_step_mm: f64,
    /// How the arm follows its goal.
    pub arm: ArmSettings,
    /// Rates of its reports.
    pub rates: Rates,
}

/// Reports per second, Hz.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct Rates {
    /// Of the normal socket.
    pub normal_hz: f64,
    /// Of the rich socket.
    pub rich_hz: f64,
    /// Of the development socket.
    pub development_hz: f64,
}

impl Default for Rates {
    /// The rates of the manufacturer: 5, 5 and 100 a second.
    fn default() -> Self {
        Self {
            normal_hz: 5.0,
            rich_hz: 5.0,
            development_hz: 100.0,
        }
    }
}

impl Default for RobotSettings {
    /// An xArm6 with the tool pointing down, 200 mm in front of it and 150 mm above its base.
    fn default() -> Self {
        Self {
            ports: [0; 4],
            version: "6,6,XI1200,AC1200,v1.11.0".to_owned(),
            first_pose: TcpPose {
                position_mm: DVec3::new(200.0, 0.0, 150.0),
                roll_pitch_yaw_rad: DVec3::new(std::f64::consts::PI, 0.0, 0.0),
            },
            reach_mm: [
                DVec3::new(-750.0, -750.0, -400.0),
                DVec3::new(750.0, 750.0, 1000.0),
            ],
            max_step_mm: twintac_rig::xarm::LONGEST_STEP_MM,
            arm: ArmSettings::default(),
            rates: Rates::default(),
        }
    }
}

impl RobotSettings {
    pub(crate) fn check(&self) -> Result<(), EmulateError> {
        self.arm.check()?;
        if !self.first_pose.is_finite() || !self.reaches(&self.first_pose) {
            return Err(EmulateError::setting("robot.first_pose", "is out of reach"));
        }
        check_positive(&[
            ("robot.max_step_mm", self.max_step_mm),
            ("robot.rates.normal_hz", self.rates.normal_hz),
            ("robot.rates.rich_hz", self.rates.rich_hz),
            ("robot.rates.development_hz", self.rates.development_hz),
        ])
    }

    pub(crate) fn reaches(&self, pose: &TcpPose) -> bool {
        let [low_mm, high_mm] = self.reach_mm;
        pose.position_mm.cmpge(low_mm).all() && pose.position_mm.cmple(high_mm).all()
    }
}
