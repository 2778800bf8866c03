//! Interpolation between two poses.

use glam::DQuat;
use twintac_rig::TcpPose;

/// Interpolates between two poses by a fraction from 0 to 1, along the line and the shorter
/// rotation.
pub(crate) fn mix_poses(one: &TcpPose, other: &TcpPose, fraction: f64) -> TcpPose {
    let position_mm = one.position_mm.lerp(other.position_mm, fraction);
    if one.roll_pitch_yaw_rad == other.roll_pitch_yaw_rad {
        return TcpPose {
            position_mm,
            roll_pitch_yaw_rad: one.roll_pitch_yaw_rad, // the same bits
        };
    }
    let turn: DQuat = one.base_from_tool().slerp(other.base_from_tool(), fraction);
    TcpPose::new(position_mm, turn)
}
