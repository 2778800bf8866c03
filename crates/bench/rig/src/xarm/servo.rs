//! Streams poses that the robot follows at once.
//!
//! The robot keeps no queue: only the latest pose counts. Nobody waits for answers to poses: they are taken in as they come.

use std::time::{Duration, Instant};

use super::client::late;
use super::pose_stream::{PERIOD, PoseStream, longest_step_mm};
use super::{Client, Command, Incoming, Mode, MotionState, MoveTo, SetState, Wire};
use crate::{Device, RigError, TcpPose};

/// Frames that are taken in at once: many periods' answers, and no end of feedback.
const MOST_FRAMES: usize = 256;
/// Time that the robot needs to change to servo mode.
const SETTLES: Duration = Duration::from_millis(100);

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
        self.servo = Some(PoseStream::at(last));
        Ok(last)
    }

    /// Sends a pose when it is due, and does not wait for the answer. Poses are due every 4 ms: one that comes late may be followed
    /// sooner, after 2 ms at the soonest. After any error the stream has ended, and the robot holds the last pose that it took.
    ///
    /// # Errors
    /// Those of [`Client::hear`]; a pose with a NaN, too far from the last one or too fast; no stream begun.
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
        self.servo = Some(PoseStream {
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
    /// A connection that fails, answers to something else or with state bits of an error, an answer missing for too long ([`Client::set_answer_within`]).
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
        if missing > self.answer_within {
            return Err(late(&oldest.request, self.answer_within));
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

fn refused(problem: String, hint: &'static str) -> RigError {
    RigError::Robot {
        command: "servo",
        problem,
        hint,
    }
}
