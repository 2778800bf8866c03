//! Limits, watchdogs and the latched stop.

use glam::DVec3;

use super::retreat::Progress;
use super::speed::SpeedBudget;
use super::watchdog::Watchdog;
use super::{Cause, SensorLimits, Setup, StreamId};
use crate::{RigError, TcpPose};

/// Tolerance of a measured position beyond a limit of the goals, mm, because robots overshoot and
/// round.
const TRACKING_TOLERANCE_MM: f64 = 0.1;

/// An event that the supervisor is told of between servo periods.
#[derive(Clone, Debug, PartialEq)]
pub enum Observation {
    /// The force sensor's reading, N, in any frame.
    Force(DVec3),
    /// The robot's report.
    Robot {
        /// Where its tool is.
        pose: TcpPose,
        /// Whether it reports an error.
        in_error: bool,
    },
    /// A sign of life of another stream.
    Heard(StreamId),
    /// A device reports an error, or cannot be reached.
    DeviceError {
        /// Its stream.
        stream: StreamId,
        /// What is wrong.
        problem: String,
    },
    /// Data of a stream are missing.
    DataLost {
        /// The stream.
        stream: StreamId,
        /// How many records.
        records: u64,
    },
    /// A person asked to stop.
    OperatorStop,
}

/// What to do in this servo period.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Decision {
    /// Send the goal.
    Go(TcpPose),
    /// Stop now, or stay stopped: [`Supervisor::cause`] says why.
    Stop,
    /// Send this pose instead: straight back from the sensor.
    Retreat(TcpPose),
}

/// State at the start of a press.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Start {
    /// Time on the bench clock, s.
    pub now_s: f64,
    /// The pose that the robot reports.
    pub pose: TcpPose,
    /// What the force sensor reads, N.
    pub force_n: DVec3,
}

/// Supervises one press.
///
/// It does nothing by itself and has no clock: the caller reports what the devices say and when,
/// and asks for one decision in each servo period. The first cause to stop is latched: neither this
/// call nor a later one releases a goal. To go on, a person must look at the test setup, and a new
/// supervisor must be made.
///
/// ```
/// use glam::DVec3;
/// use twintac_rig::{Decision, Limits, Observation, Retreat, SensorLimits, Setup, Start, Supervisor, TcpPose, Workspace};
///
/// let setup = Setup {
///     limits: Limits {
///         force_n: 10.0,
///         depth_mm: 3.0,
///         workspace: Workspace { min_mm: DVec3::new(150.0, -50.0, 90.0), max_mm: DVec3::new(250.0, 50.0, 150.0) },
///         step_mm: 1.0,
///         turn_step_rad: 0.1,
///         speed_mm_per_s: 50.0,
///     },
///     surface_mm: DVec3::new(200.0, 0.0, 100.0),
///     approach: DVec3::NEG_Z,
///     servo_period_s: 0.004,
///     force_silence_s: 0.02,
///     robot_silence_s: 0.05,
///     retreat: Retreat { distance_mm: 5.0, speed_mm_per_s: 25.0, force_noise_n: 0.2 },
/// };
/// let above = TcpPose {
///     position_mm: DVec3::new(200.0, 0.0, 100.1),
///     roll_pitch_yaw_rad: DVec3::new(std::f64::consts::PI, 0.0, 0.0),
/// };
/// let sensor = SensorLimits { force_n: 20.0, depth_mm: 4.0 };
/// let start = Start { now_s: 0.0, pose: above, force_n: DVec3::ZERO };
/// let mut supervisor = Supervisor::new(setup, &sensor, start)?;
///
/// assert_eq!(supervisor.decide(0.004, &above), Decision::Go(above));
/// supervisor.observe(0.006, Observation::Force(DVec3::new(0.0, 0.0, 10.5)));
/// assert_eq!(supervisor.decide(0.008, &above), Decision::Stop);
/// assert_eq!(supervisor.cause().unwrap().to_string(), "force is 10.5 N, the limit is 10 N");
/// # Ok::<(), twintac_rig::RigError>(())
/// ```
#[derive(Clone, Debug)]
pub struct Supervisor {
    setup: Setup,
    watchdog: Watchdog,
    budget: SpeedBudget,
    cause: Option<Cause>,
    goal: TcpPose,
    measured: TcpPose,
    robot_in_error: bool,
    force_n: f64,
    retreat: Progress,
}

