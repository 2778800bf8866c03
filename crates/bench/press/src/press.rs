//! One press, one servo period after the other.

use twintac_log::{Event, LogError};
use twintac_protocol::PressPlan;
use twintac_recording::Control;
use twintac_rig::{
    Cause, Decision, Observation, RigError, SensorLimits, Start, StreamId, Supervisor, TcpPose, Wrench,
};

use crate::journal::Journal;
use crate::touch::Touch;
use crate::{Arm, Heard, Motion, Phase, PressError, PressSettings, Source, StreamEvent};

/// Longest time that a retreat waits for a steady force, s. A robot keeps moving while it lags
/// behind.
const RETREAT_WAIT_S: f64 = 0.1;

/// State of a press after a period.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Standing {
    Going,
    /// Every pose was sent.
    Done,
    /// It was stopped, and the robot has moved back as far as that is safe.
    Stopped,
}

/// A press under way.
#[derive(Debug)]
pub(crate) struct Press<'a> {
    settings: PressSettings,
    plan: PressPlan,
    motion: Motion,
    supervisor: Supervisor,
    tactile: StreamId,
    answers: StreamId,
    journal: &'a mut Journal,
    tare: Wrench,
    touch: Touch,
    measured: TcpPose,
    goal: TcpPose,
    phase: Option<Phase>,
    has_begun: bool,
    /// Time at which no pose was sent for the first time.
    held_s: Option<f64>,
    has_retreated: bool,
    /// Remarks about the stop.
    pub(crate) remarks: Vec<String>,
    /// Whether the robot confirmed its stop.
    pub(crate) is_stop_confirmed: bool,
    /// Time from the arrival of the cause to the stop, s.
    pub(crate) stop_latency_s: Option<f64>,
}

impl<'a> Press<'a> {
    /// A press that begins at the robot's present pose, with the wrench that counts as zero load.
    pub(crate) fn new(
        settings: &PressSettings,
        sensor: &SensorLimits,
        plan: &PressPlan,
        journal: &'a mut Journal,
        start: Start,
        tare: Wrench,
    ) -> Result<Self, PressError> {
        let motion = Motion::new(settings, plan, &start.pose)?;
        let setup = settings.setup(motion.at_surface().position_mm);
        let mut supervisor = Supervisor::new(setup, sensor, start)?;
        let tactile = supervisor.watch("the tactile sensor", settings.tactile_silence_s, start.now_s);
        let answers = supervisor.watch("the robot's answers", settings.robot_silence_s, start.now_s);
        Ok(Self {
            settings: settings.clone(),
            plan: plan.clone(),
            supervisor,
            tactile,
            answers,
            journal,
            tare,
            touch: Touch::new(settings.touch_window_s, settings.touch_force_n),
            measured: start.pose,
            goal: start.pose,
            phase: motion.phase(),
            motion,
            has_begun: false,
            held_s: None,
            has_retreated: false,
            remarks: Vec::new(),
            is_stop_confirmed: true,
            stop_latency_s: None,
        })
    }

    /// The cause of the stop.
    pub(crate) fn cause(&self) -> Option<&Cause> {
        self.supervisor.cause()
    }

    /// Carries out one servo period: first what was heard, then at most one pose.
    pub(crate) fn period(
        &mut self,
        now_s: f64,
        heard: impl Iterator<Item = Heard>,
        is_interrupted: bool,
        arm: &mut impl Arm,
    ) -> Result<Standing, LogError> {
        for Heard { bench_s, event } in heard {
            self.hear(now_s, bench_s, event)?;
        }
        if is_interrupted {
            self.observe(now_s, now_s, Observation::OperatorStop);
        }
        self.hear_answers(now_s, arm);
        let was_stopped = self.cause().is_some();
        let goal = if was_stopped {
            Some(self.goal)
        } else {
            self.next_goal(now_s)?
        };
        let Some(goal) = goal else {
            return Ok(Standing::Done);
        };
        match self.supervisor.decide(now_s, &goal) {
            Decision::Go(pose) => {
                self.goal = pose;
                self.send(arm, pose, now_s);
                Ok(Standing::Going)
            }
            Decision::Retreat(pose) => {
                self.has_retreated = true; // a retreat that ended is not resumed
                match arm.servo(&pose) {
                    Ok(()) => Ok(Standing::Going),
                    Err(_) => self.stop(now_s, arm),
                }
            }
            Decision::Stop => {
                self.note_latency(0.0); // found in this period
                let held_s = now_s - *self.held_s.get_or_insert(now_s);
                let is_over = self.has_retreated || held_s >= RETREAT_WAIT_S;
                if is_over || !self.supervisor.can_retreat(now_s) {
                    return self.stop(now_s, arm);
                }
                Ok(Standing::Going)
            }
        }
    }

    /// A missing response counts as a silence since its pose was sent.
    fn hear_answers(&mut self, now_s: f64, arm: &mut impl Arm) {
        match arm.hear() {
            Ok(missing_s) => {
                let heard_s = now_s - missing_s;
                self.observe(heard_s, heard_s, Observation::Heard(self.answers));
            }
            Err(error) => self.arm_fails(now_s, &error),
        }
    }

    fn send(&mut self, arm: &mut impl Arm, pose: TcpPose, now_s: f64) {
        if let Err(error) = arm.servo(&pose) {
            self.arm_fails(now_s, &error);
        }
    }

