//! Straight back up after a stop, while that is safe.

use glam::DVec3;

use super::Setup;
use crate::TcpPose;

/// How far a retreat has got.
#[derive(Clone, Debug)]
pub(super) enum Progress {
    /// Not begun; the force of the period before, N.
    Waiting { force_before_n: Option<f64> },
    /// Under way.
    Moving {
        /// The pose last let through.
        last: TcpPose,
        /// Way left, mm.
        left_mm: f64,
        /// The smallest force since the beginning, N.
        lowest_force_n: f64,
    },
    /// Over, or given up: what became unsafe once stays so.
    Ended,
}

impl Progress {
    /// The next pose, if going back is safe: whether the force sensor is alive, and the robot is alive and without error. `robot` is a
    /// pose that the robot is at, or nearer to the sensor than.
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
        // Never towards the sensor: neither from the pose before, nor from where the robot may be.
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
