//! Streams poses that the robot follows at once.
//!
//! The limits are the manufacturer's for its servo mode: at most 250 poses a second, steps of at most 10 mm, at most 1000 mm/s. The
//! robot keeps no queue: only the latest pose counts.

use std::time::{Duration, Instant};

use super::{Client, Command, Mode, MotionState, MoveTo, SetState, Wire};
use crate::{RigError, TcpPose};

/// Longest way from one pose to the next, mm.
pub const LONGEST_STEP_MM: f64 = 10.0;
const PERIOD: Duration = Duration::from_millis(4);
const FASTEST_MM_PER_S: f64 = 1000.0;
/// Time that the robot needs to change to servo mode.
const SETTLES: Duration = Duration::from_millis(100);

/// What a stream of poses remembers.
#[derive(Clone, Copy, Debug)]
pub(super) struct Servo {
    last: TcpPose,
    sent: Instant,
    /// When the next pose may go out.
    due: Instant,
}

impl<W: Wire> Client<W> {
    /// Puts the robot, which was enabled, into servo mode where it is, and returns its pose: the first pose must be near it.
    ///
    /// # Errors
    /// Those of [`Client::call`], and a robot that is not ready.
    pub fn begin_servo(&mut self) -> Result<TcpPose, RigError> {
        self.set_mode(Mode::Servo)?;
        self.set_state(SetState::Motion)?;
        std::thread::sleep(SETTLES);
        let state = self.state()?;
        if !matches!(state, MotionState::Ready | MotionState::Moving) {
            return Err(refused(format!("the robot is {state}"), "enable it anew"));
        }
        let last = self.pose()?;
        let sent = Instant::now();
        let due = sent + PERIOD;
        self.servo = Some(Servo { last, sent, due });
        Ok(last)
    }

    /// Sends a pose when it is due, and waits for the answer. Poses are due every 4 ms: one that comes late may be followed sooner,
    /// after 2 ms at the soonest. After any error the stream has ended, and the robot holds the last pose.
    ///
    /// # Errors
    /// Those of [`Client::call`]; a pose that is no number, too far from the last one or too fast; no stream begun.
    pub fn servo(&mut self, pose: &TcpPose) -> Result<(), RigError> {
        let Some(servo) = self.servo.take() else {
            return Err(refused("no stream of poses was begun".to_owned(), "begin one"));
        };
        std::thread::sleep(servo.due.saturating_duration_since(Instant::now()));
        let step_mm = pose.distance_mm(&servo.last);
        let longest_mm = longest_step_mm(servo.sent.elapsed());
        let is_near = step_mm <= longest_mm;
        if !is_near || !pose.is_finite() {
            return Err(refused(
                format!("a step of {step_mm:.3} mm, where {longest_mm:.3} mm are the most"),
                "send poses closer to each other",
            ));
        }
        let sent = Instant::now();
        self.call(Command::ServoCartesian {
            to: MoveTo {
                pose: *pose,
                speed_mm_per_s: 0.0,
                acceleration_mm_per_s2: 0.0,
            },
            in_tool_frame: false,
        })?;
        let due = (servo.due + PERIOD).max(sent + PERIOD / 2);
        self.servo = Some(Servo {
            last: *pose,
            sent,
            due,
        });
        Ok(())
    }
}

/// Longest step after so long a time, mm: the speed counts over a period at least.
fn longest_step_mm(elapsed: Duration) -> f64 {
    LONGEST_STEP_MM.min(FASTEST_MM_PER_S * elapsed.max(PERIOD).as_secs_f64())
}

fn refused(problem: String, hint: &'static str) -> RigError {
    RigError::Robot {
        command: "servo",
        problem,
        hint,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn steps_are_limited_by_speed_and_then_by_length() {
        assert!((longest_step_mm(Duration::from_millis(2)) - 4.0).abs() < 1e-9);
        assert!((longest_step_mm(Duration::from_millis(6)) - 6.0).abs() < 1e-9);
        assert_eq!(longest_step_mm(Duration::from_secs(1)), 10.0);
    }
}