    fn arm_fails(&mut self, now_s: f64, error: &RigError) {
        let (stream, problem) = (StreamId::ROBOT, error.to_string());
        self.observe(now_s, now_s, Observation::DeviceError { stream, problem });
    }

    fn stop(&mut self, now_s: f64, arm: &mut impl Arm) -> Result<Standing, LogError> {
        match arm.stop() {
            Ok(()) => self.remarks.extend(arm.error()),
            Err(error) => {
                self.is_stop_confirmed = false;
                self.remarks
                    .push(format!("the robot does not confirm its stop: {error}"));
            }
        }
        for text in self.remarks.clone() {
            self.journal.event(now_s, Event::Note { text })?;
        }
        if let Some(cause) = self.cause() {
            let cause = cause.to_string();
            self.journal.event(now_s, Event::Stopped { cause })?;
        }
        Ok(Standing::Stopped)
    }

    /// The latency of a silence counts from when it became too long, that of any other cause from
    /// its arrival.
    fn note_latency(&mut self, since_arrival_s: f64) {
        let latency_s = match self.cause() {
            Some(Cause::StreamSilent {
                silence_s,
                longest_silence_s,
                ..
            }) => silence_s - longest_silence_s,
            _ => since_arrival_s,
        };
        self.stop_latency_s.get_or_insert(latency_s);
    }

    /// Passes an event to the supervisor first. `arrived_s` is its time of arrival.
    fn observe(&mut self, now_s: f64, arrived_s: f64, event: Observation) {
        let was_stopped = self.cause().is_some();
        let is_stopped = self.supervisor.observe(now_s, event).is_some();
        if is_stopped && !was_stopped {
            self.note_latency(now_s - arrived_s);
        }
    }

    fn hear(&mut self, now_s: f64, bench_s: f64, event: StreamEvent) -> Result<(), LogError> {
        match event {
            StreamEvent::Wrench(sample) => {
                if sample.lost_before > self.settings.tolerated_loss {
                    let (stream, records) = (StreamId::FORCE, sample.lost_before.into());
                    self.observe(now_s, bench_s, Observation::DataLost { stream, records });
                }
                let force_n = sample.wrench.force_n - self.tare.force_n;
                self.observe(now_s, bench_s, Observation::Force(force_n));
                self.touch
                    .hear(bench_s, force_n.dot(self.settings.placement.force_axis));
                self.journal.wrench(&sample)
            }
            StreamEvent::Robot { pose, in_error } => {
                self.observe(now_s, bench_s, Observation::Robot { pose, in_error });
                self.measured = pose;
                self.journal.pose(bench_s, &pose)
            }
            StreamEvent::Frame(frame) => {
                self.observe(now_s, bench_s, Observation::Heard(self.tactile));
                self.journal.frame(bench_s, frame)
            }
            StreamEvent::NoFrame { problem } => {
                self.journal.no_frame(problem);
                Ok(())
            }
            StreamEvent::Failed { source, problem } => {
                let stream = match source {
                    Source::Force => StreamId::FORCE,
                    Source::Robot => StreamId::ROBOT,
                    Source::Tactile => self.tactile,
                };
                self.observe(now_s, bench_s, Observation::DeviceError { stream, problem });
                Ok(())
            }
        }
    }

    /// The next pose of the motion. `None` at its end. An approach without touch is a cause to
    /// stop.
    fn next_goal(&mut self, now_s: f64) -> Result<Option<TcpPose>, LogError> {
        let before = self.motion.phase();
        if before == Some(Phase::Approach) && self.touch.is_touching() {
            let height_mm = self.settings.placement.indenter(&self.measured).position_mm.z;
            self.motion.touch(height_mm);
            let text = format!("first touch {height_mm:.3} mm above the described surface");
            self.journal.event(now_s, Event::Note { text })?;
        }
        let is_approach = self.motion.phase() == Some(Phase::Approach);
        let mut goal = self.motion.next_pose();
        if is_approach && goal.is_none() {
            let problem = format!(
                "no touch down to {} mm below the described surface",
                self.settings.search_mm
            );
            let stream = StreamId::FORCE;
            self.observe(now_s, now_s, Observation::DeviceError { stream, problem });
            goal = Some(self.goal);
        }
        let phase = self.motion.phase();
        if phase != self.phase {
            self.phase = phase;
            self.mark(now_s)?;
            if phase == Some(Phase::Approach) && self.touch.is_touching() {
                let problem = "there is force before the approach: the surface is higher than described, or the indenter longer";
                let (stream, problem) = (StreamId::FORCE, problem.to_owned());
                self.observe(now_s, now_s, Observation::DeviceError { stream, problem });
            }
        }
        Ok(goal)
    }

    /// Marks the beginning and the end of the press in the log.
    fn mark(&mut self, now_s: f64) -> Result<(), LogError> {
        let name = self.plan.name.clone();
        match self.phase {
            Some(Phase::Approach) => {
                self.has_begun = true;
                let event = Event::PressBegun {
                    name,
                    indenter: self.plan.indenter.clone(),
                    control: Control::Pose,
                };
                self.journal.event(now_s, event)
            }
            Some(Phase::Travel) | None if std::mem::take(&mut self.has_begun) => {
                self.journal.event(now_s, Event::PressEnded { name })
            }
            _ => Ok(()),
        }
    }
}

#[cfg(test)]
#[path = "press_tests.rs"]
mod tests;
