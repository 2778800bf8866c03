//! Reports that the robot sends on its report sockets: a size, then fields at fixed offsets. Newer
//! firmware sends longer reports.

use super::answer::text;
use super::bytes::{f32s, pose, pose_f32s, put_f32s};
use super::{Mode, MotionState};
use crate::{Device, RigError, Splitter, TcpPose};

/// Largest report that is accepted. The longest known report has 804 bytes.
pub const LARGEST_REPORT_BYTES: usize = 4096;
pub(super) const SIZE_BYTES: usize = 4;
/// Size of state, commands, joints, pose and torques, which all reports have.
const COMMON_BYTES: usize = 87;

/// A socket on which the robot sends reports.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ReportPort {
    /// 5 reports a second.
    Normal,
    /// 5 reports a second, with all fields.
    Rich,
    /// 100 reports a second, with forces.
    Development,
}

/// A report.
#[derive(Clone, Debug, PartialEq)]
pub struct Report {
    /// What the robot is doing.
    pub state: MotionState,
    /// Code of the mode. See [`Mode::from_code`].
    pub mode: u8,
    /// Number of commands that wait.
    pub command_count: u16,
    /// Angles of the joints, radians.
    pub joints_rad: [f32; 7],
    /// Pose of the tool.
    pub pose: TcpPose,
    /// Torques of the joints, in the controller's unit.
    pub joint_torques: [f32; 7],
    /// Errors and settings. Normal and rich reports have them.
    pub status: Option<RobotStatus>,
    /// The robot's own force sensor. Newer rich and development reports have it.
    pub wrench: Option<RobotWrench>,
    /// The version of the firmware. Rich reports have it.
    pub version: Option<String>,
}

/// Errors and settings of the robot.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RobotStatus {
    /// Joints whose brakes are released, one bit each.
    pub brakes: u8,
    /// Joints whose motors are on, one bit each.
    pub enabled: u8,
    /// Code of the error. 0 for none.
    pub error: u8,
    /// Code of the warning. 0 for none.
    pub warning: u8,
    /// The tool centre point in the flange's frame.
    pub tcp_offset: TcpPose,
    /// Mass of the payload, kg, and its centre, mm.
    pub payload: [f32; 4],
    /// Sensitivity of the collision detection.
    pub collision_sensitivity: u8,
    /// Sensitivity when the arm is led by hand.
    pub teach_sensitivity: u8,
    /// Direction of gravity in the base frame, if the report has it.
    pub gravity: Option<[f32; 3]>,
}

/// The robot's own force sensor: Fx, Fy, Fz, Tx, Ty, Tz in its own units.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RobotWrench {
    /// Without the weight of the tool.
    pub external: [f32; 6],
    /// As measured.
    pub raw: [f32; 6],
}

/// Splits a report socket's stream into reports.
#[must_use]
pub fn report_splitter() -> Splitter {
    let size = |header: &[u8]| u32::from_be_bytes([header[0], header[1], header[2], header[3]]) as usize;
    Splitter::new(
        Device::Robot,
        SIZE_BYTES,
        size,
        COMMON_BYTES,
        LARGEST_REPORT_BYTES,
    )
}

impl ReportPort {
    /// TCP port.
    #[must_use]
    pub fn number(self) -> u16 {
        match self {
            Self::Normal => 30001,
            Self::Rich => 30002,
            Self::Development => 30003,
        }
    }

    /// Size of the newest known report, and offset of the wrench in it.
    fn layout(self) -> (usize, Option<usize>) {
        match self {
            Self::Normal => (145, None),
            Self::Rich => (587, Some(433)),
            Self::Development => (135, Some(COMMON_BYTES)),
        }
    }
}

impl Report {
    /// Decodes a report from a frame. Fields that are missing in the shorter report of an older
    /// firmware are left out.
    ///
    /// # Errors
    /// A frame that lacks the fields of all reports, or whose size differs from the stated one.
    pub fn decode(port: ReportPort, frame: &[u8]) -> Result<Self, RigError> {
        check_size(frame, COMMON_BYTES)?;
        let short = || RigError::malformed(Device::Robot, "report", COMMON_BYTES, frame.len());
        let status = match port {
            ReportPort::Normal | ReportPort::Rich => RobotStatus::decode(frame),
            ReportPort::Development => None,
        };
        let wrench = port.layout().1.and_then(|at| {
            Some(RobotWrench {
                external: f32s(frame, at)?,
                raw: f32s(frame, at + 24)?,
            })
        });
        let version = match port {
            ReportPort::Rich => frame.get(151..181).map(text),
            _ => None,
        };
        Ok(Self {
            state: MotionState::from_code(frame[4] & 0x0f),
            mode: frame[4] >> 4,
            command_count: u16::from_be_bytes([frame[5], frame[6]]),
            joints_rad: f32s(frame, 7).ok_or_else(short)?,
            pose: pose(f32s(frame, 35).ok_or_else(short)?),
            joint_torques: f32s(frame, 59).ok_or_else(short)?,
            status,
            wrench,
            version,
        })
    }

