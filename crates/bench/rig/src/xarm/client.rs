//! Sends commands to the robot and waits for their answers.

use std::collections::VecDeque;
use std::net::{TcpStream, ToSocketAddrs};
use std::time::{Duration, Instant};

use super::frame_reader::{FrameReader, transport};
use super::pose_stream::PoseStream;
use super::{
    Answer, Command, ControllerCode, Incoming, Mode, MotionState, MoveTo, PROTOCOL, Request, Response,
    ResponseState, SetState, Wire, splitter,
};
use crate::{Device, RigError, TcpPose};

const ANSWER_WITHIN: Duration = Duration::from_secs(2);
/// Switching motors on takes longer than other commands.
const ENABLE_WITHIN: Duration = Duration::from_secs(5);
const POLL: Duration = Duration::from_millis(20);
/// Tolerance of the end of a move, mm and radians.
const ARRIVED_MM: f64 = 0.1;
const ARRIVED_RAD: f64 = 0.01;
/// Most requests whose responses may still come: more than the number of poses in the longest time
/// that a response may take.
const MOST_UNANSWERED: usize = 1024;

/// A connection to the robot's command socket.
///
/// Call [`Client::enable`], [`Client::move_to`] to a first pose, [`Client::begin_servo`], then
/// [`Client::servo`] in each period. Any error in servo mode ends the stream of poses: look at the
/// error, and begin again with `enable`. The client does not wait for responses to poses;
/// [`Client::hear`] returns for how long a response has been missing. A client that is dropped in
/// servo mode stops the robot.
#[derive(Debug)]
pub struct Client<W: Wire> {
    pub(super) reader: FrameReader<W>,
    transaction: u16,
    pub(super) unanswered: VecDeque<Unanswered>,
    /// The byte that firmware from 1.10 on expects beside a mode.
    detection: Option<u8>,
    pub(super) servo: Option<PoseStream>,
    pub(super) answer_within: Duration,
}

/// A request that was sent.
#[derive(Clone, Debug)]
pub(super) struct Unanswered {
    pub(super) request: Request,
    pub(super) sent: Instant,
    /// Whether it is a pose of the present stream, and not a request that was given up.
    pub(super) is_pose: bool,
}

impl<W: Wire> Drop for Client<W> {
    fn drop(&mut self) {
        if self.servo.is_some() {
            let _ = self.stop(); // nobody can be told the result
        }
    }
}

impl Client<TcpStream> {
    /// Connects by TCP, for example to `(host, PORT)`.
    ///
    /// # Errors
    /// An address that does not exist or does not answer within two seconds.
    pub fn connect(address: impl ToSocketAddrs) -> Result<Self, RigError> {
        let stream = connect(address)?;
        stream
            .set_nodelay(true)
            .and_then(|()| stream.set_write_timeout(Some(ANSWER_WITHIN)))
            .map_err(|found| transport("setting a time-out", found))?;
        Ok(Self::new(stream))
    }
}

/// Connects to the first address that answers.
pub(super) fn connect(address: impl ToSocketAddrs) -> Result<TcpStream, RigError> {
    let mut last = std::io::ErrorKind::NotFound.into();
    for address in address
        .to_socket_addrs()
        .map_err(|found| transport("looking up the address", found))?
    {
        match TcpStream::connect_timeout(&address, ANSWER_WITHIN) {
            Ok(stream) => return Ok(stream),
            Err(found) => last = found,
        }
    }
    Err(transport("connecting", last))
}

impl<W: Wire> Client<W> {
    /// A client on an open connection.
    #[must_use]
    pub fn new(wire: W) -> Self {
        Self {
            reader: FrameReader::new(wire, splitter()),
            transaction: 0,
            unanswered: VecDeque::new(),
            detection: Some(0),
            servo: None,
            answer_within: ANSWER_WITHIN,
        }
    }

    /// Sets how long the client waits for a response. Default: two seconds. Switching motors on may
    /// always take five seconds.
    pub fn set_answer_within(&mut self, within: Duration) {
        self.answer_within = within;
    }

    /// Clears error and warning, switches the motors on, and makes the robot ready for moves to
    /// positions.
    ///
    /// # Errors
    /// Those of [`Client::call`]. An error that cannot be cleared is named.
    pub fn enable(&mut self) -> Result<(), RigError> {
        let version = self.version()?;
        self.detection = wants_detection(&version).then_some(0);
        self.clean_errors()?;
        self.call(Command::MotionEnable {
            axis: Command::ALL_AXES,
            on: true,
        })?;
        self.set_mode(Mode::Position)?;
        self.set_state(SetState::Motion)
    }

