//! Streams poses that the robot follows at once.
//!
//! The robot keeps no queue: only the latest pose counts. The client does not wait for responses to
//! poses. It takes them in as they come.

use std::time::{Duration, Instant};

use super::client::late;
use super::pose_stream::{PERIOD, PoseStream, longest_step_mm};
use super::{Client, Command, Incoming, Mode, MotionState, MoveTo, SetState, Wire};
use crate::{Device, RigError, TcpPose};

/// Most frames that are taken in at once: the responses of many periods, so that endless feedback
/// cannot hold the loop.
const MOST_FRAMES: usize = 256;
/// Time that the robot needs to change to servo mode.
const SETTLES: Duration = Duration::from_millis(100);

impl<W: Wire> Client<W> {
    /// Puts an enabled robot into servo mode where it is, and returns its pose. The first pose must
    /// be near it.
    ///
    /// # Errors
    /// Those of [`Client::call`], and a robot that is not ready.
    pub fn begin_servo(&mut self) -> Result<TcpPose, RigError> {
        self.set_mode(Mode::Servo)?;
        self.set_state(SetState::Motion)?;
        std::thread::sleep(SETTLES);
        let state = self.state()?;
        if !matches!(state, MotionState::Ready | MotionState::Moving) {
            return Err(refused(format!("the robot is {state}"), "enable it again"));
        }
        let last = self.pose()?;
        self.servo = Some(PoseStream::at(last));
        Ok(last)
    }

    /// Sends a pose when it is due, and does not wait for the response. Poses are due every 4 ms.
    /// After a late pose the next one may follow sooner, but not before 2 ms. Any error ends the
    /// stream, and the robot holds the last pose that it accepted.
    ///
    /// # Errors
    /// Those of [`Client::hear`]; a pose with a NaN, too far from the last one or too fast; no
    /// stream was begun.
    pub fn servo(&mut self, pose: &TcpPose) -> Result<(), RigError> {
        if let Some(servo) = self.servo {
            std::thread::sleep(servo.due.saturating_duration_since(Instant::now()));
            self.hear()?;
        }
        let Some(servo) = self.servo.take() else {
            return Err(refused("no stream of poses was started".to_owned(), "start one"));
        };
        let step_mm = pose.distance_mm(&servo.last);
        let longest_mm = longest_step_mm(servo.sent.elapsed());
        let is_near = step_mm <= longest_mm;
        if !is_near || !pose.is_finite() {
            return Err(refused(
                format!("a step of {step_mm:.3} mm, above the limit of {longest_mm:.3} mm"),
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

    /// Takes in the responses to poses that have arrived, and waits for none. Returns for how long
    /// the oldest missing response has been missing. After an error it asks for the error's code
    /// and waits 4 ms for it. Any error ends the stream.
    ///
    /// # Errors
    /// A connection that fails; responses to another request or with state bits of an error; a
    /// response that is missing for too long ([`Client::set_answer_within`]).
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
                    "that of a command",
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

    /// Ends the stream of poses. Responses to poses that were sent may still come.
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