    /// The mode, if it is a known one.
    #[must_use]
    pub fn known_mode(&self) -> Option<Mode> {
        Mode::from_code(self.mode)
    }

    /// The frame in the newest known layout. Fields that the report lacks are zero.
    #[must_use]
    pub fn encode(&self, port: ReportPort) -> Vec<u8> {
        let (size, wrench_at) = port.layout();
        let mut frame = sized(size);
        frame[4] = (self.state.code() & 0x0f) | self.mode << 4;
        frame[5..7].copy_from_slice(&self.command_count.to_be_bytes());
        put_f32s(&mut frame, 7, &self.joints_rad);
        put_f32s(&mut frame, 35, &pose_f32s(&self.pose));
        put_f32s(&mut frame, 59, &self.joint_torques);
        if let (Some(status), ReportPort::Normal | ReportPort::Rich) = (&self.status, port) {
            status.encode(&mut frame);
        }
        if let (Some(wrench), Some(at)) = (&self.wrench, wrench_at) {
            put_f32s(&mut frame, at, &wrench.external);
            put_f32s(&mut frame, at + 24, &wrench.raw);
        }
        if let (Some(version), ReportPort::Rich) = (&self.version, port) {
            let whole_characters = version.floor_char_boundary(29);
            frame[151..151 + whole_characters].copy_from_slice(&version.as_bytes()[..whole_characters]);
        }
        frame
    }
}

impl RobotStatus {
    fn decode(frame: &[u8]) -> Option<Self> {
        Some(Self {
            brakes: *frame.get(87)?,
            enabled: *frame.get(88)?,
            error: *frame.get(89)?,
            warning: *frame.get(90)?,
            tcp_offset: pose(f32s(frame, 91)?),
            payload: f32s(frame, 115)?,
            collision_sensitivity: *frame.get(131)?,
            teach_sensitivity: *frame.get(132)?,
            gravity: f32s(frame, 133),
        })
    }

    fn encode(&self, frame: &mut [u8]) {
        frame[87..91].copy_from_slice(&[self.brakes, self.enabled, self.error, self.warning]);
        put_f32s(frame, 91, &pose_f32s(&self.tcp_offset));
        put_f32s(frame, 115, &self.payload);
        frame[131..133].copy_from_slice(&[self.collision_sensitivity, self.teach_sensitivity]);
        put_f32s(frame, 133, &self.gravity.unwrap_or_default());
    }
}

/// A frame of zeros that states its size.
pub(super) fn sized(size: usize) -> Vec<u8> {
    let mut frame = vec![0; size];
    frame[..SIZE_BYTES].copy_from_slice(&(size as u32).to_be_bytes()); // a few hundred
    frame
}