impl Supervisor {
    /// Starts to supervise a press on a sensor.
    ///
    /// # Errors
    /// [`RigError::LimitRaised`] for a limit above the sensor's own. [`RigError::Setup`] for a
    /// setup that is not valid, or that contradicts the robot's position.
    pub fn new(setup: Setup, sensor: &SensorLimits, start: Start) -> Result<Self, RigError> {
        let setup = setup.checked(sensor, &start.pose)?;
        let mut watchdog = Watchdog::default();
        watchdog.watch("the force sensor", setup.force_silence_s, start.now_s);
        watchdog.watch("the robot", setup.robot_silence_s, start.now_s);
        let mut supervisor = Self {
            budget: SpeedBudget::new(setup.limits.speed_mm_per_s, setup.servo_period_s, start.now_s),
            watchdog,
            cause: None,
            goal: start.pose,
            measured: start.pose,
            robot_in_error: false,
            force_n: 0.0,
            retreat: Progress::Waiting { force_before_n: None },
            setup,
        };
        supervisor.observe(start.now_s, Observation::Force(start.force_n));
        Ok(supervisor)
    }

    /// Watches one more stream. Its longest allowed silence is `longest_silence_s`, s.
    pub fn watch(&mut self, name: &str, longest_silence_s: f64, now_s: f64) -> StreamId {
        self.watchdog.watch(name, longest_silence_s, now_s)
    }

    /// Why the press was stopped, if it was.
    #[must_use]
    pub fn cause(&self) -> Option<&Cause> {
        self.cause.as_ref()
    }

    /// Takes note of an event. Returns the cause to stop if there is one by now, so that the caller
    /// need not wait for the next period.
    pub fn observe(&mut self, now_s: f64, event: Observation) -> Option<&Cause> {
        // The silence that this event ends is checked first.
        self.latch(self.watchdog.silent(now_s));
        let cause = match event {
            Observation::Force(force_n) => {
                self.force_n = force_n.length();
                self.watchdog.heard(StreamId::FORCE, now_s);
                limit("force", self.force_n, self.setup.limits.force_n, "N")
            }
            Observation::Robot { pose, in_error } => {
                self.measured = pose;
                self.robot_in_error = in_error;
                self.watchdog.heard(StreamId::ROBOT, now_s);
                if in_error {
                    Some(Cause::RobotInError)
                } else {
                    self.place(
                        ["robot's depth", "robot"],
                        pose.position_mm,
                        TRACKING_TOLERANCE_MM,
                    )
                }
            }
            Observation::Heard(stream) => {
                self.watchdog.heard(stream, now_s);
                None
            }
            Observation::DeviceError { stream, problem } => {
                self.watchdog.fail(stream);
                Some(Cause::DeviceError {
                    stream: self.watchdog.name(stream),
                    problem,
                })
            }
            Observation::DataLost { stream, records } => Some(Cause::DataLost {
                stream: self.watchdog.name(stream),
                records,
            }),
            Observation::OperatorStop => Some(Cause::Operator),
        };
        self.latch(cause);
        self.cause()
    }

