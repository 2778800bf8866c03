//! The report that newer firmware sends on its real-time socket.

use super::bytes::{f32s, pose, pose_f32s, put_f32s};
use super::report::{check_size, sized};
use crate::{Device, RigError, TcpPose};

/// A report of the real-time socket.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RealTimeReport {
    /// The controller's clock, in its own unit.
    pub stamp: u64,
    /// Target angles of the joints, radians.
    pub target_joints_rad: [f32; 7],
    /// Measured angles of the joints, radians.
    pub joints_rad: [f32; 7],
    /// Target pose of the tool.
    pub target_pose: TcpPose,
    /// Measured pose of the tool.
    pub pose: TcpPose,
    /// Speed of the tool: translation, mm/s, and rotation, rad/s.
    pub speed: [f32; 6],
}

impl RealTimeReport {
    /// TCP port.
    pub const PORT: u16 = 30000;
    /// Size of the newest known report. A report may be longer.
    const BYTES: usize = 804;
    /// End of the last field that is read.
    const READ_BYTES: usize = 520;

    /// Decodes a report from a frame of [`report_splitter`](super::report_splitter).
    ///
    /// # Errors
    /// A frame that is too short, or whose size differs from the stated one.
    pub fn decode(frame: &[u8]) -> Result<Self, RigError> {
        check_size(frame, Self::READ_BYTES)?;
        let fields = || {
            Some(Self {
                stamp: u64::from_be_bytes(frame.get(4..12)?.try_into().ok()?),
                target_joints_rad: f32s(frame, 32)?,
                joints_rad: f32s(frame, 116)?,
                target_pose: pose(f32s(frame, 424)?),
                pose: pose(f32s(frame, 472)?),
                speed: f32s(frame, 496)?,
            })
        };
        fields().ok_or_else(|| RigError::malformed(Device::Robot, "report", Self::READ_BYTES, frame.len()))
    }

    /// The frame of the report. Fields that are not read are zero.
    #[must_use]
    pub fn encode(&self) -> Vec<u8> {
        let mut frame = sized(Self::BYTES);
        frame[4..12].copy_from_slice(&self.stamp.to_be_bytes());
        put_f32s(&mut frame, 32, &self.target_joints_rad);
        put_f32s(&mut frame, 116, &self.joints_rad);
        put_f32s(&mut frame, 424, &pose_f32s(&self.target_pose));
        put_f32s(&mut frame, 472, &pose_f32s(&self.pose));
        put_f32s(&mut frame, 496, &self.speed);
        frame
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn reports_come_back() {
        let report = RealTimeReport {
            stamp: 0x0102_0304_0506_0708,
            target_joints_rad: [0.1; 7],
            joints_rad: [0.2; 7],
            target_pose: pose([1.0, 2.0, 3.0, 0.5, 0.25, 0.125]),
            pose: pose([4.0, 5.0, 6.0, -0.5, -0.25, -0.125]),
            speed: [7.0; 6],
        };
        let frame = report.encode();
        assert_eq!(frame.len(), 804);
        assert_eq!(frame[..12], [0, 0, 3, 36, 1, 2, 3, 4, 5, 6, 7, 8]);
        assert_eq!(frame[496..500], 7.0_f32.to_le_bytes());
        assert_eq!(RealTimeReport::decode(&frame).unwrap(), report);
        assert!(RealTimeReport::decode(&frame[..803]).is_err());
        assert!(RealTimeReport::decode(&sized(519)).is_err());
    }
}