/// Checks that a frame has its stated size and at least the smallest size.
pub(super) fn check_size(frame: &[u8], smallest: usize) -> Result<(), RigError> {
    let malformed =
        |expected: String| RigError::malformed(Device::Robot, "report size", expected, frame.len());
    if frame.len() < smallest {
        return Err(malformed(format!("at least {smallest}")));
    }
    let said = u32::from_be_bytes([frame[0], frame[1], frame[2], frame[3]]);
    if said as usize != frame.len() {
        return Err(malformed(said.to_string()));
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use glam::DVec3;

    use super::*;

    pub(crate) fn report() -> Report {
        let pose = |x: f64| TcpPose {
            position_mm: DVec3::new(x, -1.5, 300.0),
            roll_pitch_yaw_rad: DVec3::new(0.5, 0.25, -0.125),
        };
        Report {
            state: MotionState::Moving,
            mode: 1,
            command_count: 258,
            joints_rad: [0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.0],
            pose: pose(200.0),
            joint_torques: [1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 7.0],
            status: Some(RobotStatus {
                brakes: 0x3f,
                enabled: 0x7f,
                error: 31,
                warning: 11,
                tcp_offset: pose(0.0),
                payload: [0.5, 0.0, 0.0, 40.0],
                collision_sensitivity: 3,
                teach_sensitivity: 2,
                gravity: Some([0.0, 0.0, -1.0]),
            }),
            wrench: Some(RobotWrench {
                external: [1.0, 2.0, 3.0, 4.0, 5.0, 6.0],
                raw: [6.0, 5.0, 4.0, 3.0, 2.0, 1.0],
            }),
            version: Some("v2.3.0".into()),
        }
    }

    /// The part of the report that a port's report has.
    fn on(port: ReportPort) -> Report {
        let all = report();
        Report {
            status: all.status.filter(|_| port != ReportPort::Development),
            wrench: all.wrench.filter(|_| port != ReportPort::Normal),
            version: all.version.clone().filter(|_| port == ReportPort::Rich),
            ..all
        }
    }

    #[test]
    fn fields_stand_where_the_manufacturers_client_reads_them() {
        let frame = report().encode(ReportPort::Development);
        assert_eq!(frame.len(), 135);
        assert_eq!(frame[..7], [0, 0, 0, 135, 0x11, 1, 2]);
        assert_eq!(frame[7..11], 0.1_f32.to_le_bytes());
        assert_eq!(frame[35..39], 200.0_f32.to_le_bytes());
        assert_eq!(frame[59..63], 1.0_f32.to_le_bytes());
        assert_eq!(frame[87..91], 1.0_f32.to_le_bytes());
        assert_eq!(frame[111..115], 6.0_f32.to_le_bytes());
        let frame = report().encode(ReportPort::Rich);
        assert_eq!(frame[87..91], [0x3f, 0x7f, 31, 11]);
        assert_eq!(frame[115..119], 0.5_f32.to_le_bytes());
        assert_eq!(frame[131..133], [3, 2]);
        assert_eq!(frame[141..145], (-1.0_f32).to_le_bytes());
        assert_eq!(&frame[151..158], b"v2.3.0\0");
        assert_eq!(frame[433..437], 1.0_f32.to_le_bytes());
        assert_eq!(frame[457..461], 6.0_f32.to_le_bytes());
    }

    #[test]
    fn reports_come_back_and_longer_ones_are_read_as_well() {
        for (port, size) in [
            (ReportPort::Normal, 145),
            (ReportPort::Rich, 587),
            (ReportPort::Development, 135),
        ] {
            let frame = report().encode(port);
            assert_eq!(frame.len(), size);
            assert_eq!(Report::decode(port, &frame).unwrap(), on(port));
            let mut longer = sized(size + 200);
            longer[4..size].copy_from_slice(&frame[4..]);
            assert_eq!(Report::decode(port, &longer).unwrap(), on(port));
        }
    }

    #[test]
    fn a_version_that_is_too_long_is_cut_between_characters() {
        let long = Report {
            version: Some("v".to_owned() + &"…".repeat(10)),
            ..report()
        };
        let found = Report::decode(ReportPort::Rich, &long.encode(ReportPort::Rich)).unwrap();
        assert_eq!(found.version.unwrap(), "v".to_owned() + &"…".repeat(9));
    }

    #[test]
    fn older_reports_lack_what_came_later() {
        let cut = |port: ReportPort, size: usize| {
            let mut frame = sized(size);
            frame[4..].copy_from_slice(&report().encode(port)[4..size]);
            Report::decode(port, &frame)
        };
        assert_eq!(cut(ReportPort::Development, 87).unwrap().wrench, None);
        assert_eq!(
            cut(ReportPort::Normal, 133).unwrap().status.unwrap().gravity,
            None
        );
        let rich = cut(ReportPort::Rich, 245).unwrap();
        assert!(rich.wrench.is_none() && rich.version.is_some() && rich.status == report().status);
        assert!(cut(ReportPort::Normal, 86).is_err());
    }

    #[test]
    fn reports_that_stick_together_are_split() {
        let stream: Vec<u8> = [ReportPort::Normal, ReportPort::Rich, ReportPort::Development]
            .into_iter()
            .flat_map(|port| report().encode(port))
            .collect();
        for size in [1, 100, 300, 900] {
            let mut splitter = report_splitter();
            let mut sizes = Vec::new();
            for mut chunk in stream.chunks(size) {
                while let Some(frame) = splitter.take(&mut chunk).unwrap() {
                    sizes.push(frame.len());
                }
            }
            assert_eq!(sizes, [145, 587, 135]);
        }
        let mut too_large = [0x7f, 0xff, 0xff, 0xff].as_slice();
        assert!(report_splitter().take(&mut too_large).is_err());
    }
}
