//! Limits of a press.

use glam::DVec3;
use serde::{Deserialize, Serialize};

use crate::{RigError, TcpPose};

/// The loads that a sensor can bear, from its description. A test setup can set lower limits, never
/// higher ones.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct SensorLimits {
    /// Largest force, N.
    pub force_n: f64,
    /// Largest depth below the surface, mm.
    pub depth_mm: f64,
}

/// The limits of a test setup.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Limits {
    /// Largest force in any direction, N.
    pub force_n: f64,
    /// Largest depth of the tool's centre point below the surface, along the approach, mm.
    pub depth_mm: f64,
    /// Where the tool's centre point may be.
    pub workspace: Workspace,
    /// Longest step from one pose to the next, mm.
    pub step_mm: f64,
    /// Largest rotation from one pose to the next, radians.
    pub turn_step_rad: f64,
    /// Largest speed, mm/s.
    pub speed_mm_per_s: f64,
}

/// A box in the robot's base frame.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Workspace {
    /// Corner with the smallest coordinates, mm.
    pub min_mm: DVec3,
    /// Corner with the largest coordinates, mm.
    pub max_mm: DVec3,
}

/// How to move back after a stop.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Retreat {
    /// Distance against the approach direction, mm. 0: stay at the position of the stop.
    pub distance_mm: f64,
    /// Speed, mm/s.
    pub speed_mm_per_s: f64,
    /// Force increase that counts as noise, N: a few times the noise of one reading.
    pub force_noise_n: f64,
}

/// Settings of a supervisor.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Setup {
    /// The limits of the test setup.
    pub limits: Limits,
    /// A point of the sensor's surface in the robot's base frame, mm. Depths are counted from it.
    pub surface_mm: DVec3,
    /// The direction of pressing in the robot's base frame, of any length.
    pub approach: DVec3,
    /// Time from one pose to the next, s.
    pub servo_period_s: f64,
    /// Longest silence of the force sensor, s.
    pub force_silence_s: f64,
    /// Longest silence of the robot's reports, s.
    pub robot_silence_s: f64,
    /// How to move back after a stop.
    pub retreat: Retreat,
}

impl Workspace {
    /// Whether a position is inside, within a tolerance in mm. NaN is not inside.
    #[must_use]
    pub fn contains(&self, position_mm: DVec3, tolerance_mm: f64) -> bool {
        position_mm.cmpge(self.min_mm - tolerance_mm).all()
            && position_mm.cmple(self.max_mm + tolerance_mm).all()
    }
}

impl Setup {
    /// Depth below the surface, mm, negative above it. The approach must be a unit vector.
    pub(super) fn depth_mm(&self, position_mm: DVec3) -> f64 {
        (position_mm - self.surface_mm).dot(self.approach)
    }

    /// The setup with the approach as a unit vector, if the setup is valid for the sensor and for
    /// the present pose of the robot.
    pub(super) fn checked(mut self, sensor: &SensorLimits, start: &TcpPose) -> Result<Self, RigError> {
        let limits = &self.limits;
        for (limit, asked, allowed, unit) in [
            ("force", limits.force_n, sensor.force_n, "N"),
            ("depth", limits.depth_mm, sensor.depth_mm, "mm"),
        ] {
            let is_allowed = asked <= allowed;
            if !is_allowed {
                return Err(RigError::LimitRaised {
                    limit,
                    asked,
                    allowed,
                    unit,
                });
            }
        }
        for (field, value) in [
            ("limits.force_n", limits.force_n),
            ("limits.depth_mm", limits.depth_mm),
            ("limits.step_mm", limits.step_mm),
            ("limits.turn_step_rad", limits.turn_step_rad),
            ("limits.speed_mm_per_s", limits.speed_mm_per_s),
            ("servo_period_s", self.servo_period_s),
            ("force_silence_s", self.force_silence_s),
            ("robot_silence_s", self.robot_silence_s),
            ("retreat.speed_mm_per_s", self.retreat.speed_mm_per_s),
        ] {
            if value <= 0.0 || !value.is_finite() {
                return Err(wrong(field, format!("is {value}"), "give a number above zero"));
            }
        }
        for (field, value) in [
            ("retreat.distance_mm", self.retreat.distance_mm),
            ("retreat.force_noise_n", self.retreat.force_noise_n),
        ] {
            if value < 0.0 || !value.is_finite() {
                return Err(wrong(field, format!("is {value}"), "give zero or more"));
            }
        }
        if self.retreat.speed_mm_per_s > limits.speed_mm_per_s {
            let problem = format!(
                "is {} mm/s, above the limit of {} mm/s",
                self.retreat.speed_mm_per_s, limits.speed_mm_per_s
            );
            return Err(wrong("retreat.speed_mm_per_s", problem, "retreat more slowly"));
        }
        if !self.surface_mm.is_finite() {
            let problem = format!("is {}", self.surface_mm);
            return Err(wrong("surface_mm", problem, "give a point"));
        }
        let Some(approach) = self.approach.try_normalize() else {
            let problem = format!("is {}", self.approach);
            return Err(wrong("approach", problem, "give the direction of pressing"));
        };
        self.approach = approach;
        let start_mm = start.position_mm;
        if !start.is_finite() || !self.limits.workspace.contains(start_mm, 0.0) {
            let problem = format!("does not hold the robot's position, {start_mm}");
            let hint = "move the robot, or correct the corners";
            return Err(wrong("limits.workspace", problem, hint));
        }
        if self.depth_mm(start_mm) > self.limits.depth_mm {
            let problem = format!("leaves the robot at a depth of {:.2} mm", self.depth_mm(start_mm));
            return Err(wrong(
                "surface_mm",
                problem,
                "raise the robot, or correct the point",
            ));
        }
        Ok(self)
    }
}

fn wrong(field: &'static str, problem: String, hint: &'static str) -> RigError {
    RigError::Setup { field, problem, hint }
}