    /// Clears error and warning.
    ///
    /// # Errors
    /// Those of [`Client::call`].
    pub fn clean_errors(&mut self) -> Result<(), RigError> {
        self.call(Command::CleanError)?;
        self.call(Command::CleanWarning).map(|_| ())
    }

    /// Changes the mode. After that the state must be set to motion.
    ///
    /// # Errors
    /// Those of [`Client::call`].
    pub fn set_mode(&mut self, mode: Mode) -> Result<(), RigError> {
        self.end_servo();
        let detection = self.detection;
        self.call(Command::SetMode { mode, detection }).map(|_| ())
    }

    /// Changes the state.
    ///
    /// # Errors
    /// Those of [`Client::call`].
    pub fn set_state(&mut self, state: SetState) -> Result<(), RigError> {
        self.call(Command::SetState(state)).map(|_| ())
    }

    /// Stops the robot now. The command is sent at once, whatever is unanswered, and then the
    /// client waits for its response. No command moves the robot until it is enabled again.
    ///
    /// # Errors
    /// Those of [`Client::call`]. A robot that does not confirm may be moving.
    pub fn stop(&mut self) -> Result<(), RigError> {
        self.end_servo();
        self.set_state(SetState::Stop)
    }

    /// The firmware's version.
    ///
    /// # Errors
    /// Those of [`Client::call`].
    pub fn version(&mut self) -> Result<String, RigError> {
        self.ask(Command::GetVersion, |answer| match answer {
            Answer::Version(version) => Some(version),
            _ => None,
        })
    }

    /// What the robot is doing.
    ///
    /// # Errors
    /// Those of [`Client::call`].
    pub fn state(&mut self) -> Result<MotionState, RigError> {
        self.ask(Command::GetState, |answer| match answer {
            Answer::State(state) => Some(state),
            _ => None,
        })
    }

    /// The error or, without one, the warning that the controller has.
    ///
    /// # Errors
    /// Those of [`Client::call`].
    pub fn errors(&mut self) -> Result<Option<ControllerCode>, RigError> {
        self.ask(Command::GetErrors, |answer| match answer {
            Answer::Errors { error, warning } => Some(ControllerCode::of(error, warning)),
            _ => None,
        })
    }

    /// Pose of the tool.
    ///
    /// # Errors
    /// Those of [`Client::call`].
    pub fn pose(&mut self) -> Result<TcpPose, RigError> {
        self.ask(Command::GetPose, |answer| match answer {
            Answer::Pose(pose) => Some(pose),
            _ => None,
        })
    }

    /// Moves along a line and waits until the robot is there. The robot must be enabled. Stops the
    /// robot if it is not there in time.
    ///
    /// # Errors
    /// Those of [`Client::call`]; an error or a warning on the way, by its name; a robot that was
    /// stopped; a robot that is not there in time.
    pub fn move_to(&mut self, to: &MoveTo, within: Duration) -> Result<(), RigError> {
        let name = "move";
        let begun = Instant::now();
        let time_s = 0.0;
        self.call(Command::MoveLine { to: *to, time_s })?;
        while begun.elapsed() < within {
            if let Some(code) = self.errors()? {
                return Err(RigError::Controller { code, command: name });
            }
            let state = self.state()?;
            if !matches!(state, MotionState::Ready | MotionState::Moving) {
                return Err(RigError::Robot {
                    command: name,
                    problem: format!("the robot is {state}"),
                    hint: "find out why it was stopped, then enable it again",
                });
            }
            let pose = self.pose()?;
            if state == MotionState::Ready
                && pose.distance_mm(&to.pose) <= ARRIVED_MM
                && pose.turn_rad(&to.pose) <= ARRIVED_RAD
            {
                return Ok(());
            }
            std::thread::sleep(POLL);
        }
        self.stop()?;
        Err(RigError::Robot {
            command: name,
            problem: format!(
                "the robot does not reach the pose within {} s",
                within.as_secs_f64()
            ),
            hint: "check what blocks it, or allow more time",
        })
    }

    /// Sends any command and waits for its response (see [`Client::set_answer_within`]). Responses
    /// to requests that were given up and unsolicited messages of the robot are skipped.
    ///
    /// # Errors
    /// A connection that fails, silence, a response to another request, and state bits that the
    /// command does not tolerate: an error or a warning of the controller by its name, a robot that
    /// is not ready, a result that is not valid. Queries, clearing errors and stopping tolerate all
    /// of these bits except the last.
    pub fn call(&mut self, command: Command) -> Result<Answer, RigError> {
        let within = match command {
            Command::MotionEnable { .. } => self.answer_within.max(ENABLE_WITHIN),
            _ => self.answer_within,
        };
        self.call_within(command, within)
    }

