//! Responses of the controller, and its commands to the arm.

use glam::DVec3;
use twintac_rig::TcpPose;
use twintac_rig::xarm::{
    Answer, Command, FEEDBACK, Mode, MotionState, MoveTo, PROTOCOL, Request, Response, ResponseState,
    SetState,
};

use super::{Arm, RobotSettings};
use crate::fault::FaultWire;
use crate::schedule::Schedule;
use crate::{EmulateError, FaultKind, ScheduledFault, Workcell};

/// All joints: a bit for each of six.
const ALL_JOINTS: u8 = 0x3f;
/// Joint angles that resemble those of an arm at work. They never change.
const JOINTS_RAD: [f32; 7] = [0.0, -0.7, -0.6, 0.0, 1.3, 0.0, 0.0];
/// Most moves that may wait.
const MOST_LINES: usize = 256;
/// The protocol number with a heartbeat, to which newer clients change.
const PROTOCOL_WITH_LIFE_SIGN: u16 = 3;

/// Codes of errors and warnings.
const TOO_FAST: u8 = 24;
const OUT_OF_REACH: u8 = 40;
const QUEUE_FULL: u8 = 11;
const BAD_PARAMETER: u8 = 12;

/// The controller: requests in, responses out. It has no sockets, and its only time is that of its
/// workcell.
#[derive(Debug)]
pub struct Controller {
    settings: RobotSettings,
    workcell: Workcell,
    schedule: Schedule,
    mode: Mode,
    /// `Ready` stands for ready and for moving. The arm tells which of them it is.
    state: MotionState,
    /// Joints whose motors are on and brakes released, one bit each.
    pub(super) enabled: u8,
    pub(super) error: u8,
    pub(super) warning: u8,
    pub(super) tcp_offset: TcpPose,
    pub(super) payload: [f32; 4],
    pub(super) collision_sensitivity: u8,
    pub(super) teach_sensitivity: u8,
    /// How many times its connections were cut.
    n_resets: u64,
}

impl Controller {
    /// The controller of the arm in a workcell, as after power-up: stopped, with its motors off. It
    /// takes its own faults from the list.
    ///
    /// # Errors
    /// A setting or a fault that is not valid.
    pub fn new(
        workcell: Workcell,
        settings: RobotSettings,
        faults: &[ScheduledFault],
    ) -> Result<Self, EmulateError> {
        settings.check()?;
        crate::fault::check_faults(faults)?;
        Ok(Self {
            settings,
            workcell,
            schedule: Schedule::new(faults, FaultWire::Robot),
            mode: Mode::Position,
            state: MotionState::Stopped,
            enabled: 0,
            error: 0,
            warning: 0,
            tcp_offset: TcpPose {
                position_mm: DVec3::ZERO,
                roll_pitch_yaw_rad: DVec3::ZERO,
            },
            payload: [0.0; 4],
            collision_sensitivity: 3,
            teach_sensitivity: 3,
            n_resets: 0,
        })
    }

    pub(crate) fn inject(&mut self, fault: ScheduledFault) {
        self.schedule.add(fault);
    }

    /// The response to a frame of the command socket. `None` if the frame is no request, or while a
    /// fault suppresses responses.
    pub fn respond(&mut self, frame: &[u8]) -> Option<Vec<u8>> {
        let happened = self.schedule.next_event(self.workcell.clock().now_s());
        self.suffer(happened);
        let request = match Request::decode(frame) {
            Ok(request) => request,
            // A known command with an invalid payload. Its header is valid, or there would be no
            // frame.
            Err(_) => Request {
                transaction: u16::from_be_bytes([*frame.first()?, *frame.get(1)?]),
                protocol: u16::from_be_bytes([*frame.get(2)?, *frame.get(3)?]),
                command: Command::Other {
                    function: *frame.get(6)?,
                    payload: Vec::new(),
                },
            },
        };
        let is_known = matches!(request.protocol, PROTOCOL | PROTOCOL_WITH_LIFE_SIGN);
        // A response with the function code of feedback would be read as feedback.
        if !is_known || request.command.function() == FEEDBACK {
            return None;
        }
        let (bits, payload) = match self.carry_out(&request.command) {
            Ok(payload) => (ResponseState::default(), payload),
            Err(bits) => (bits, Vec::new()),
        };
        let response = Response {
            transaction: request.transaction,
            protocol: request.protocol,
            function: request.command.function(),
            state: self.response_state() | bits,
            payload,
        };
        let is_silent = self.schedule.has(FaultKind::UnansweredRequests);
        (!is_silent).then(|| response.encode())
    }

