//! The straight way back up after a stop, while that is safe.

use glam::DVec3;

use super::Setup;
use crate::TcpPose;

/// State of a retreat.
#[derive(Clone, Debug)]
pub(super) enum Progress {
    /// Not begun. Holds the force of the period before, N.
    Waiting { force_before_n: Option<f64> },
    /// Under way.
    Moving {
        /// The last pose that was released.
        last: TcpPose,
        /// Remaining distance, mm.
        left_mm: f64,
        /// The smallest force since the beginning, N.
        lowest_force_n: f64,
    },
    /// Finished or given up. A retreat that became unsafe once is not resumed.
    Ended,
}

impl Progress {
    /// The next pose, if moving back is safe. `is_safe`: the force sensor is alive, and the robot
    /// is alive and without error. `robot` is the robot's pose or a pose that is farther from the
    /// sensor.
    pub(super) fn next(
        &mut self,
        setup: &Setup,
        is_safe: bool,
        robot: &TcpPose,
        force_n: f64,
    ) -> Option<TcpPose> {
        let noise_n = setup.retreat.force_noise_n;
        let (last, left_mm, lowest_force_n) = match *self {
            Self::Ended => return None,
            Self::Waiting { force_before_n } => {
                let is_steady = force_before_n.is_some_and(|before_n| force_n <= before_n + noise_n);
                if !is_safe || !is_steady {
                    *self = Self::Waiting {
                        force_before_n: is_safe.then_some(force_n),
                    };
                    return None;
                }
                (*robot, setup.retreat.distance_mm, force_n)
            }
            Self::Moving {
                last,
                left_mm,
                lowest_force_n,
            } => {
                let is_falling = force_n <= lowest_force_n + noise_n;
                if !is_safe || !is_falling {
                    *self = Self::Ended;
                    return None;
                }
                (last, left_mm, lowest_force_n.min(force_n))
            }
        };
        let step_mm = (setup.retreat.speed_mm_per_s * setup.servo_period_s)
            .min(setup.limits.step_mm)
            .min(left_mm);
        // The step never goes towards the sensor, neither from the last pose nor from the position
        // where the robot may be.
        let ahead_mm = (last.position_mm - robot.position_mm).dot(setup.approach);
        let position_mm: DVec3 = last.position_mm - setup.approach * (step_mm + ahead_mm.max(0.0));
        if step_mm <= 0.0 || !setup.limits.workspace.contains(position_mm, 0.0) {
            *self = Self::Ended;
            return None;
        }
        let pose = TcpPose { position_mm, ..last };
        *self = Self::Moving {
            last: pose,
            left_mm: left_mm - step_mm,
            lowest_force_n,
        };
        Some(pose)
    }
}