    fn call_within(&mut self, command: Command, within: Duration) -> Result<Answer, RigError> {
        let request = self.send(command)?;
        let response = self.response_to(&request, within)?;
        let answer = response.answer(&request)?;
        self.check(response.state, &request.command, self.answer_within)?;
        Ok(answer)
    }

    /// Sends a command without waiting for the response.
    pub(super) fn send(&mut self, command: Command) -> Result<Request, RigError> {
        self.transaction = self.transaction.checked_add(1).unwrap_or(1);
        let request = Request {
            transaction: self.transaction,
            protocol: PROTOCOL,
            command,
        };
        let wire = &mut self.reader.wire;
        wire.write_all(&request.encode())
            .and_then(|()| wire.flush())
            .map_err(|found| transport("sending", found))?;
        Ok(request)
    }

    fn ask<T>(&mut self, command: Command, pick: impl FnOnce(Answer) -> Option<T>) -> Result<T, RigError> {
        let name = command.name();
        // The decoded answer always fits its command.
        pick(self.call(command)?)
            .ok_or_else(|| RigError::malformed(Device::Robot, "answer", name, "another answer"))
    }

    fn response_to(&mut self, request: &Request, within: Duration) -> Result<Response, RigError> {
        let deadline = Instant::now() + within;
        while let Some(frame) = self.reader.next(Some(deadline))? {
            let Incoming::Response(response) = Incoming::decode(&frame)? else {
                continue;
            };
            let Some(waiting) = self.take_unanswered(&response) else {
                return Ok(response);
            };
            let command = waiting.request.command;
            if waiting.is_pose && response.state.without(command.tolerates()) != ResponseState::default() {
                self.end_servo(); // a query that is sent meanwhile receives that response
            }
        }
        self.remember(request, false);
        Err(late(request, within))
    }

    /// Remembers a request whose response may come later.
    pub(super) fn remember(&mut self, request: &Request, is_pose: bool) {
        if self.unanswered.len() == MOST_UNANSWERED {
            self.unanswered.pop_front();
        }
        self.unanswered.push_back(Unanswered {
            request: request.clone(),
            sent: Instant::now(),
            is_pose,
        });
    }

    /// The request that a late response answers.
    pub(super) fn take_unanswered(&mut self, response: &Response) -> Option<Unanswered> {
        let is_its = |waiting: &Unanswered| waiting.request.transaction == response.transaction;
        let place = self.unanswered.iter().position(is_its)?;
        self.unanswered.remove(place)
    }

    /// Checks that a response has no state bits that its command does not tolerate. Waits `within`
    /// for the code of an error.
    pub(super) fn check(
        &mut self,
        state: ResponseState,
        command: &Command,
        within: Duration,
    ) -> Result<(), RigError> {
        let bad = state.without(command.tolerates());
        let command = command.name();
        if bad.has(ResponseState::ERROR | ResponseState::WARNING) {
            let code = match self.call_within(Command::GetErrors, within) {
                Ok(Answer::Errors { error, warning }) => ControllerCode::of(error, warning),
                Ok(_) | Err(RigError::Timeout { .. }) => None,
                Err(other) => return Err(other),
            };
            if let Some(code) = code {
                return Err(RigError::Controller { code, command });
            }
        }
        let (problem, hint) = if bad.has(ResponseState::INVALID) {
            (
                "the robot calls the result invalid",
                "check the command against its firmware",
            )
        } else if bad.has(ResponseState::NOT_READY) {
            ("the robot is not ready to move", "enable it again")
        } else if bad.has(ResponseState::ERROR | ResponseState::WARNING) {
            ("the robot reports an error without a code", "enable it again")
        } else {
            return Ok(());
        };
        Err(RigError::Robot {
            command,
            problem: problem.to_owned(),
            hint,
        })
    }
}

/// A request that was not answered in time.
pub(super) fn late(request: &Request, within: Duration) -> RigError {
    RigError::Timeout {
        device: Device::Robot,
        what: request.command.name().to_owned(),
        after: within,
    }
}

/// Whether the firmware expects the collision detection beside a mode: from 1.10 on, and if it does
/// not state its version.
fn wants_detection(version: &str) -> bool {
    version
        .split(['v', 'V'])
        .skip(1)
        .find_map(|text| {
            let mut numbers = text.split(|c: char| !c.is_ascii_digit()).map(str::parse::<u32>);
            Some((numbers.next()?.ok()?, numbers.next()?.ok()?))
        })
        .is_none_or(|version| version >= (1, 10))
}

#[cfg(test)]
#[path = "client_tests.rs"]
mod tests;