    /// Carries out the faults that are due by now.
    pub fn look(&mut self) {
        let happened = self.schedule.look(self.workcell.clock().now_s());
        self.suffer(happened);
    }

    /// The state of the robot.
    #[must_use]
    pub fn state(&self) -> MotionState {
        match self.state {
            MotionState::Ready if self.steer(|arm| arm.is_moving()) => MotionState::Moving,
            state => state,
        }
    }

    /// The mode.
    #[must_use]
    pub fn mode(&self) -> Mode {
        self.mode
    }

    /// Pose of the tool.
    #[must_use]
    pub fn pose(&self) -> TcpPose {
        self.workcell.now().tool
    }

    /// Angles of the joints, radians. They never change.
    #[must_use]
    pub fn joints_rad(&self) -> [f32; 7] {
        JOINTS_RAD
    }

    /// Codes of error and warning. 0 for none.
    #[must_use]
    pub fn errors(&self) -> (u8, u8) {
        (self.error, self.warning)
    }

    pub(super) fn settings(&self) -> &RobotSettings {
        &self.settings
    }

    pub(super) fn workcell(&self) -> &Workcell {
        &self.workcell
    }

    pub(super) fn command_count(&self) -> u16 {
        self.steer(|arm| arm.n_lines()) as u16 // at most MOST_LINES
    }

    pub(super) fn n_resets(&self) -> u64 {
        self.n_resets
    }

    fn suffer(&mut self, happened: Vec<FaultKind>) {
        for what in happened {
            match what {
                FaultKind::RobotError { code } => self.fail(code),
                FaultKind::ConnectionReset => self.n_resets += 1,
                _ => {}
            }
        }
    }

    fn steer<T>(&self, tell: impl FnOnce(&mut Arm) -> T) -> T {
        self.workcell.steer(self.workcell.clock().now_ns(), tell)
    }

    /// Stops with an error, which stays until it is cleared. Emergency stops and errors of motors
    /// switch the motors off.
    fn fail(&mut self, code: u8) {
        self.error = code;
        if code <= 17 {
            self.enabled = 0;
        }
        self.stop(MotionState::Stopped);
    }

    fn stop(&mut self, state: MotionState) {
        self.state = state;
        self.steer(Arm::halt);
    }

    fn is_ready(&self) -> bool {
        self.enabled == ALL_JOINTS && self.error == 0 && self.state == MotionState::Ready
    }

    fn response_state(&self) -> ResponseState {
        let mut bits = ResponseState::default();
        if self.error != 0 {
            bits = bits | ResponseState::ERROR;
        }
        if self.warning != 0 {
            bits = bits | ResponseState::WARNING;
        }
        if self.enabled != ALL_JOINTS || matches!(self.state, MotionState::Stopped | MotionState::NotReady(_))
        {
            bits = bits | ResponseState::NOT_READY;
        }
        bits
    }

    /// The payload of the response to a command, or the state bits of its refusal, in addition to
    /// the bits that are set anyway.
    fn carry_out(&mut self, command: &Command) -> Result<Vec<u8>, ResponseState> {
        let answer = match command {
            Command::GetVersion => Answer::Version(self.settings.version.clone()),
            Command::GetState => Answer::State(self.state()),
            Command::GetCommandCount => Answer::CommandCount(self.command_count()),
            Command::GetErrors => Answer::Errors {
                error: self.error,
                warning: self.warning,
            },
            Command::GetPose => Answer::Pose(self.pose()),
            Command::GetJoints => Answer::Joints(JOINTS_RAD),
            Command::Other { function, payload } => return self.other(*function, payload),
            acting => self.act(acting).map(|()| Answer::Done)?,
        };
        Ok(answer.encode())
    }

