//! Reports of the robot.

use std::f32::consts::PI;

use twintac_rig::xarm::{Report, ReportPort, RobotStatus, RobotWrench};

use super::Controller;

/// Offsets in rich reports of the type of the arm and of its limits. The manufacturer's client
/// reads these fields, that of `twintac-rig` does not.
const ARM_TYPE: usize = 145;
const LIMITS: usize = 181;

impl Controller {
    /// The present report.
    #[must_use]
    pub fn report(&self) -> Report {
        let (error, warning) = self.errors();
        let zero = RobotWrench {
            external: [0.0; 6],
            raw: [0.0; 6],
        };
        Report {
            state: self.state(),
            mode: self.mode() as u8,
            command_count: self.command_count(),
            joints_rad: self.joints_rad(),
            pose: self.pose(),
            joint_torques: [0.0; 7],
            status: Some(RobotStatus {
                brakes: self.enabled,
                enabled: self.enabled,
                error,
                warning,
                tcp_offset: self.tcp_offset,
                payload: self.payload,
                collision_sensitivity: self.collision_sensitivity,
                teach_sensitivity: self.teach_sensitivity,
                gravity: Some([0.0, 0.0, -1.0]),
            }),
            wrench: Some(zero),
            version: Some(self.settings().version.clone()),
        }
    }

    /// The frame of a report socket.
    #[must_use]
    pub fn report_frame(&self, port: ReportPort) -> Vec<u8> {
        let mut frame = self.report().encode(port);
        if port == ReportPort::Rich {
            let axes_and_type: Vec<u8> = self
                .settings()
                .version
                .split(',')
                .map_while(|word| word.parse().ok())
                .collect();
            if let [axes, arm_type, ..] = axes_and_type[..] {
                frame[ARM_TYPE..ARM_TYPE + 2].copy_from_slice(&[arm_type, axes]);
            }
            // Jerk, smallest and largest acceleration, smallest and largest speed: of the tool in
            // mm, of the joints in radians.
            let limits: [f32; 10] = [2000.0, 0.1, 50_000.0, 0.1, 1000.0, 20.0, 0.01, 20.0, 1e-4, PI];
            for (place, limit) in frame[LIMITS..].chunks_exact_mut(4).zip(limits) {
                place.copy_from_slice(&limit.to_le_bytes());
            }
        }
        frame
    }
}
