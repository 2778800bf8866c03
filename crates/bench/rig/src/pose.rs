//! Poses of the robot's tool.

use glam::{DQuat, DVec3, EulerRot};
use serde::{Deserialize, Serialize};

/// Pose of the robot's tool centre point in the robot's base frame.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct TcpPose {
    /// Position, mm.
    pub position_mm: DVec3,
    /// Roll, pitch and yaw, radians: rotations about the x, then the y, then the z axis of the base
    /// frame.
    pub roll_pitch_yaw_rad: DVec3,
}

impl TcpPose {
    /// The pose with a rotation that maps directions from the tool's frame to the base frame.
    #[must_use]
    pub fn new(position_mm: DVec3, base_from_tool: DQuat) -> Self {
        let (yaw, pitch, roll) = base_from_tool.to_euler(EulerRot::ZYX);
        Self {
            position_mm,
            roll_pitch_yaw_rad: DVec3::new(roll, pitch, yaw),
        }
    }

    /// The rotation that maps directions from the tool's frame to the base frame.
    #[must_use]
    pub fn base_from_tool(&self) -> DQuat {
        let angles = self.roll_pitch_yaw_rad;
        DQuat::from_euler(EulerRot::ZYX, angles.z, angles.y, angles.x)
    }

    /// Distance between the positions, mm.
    #[must_use]
    pub fn distance_mm(&self, other: &Self) -> f64 {
        self.position_mm.distance(other.position_mm)
    }

    /// Angle of the rotation from one orientation to the other, from 0 to π, radians.
    #[must_use]
    pub fn turn_rad(&self, other: &Self) -> f64 {
        let between = self.base_from_tool().inverse() * other.base_from_tool();
        // The arc tangent is accurate near zero. The arc cosine is not.
        2.0 * between.xyz().length().atan2(between.w.abs())
    }

    /// Whether all numbers are finite.
    #[must_use]
    pub fn is_finite(&self) -> bool {
        self.position_mm.is_finite() && self.roll_pitch_yaw_rad.is_finite()
    }
}

#[cfg(test)]
mod tests {
    use std::f64::consts::{FRAC_PI_2, PI};

    use proptest::prelude::*;

    use super::*;

    #[test]
    fn a_tool_that_points_down_is_rolled_by_half_a_turn() {
        let pose = TcpPose {
            position_mm: DVec3::ZERO,
            roll_pitch_yaw_rad: DVec3::new(PI, 0.0, 0.0),
        };
        assert!((pose.base_from_tool() * DVec3::Z).distance(DVec3::NEG_Z) < 1e-12);
    }

    #[test]
    fn roll_comes_before_yaw() {
        let pose = TcpPose {
            position_mm: DVec3::ZERO,
            roll_pitch_yaw_rad: DVec3::new(FRAC_PI_2, 0.0, FRAC_PI_2),
        };
        assert!((pose.base_from_tool() * DVec3::Y).distance(DVec3::Z) < 1e-12);
        assert!((pose.base_from_tool() * DVec3::Z).distance(DVec3::X) < 1e-12);
    }

    proptest! {
        #[test]
        fn angles_come_back_from_the_rotation(
            roll in -3.1..3.1_f64, pitch in -1.5..1.5_f64, yaw in -3.1..3.1_f64, turn in 0.0..3.1_f64,
        ) {
            let pose = TcpPose { position_mm: DVec3::X, roll_pitch_yaw_rad: DVec3::new(roll, pitch, yaw) };
            let back = TcpPose::new(DVec3::X, pose.base_from_tool());
            prop_assert!(back.roll_pitch_yaw_rad.distance(pose.roll_pitch_yaw_rad) < 1e-9);
            let turned = TcpPose::new(DVec3::X, pose.base_from_tool() * DQuat::from_rotation_y(turn));
            prop_assert!((pose.turn_rad(&turned) - turn).abs() < 1e-9);
        }
    }
}