    /// Carries out a command that changes something and has no data in its response.
    fn act(&mut self, command: &Command) -> Result<(), ResponseState> {
        match command {
            Command::CleanError => self.error = 0,
            Command::CleanWarning => self.warning = 0,
            Command::MotionEnable { axis, on } => self.enable(*axis, *on)?,
            Command::SetMode { mode, .. } => {
                self.mode = *mode;
                self.stop(MotionState::NotReady(5));
            }
            Command::SetState(state) => self.set_state(*state),
            Command::MoveLine { to, .. } => self.move_line(to)?,
            Command::ServoCartesian { to, in_tool_frame } => self.servo(&to.pose, *in_tool_frame)?,
            _ => return Err(ResponseState::INVALID),
        }
        Ok(())
    }

    fn enable(&mut self, axis: u8, on: bool) -> Result<(), ResponseState> {
        let joints = match axis {
            Command::ALL_AXES => ALL_JOINTS,
            1..=6 => 1 << (axis - 1),
            _ => return Err(ResponseState::INVALID),
        };
        if on {
            self.enabled |= joints;
        } else {
            self.enabled &= !joints;
            self.stop(MotionState::Stopped);
        }
        Ok(())
    }

    fn set_state(&mut self, state: SetState) {
        match state {
            // In an error the arm stays where it is until the error is cleared.
            SetState::Motion if self.error == 0 => {
                self.state = MotionState::Ready;
                self.steer(Arm::go_on);
            }
            SetState::Motion => {}
            SetState::Pause if self.state == MotionState::Ready => {
                self.state = MotionState::Paused;
                self.steer(Arm::pause);
            }
            SetState::Pause => {}
            SetState::Stop | SetState::DecelerationStop => self.stop(MotionState::Stopped),
        }
    }

    fn move_line(&mut self, to: &MoveTo) -> Result<(), ResponseState> {
        self.check_motion(Mode::Position, &to.pose)?;
        if self.steer(|arm| arm.n_lines()) >= MOST_LINES {
            self.warning = QUEUE_FULL;
            return Err(ResponseState::WARNING);
        }
        let speed_mm_per_s = if to.speed_mm_per_s > 0.0 {
            to.speed_mm_per_s
        } else {
            100.0
        };
        self.steer(|arm| arm.go_along_line(to.pose, speed_mm_per_s));
        Ok(())
    }

    fn servo(&mut self, pose: &TcpPose, in_tool_frame: bool) -> Result<(), ResponseState> {
        let goal = self.steer(|arm| arm.goal());
        let pose = if in_tool_frame {
            let turn = goal.base_from_tool();
            TcpPose::new(
                goal.position_mm + turn * pose.position_mm,
                turn * pose.base_from_tool(),
            )
        } else {
            *pose
        };
        self.check_motion(Mode::Servo, &pose)?;
        if pose.distance_mm(&goal) > self.settings.max_step_mm {
            self.fail(TOO_FAST);
            return Err(ResponseState::ERROR);
        }
        self.steer(|arm| arm.follow(pose));
        Ok(())
    }

    /// Checks that the robot can move to a pose now.
    fn check_motion(&mut self, mode: Mode, pose: &TcpPose) -> Result<(), ResponseState> {
        if !self.is_ready() {
            return Err(ResponseState::NOT_READY);
        }
        if self.mode != mode {
            return Err(ResponseState::INVALID);
        }
        if !pose.is_finite() {
            self.warning = BAD_PARAMETER;
            return Err(ResponseState::WARNING);
        }
        if !self.settings.reaches(pose) {
            self.fail(OUT_OF_REACH);
            return Err(ResponseState::ERROR);
        }
        Ok(())
    }
}
