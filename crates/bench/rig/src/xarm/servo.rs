//! Streams poses that the robot follows at once.
//!
//! The limits are the manufacturer's for its servo mode: at most 250 poses a second, steps of at most 10 mm, at most 1000 mm/s. The
//! robot keeps no queue: only the latest pose counts. Nobody waits for answers to poses: they are taken in as they come.

use std::time::{Duration, Instant};

use super::client::{ANSWER_WITHIN, late};
use super::{Client, Command, Incoming, Mode, MotionState, MoveTo, SetState, Wire};
use crate::{Device, RigError, TcpPose};

/// Longest way from one pose to the next, mm.
pub const LONGEST_STEP_MM: f64 = 10.0;
const PERIOD: Duration = Duration::from_millis(4);
const FASTEST_MM_PER_S: f64 = 1000.0;
/// Frames that are taken in at once: many periods' answers, and no end of feedback.
const MOST_FRAMES: usize = 256;
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

impl Servo {
    /// A stream that begins now, at a pose.
    pub(super) fn at(last: TcpPose) -> Self {
        let sent = Instant::now();
        let due = sent + PERIOD;
        Self { last, sent, due }
    }
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
        self.servo = Some(Servo::at(last));
        Ok(last)
    }

    /// Sends a pose when it is due, and does not wait for the answer. Poses are due every 4 ms: one that comes late may be followed
    /// sooner, after 2 ms at the soonest. After any error the stream has ended, and the robot holds the last pose that it took.
    ///
    /// # Errors
    /// Those of [`Client::hear`]; a pose that is no number, too far from the last one or too fast; no stream begun.
    pub fn servo(&mut self, pose: &TcpPose) -> Result<(), RigError> {
        if let Some(servo) = self.servo {
            std::thread::sleep(servo.due.saturating_duration_since(Instant::now()));
            self.hear()?;
        }
        let Some(servo) = self.servo.take() else {
            return Err(refused("no stream of poses was begun".to_owned(), "begin one"));
        };
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
        let request = self.send(Command::ServoCartesian {
            to: MoveTo {
                pose: *pose,
                speed_mm_per_s: 0.0,
                acceleration_mm_per_s2: 0.0,
            },
            in_tool_frame: false,
        })?;
        self.remember(&request, true);
        let due = (servo.due + PERIOD).max(sent + PERIOD / 2);
        self.servo = Some(Servo {
            last: *pose,
            sent,
            due,
        });
        Ok(())
    }

    /// Takes in the answers to poses that have come, and waits for none; for how long the oldest one that is missing has been missing.
    /// An error's code is asked for, and waited for 4 ms. After any error the stream has ended.
    ///
    /// # Errors
    /// A connection that fails, answers to something else or with state bits of an error, an answer missing for two seconds.
    pub fn hear(&mut self) -> Result<Duration, RigError> {
        let heard = self.take_answers();
        if heard.is_err() {
            self.end_servo();
        }
        heard
    }

    fn take_answers(&mut self) -> Result<Duration, RigError> {
        for _ in 0..MOST_FRAMES {
            let Some(frame) = self.reader.next(None)? else {
                break;
            };
            let Incoming::Response(response) = Incoming::decode(&frame)? else {
                continue;
            };
            let Some(waiting) = self.take_unanswered(&response) else {
                let found = response.transaction;
                return Err(RigError::malformed(
                    Device::Robot,
                    "transaction",
                    "one that was sent",
                    found,
                ));
            };
            if waiting.is_pose {
                response.answer(&waiting.request)?;
                self.check(response.state, &waiting.request.command, PERIOD)?;
            }
        }
        let Some(oldest) = self.unanswered.iter().find(|waiting| waiting.is_pose) else {
            return Ok(Duration::ZERO);
        };
        let missing = oldest.sent.elapsed();
        if missing > ANSWER_WITHIN {
            return Err(late(&oldest.request, ANSWER_WITHIN));
        }
        Ok(missing)
    }

    /// No pose goes out any more; answers to those that did may still come.
    pub(super) fn end_servo(&mut self) {
        self.servo = None;
        for waiting in &mut self.unanswered {
            waiting.is_pose = false;
        }
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
