//! Poses of gel and indenter.

use glam::DVec3;
use serde::{Deserialize, Serialize};
use twintac_rig::TcpPose;
use twintac_shape::Pose;

/// The pose of the gel in the robot's base frame, and of the indenter in the tool's frame.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Placement {
    /// Pose of the gel's frame (z up, zero at the board) in the robot's base frame.
    pub base_from_gel: Pose,
    /// Pose of the indenter's frame (z up, zero at its point of first touch) in the tool's frame.
    pub tool_from_indenter: Pose,
    /// Height of the gel's surface above the board, mm.
    pub surface_mm: f64,
    /// Direction in the force sensor's frame. `force · axis` is the force of the indenter on the
    /// gel along -z.
    pub force_axis: DVec3,
}

impl Placement {
    /// The tool's pose for a pose of the indenter. Heights count from the gel's surface at rest,
    /// locations as in the protocol.
    #[must_use]
    pub fn tool(&self, above_surface: &Pose) -> TcpPose {
        let gel = &self.base_from_gel;
        let rotation = gel.rotation * above_surface.rotation * self.tool_from_indenter.rotation.inverse();
        let tip_mm = above_surface.position_mm + self.surface_mm * DVec3::Z;
        let position_mm = gel.transform_point(tip_mm) - rotation * self.tool_from_indenter.position_mm;
        TcpPose::new(position_mm, rotation)
    }

    /// The indenter's pose for a pose of the tool: the inverse of [`tool`](Self::tool).
    #[must_use]
    pub fn indenter(&self, tool: &TcpPose) -> Pose {
        let gel = &self.base_from_gel;
        let base_from_tool = tool.base_from_tool();
        let tip_mm = tool.position_mm + base_from_tool * self.tool_from_indenter.position_mm;
        Pose {
            position_mm: gel.inverse_transform_point(tip_mm) - self.surface_mm * DVec3::Z,
            rotation: gel.rotation.inverse() * base_from_tool * self.tool_from_indenter.rotation,
        }
    }

    /// The direction of pressing in the robot's base frame.
    #[must_use]
    pub fn approach(&self) -> DVec3 {
        self.base_from_gel.rotation * DVec3::NEG_Z
    }
}

#[cfg(test)]
mod tests {
    use glam::DQuat;

    use super::*;

    #[test]
    fn the_tool_is_found_from_the_indenter_and_back() {
        let placement = Placement {
            base_from_gel: Pose {
                position_mm: DVec3::new(300.0, 20.0, 50.0),
                rotation: DQuat::from_rotation_z(0.3) * DQuat::from_rotation_x(0.05),
            },
            tool_from_indenter: Pose {
                position_mm: DVec3::new(1.0, 0.0, 40.0),
                rotation: DQuat::from_rotation_x(std::f64::consts::PI),
            },
            surface_mm: 10.0,
            force_axis: DVec3::NEG_Z,
        };
        let indenter = Pose {
            position_mm: DVec3::new(3.0, -2.0, -1.5),
            rotation: DQuat::from_rotation_z(0.7) * DQuat::from_rotation_y(0.1),
        };
        let back = placement.indenter(&placement.tool(&indenter));
        assert!(back.position_mm.distance(indenter.position_mm) < 1e-9);
        assert!(back.rotation.dot(indenter.rotation).abs() > 1.0 - 1e-12);
        // A tool that points down is above its indenter.
        let level = Placement {
            base_from_gel: Pose::from_position(DVec3::new(300.0, 20.0, 50.0)),
            ..placement
        };
        let tool = level.tool(&Pose::IDENTITY);
        assert!(
            tool.position_mm.distance(DVec3::new(299.0, 20.0, 100.0)) < 1e-9,
            "{tool:?}"
        );
    }
}