    /// Decides whether a goal may be sent in this servo period.
    ///
    /// In the period in which a cause appears the decision is [`Decision::Stop`]. In later periods
    /// it may be [`Decision::Retreat`], as long as the force sensor is alive, its force does not
    /// rise, and the robot is alive, without error and inside its workspace.
    pub fn decide(&mut self, now_s: f64, goal: &TcpPose) -> Decision {
        let was_stopped = self.cause.is_some();
        self.latch(self.watchdog.silent(now_s));
        if self.cause.is_none() {
            let cause = self.wrong_with(goal, now_s);
            self.latch(cause);
        }
        if self.cause.is_none() {
            self.goal = *goal;
            return Decision::Go(*goal);
        }
        if !was_stopped {
            return Decision::Stop;
        }
        let can_retreat = self.can_retreat(now_s);
        match self
            .retreat
            .next(&self.setup, can_retreat, &self.farthest(), self.force_n)
        {
            Some(pose) => Decision::Retreat(pose),
            None => Decision::Stop,
        }
    }

    /// Whether a retreat could be supervised: the force sensor and the robot are alive, and the
    /// robot has no error. If not, there is nothing to wait for.
    #[must_use]
    pub fn can_retreat(&self, now_s: f64) -> bool {
        self.watchdog.is_alive(StreamId::FORCE, now_s)
            && self.watchdog.is_alive(StreamId::ROBOT, now_s)
            && !self.robot_in_error
            && self.measured.is_finite()
    }

    /// The last goal or, if the measured pose is farther from the sensor, the last goal moved back
    /// to that distance. The measured pose alone does not suffice: a report is old when it arrives,
    /// and the robot may have moved up since. The goal's sideways position is kept, so that a robot
    /// that lags behind does not move sideways.
    fn farthest(&self) -> TcpPose {
        let depth_mm = |pose: &TcpPose| self.setup.depth_mm(pose.position_mm);
        let farther_mm = (depth_mm(&self.goal) - depth_mm(&self.measured)).max(0.0);
        TcpPose {
            position_mm: self.goal.position_mm - self.setup.approach * farther_mm,
            ..self.goal
        }
    }

    fn latch(&mut self, cause: Option<Cause>) {
        if self.cause.is_none() {
            self.cause = cause;
        }
    }

    fn wrong_with(&mut self, goal: &TcpPose, now_s: f64) -> Option<Cause> {
        let limits = self.setup.limits;
        let step_mm = goal.distance_mm(&self.goal);
        let place = self.place(["goal's depth", "goal"], goal.position_mm, 0.0);
        let cause = place
            .or_else(|| limit("goal's step", step_mm, limits.step_mm, "mm"))
            .or_else(|| {
                limit(
                    "goal's turn",
                    goal.turn_rad(&self.goal),
                    limits.turn_step_rad,
                    "rad",
                )
            });
        if cause.is_some() {
            return cause;
        }
        let speed_mm_per_s = self.budget.spend(step_mm, now_s).err()?;
        Some(Cause::LimitExceeded {
            limit: "goal's speed",
            found: speed_mm_per_s,
            allowed: limits.speed_mm_per_s,
            unit: "mm/s",
        })
    }

    /// What is wrong with a position: its depth is beyond the limit, or it is outside the
    /// workspace.
    fn place(&self, names: [&'static str; 2], position_mm: DVec3, tolerance_mm: f64) -> Option<Cause> {
        let limits = &self.setup.limits;
        if !limits.workspace.contains(position_mm, tolerance_mm) {
            return Some(Cause::OutsideWorkspace {
                what: names[1],
                position_mm,
            });
        }
        let depth_mm = self.setup.depth_mm(position_mm);
        limit(names[0], depth_mm, limits.depth_mm + tolerance_mm, "mm")
    }
}

/// The cause if `found` is beyond a limit. NaN is beyond every limit.
fn limit(limit: &'static str, found: f64, allowed: f64, unit: &'static str) -> Option<Cause> {
    let is_kept = found <= allowed;
    (!is_kept).then_some(Cause::LimitExceeded {
        limit,
        found,
        allowed,
        unit,
    })
}

#[cfg(test)]
#[path = "supervisor_tests.rs"]
mod tests;
