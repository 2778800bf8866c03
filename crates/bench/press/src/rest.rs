//! The setup at rest before a press: the pose of the robot, and the wrench that counts as zero
//! load.

use std::sync::atomic::{AtomicBool, Ordering};
use std::time::Duration;

use glam::DVec3;
use twintac_log::{Event, LogError};
use twintac_rig::{Cause, Start, TcpPose, Wrench};

use crate::journal::Journal;
use crate::{Heard, PressError, PressSettings, Source, StreamEvent, Streams};

/// Longest time until a device is heard for the first time, s, unless its allowed silence is
/// longer.
const FIRST_WORDS_S: f64 = 2.0;

/// The setup at rest.
pub(crate) struct Rest {
    pub(crate) start: Start,
    /// The mean wrench, which counts as zero load.
    pub(crate) tare: Wrench,
}

/// Listens while nothing moves, until every device was heard and the tare is long enough. The inner
/// error is why nothing can be pressed.
pub(crate) fn rest(
    settings: &PressSettings,
    streams: &Streams,
    journal: &mut Journal,
    interrupt: &AtomicBool,
) -> Result<Result<Rest, Cause>, PressError> {
    let begun_s = streams.clock().now_s();
    let mut listening = Listening::default();
    loop {
        std::thread::sleep(Duration::from_secs_f64(settings.servo_period_s));
        for heard in streams.heard() {
            if let Some(cause) = listening.hear(heard, journal)? {
                return Ok(Err(cause));
            }
        }
        if interrupt.load(Ordering::Relaxed) {
            return Ok(Err(Cause::Operator));
        }
        let now_s = streams.clock().now_s();
        let rested_s = now_s - begun_s;
        match (listening.silent(settings), listening.pose) {
            (Some((source, longest_silence_s)), _) if rested_s > longest_silence_s => {
                return Ok(Err(Cause::StreamSilent {
                    stream: source.to_string(),
                    silence_s: rested_s,
                    longest_silence_s,
                }));
            }
            (None, Some(pose)) if rested_s >= settings.tare_s => {
                return Ok(listening.end(settings, pose, journal, now_s)?);
            }
            _ => {}
        }
    }
}

/// What was heard while nothing moved.
#[derive(Default)]
struct Listening {
    force_sum_n: DVec3,
    torque_sum_n_mm: DVec3,
    n_wrenches: u32,
    last_force_n: DVec3,
    pose: Option<TcpPose>,
    n_frames: u32,
}

impl Listening {
    /// Takes in a message of a device. Returns a cause if the message means that nothing can be
    /// pressed.
    fn hear(&mut self, heard: Heard, journal: &mut Journal) -> Result<Option<Cause>, LogError> {
        let Heard { bench_s, event } = heard;
        match event {
            StreamEvent::Wrench(sample) => {
                journal.wrench(&sample)?;
                self.last_force_n = sample.wrench.force_n;
                self.force_sum_n += sample.wrench.force_n;
                self.torque_sum_n_mm += sample.wrench.torque_n_mm;
                self.n_wrenches += 1;
            }
            StreamEvent::Robot { in_error: true, .. } => return Ok(Some(Cause::RobotInError)),
            StreamEvent::Robot { pose, .. } => {
                journal.pose(bench_s, &pose)?;
                self.pose = Some(pose);
            }
            StreamEvent::Frame(frame) => {
                journal.frame(bench_s, frame)?;
                self.n_frames += 1;
            }
            StreamEvent::NoFrame { problem } => journal.no_frame(problem),
            StreamEvent::Failed { source, problem } => {
                let stream = source.to_string();
                return Ok(Some(Cause::DeviceError { stream, problem }));
            }
        }
        Ok(None)
    }

    /// The first device that was not heard yet, and its longest allowed silence, s.
    fn silent(&self, settings: &PressSettings) -> Option<(Source, f64)> {
        let devices = [
            (self.n_wrenches == 0, Source::Force, settings.force_silence_s),
            (self.pose.is_none(), Source::Robot, settings.robot_silence_s),
            (self.n_frames == 0, Source::Tactile, settings.tactile_silence_s),
        ];
        let silent = devices.into_iter().find(|(is_silent, ..)| *is_silent);
        silent.map(|(_, source, silence_s)| (source, FIRST_WORDS_S.max(silence_s)))
    }

    /// The tare and the start of the press. The inner error is why nothing can be pressed.
    fn end(
        &self,
        settings: &PressSettings,
        pose: TcpPose,
        journal: &mut Journal,
        now_s: f64,
    ) -> Result<Result<Rest, Cause>, LogError> {
        let n = f64::from(self.n_wrenches);
        let tare = Wrench {
            force_n: self.force_sum_n / n,
            torque_n_mm: self.torque_sum_n_mm / n,
        };
        let found_n = tare.force_n.length();
        let is_small = found_n <= settings.largest_tare_n; // false for NaN
        if !is_small {
            return Ok(Err(Cause::LimitExceeded {
                limit: "force without load",
                found: found_n,
                allowed: settings.largest_tare_n,
                unit: "N",
            }));
        }
        let height_mm = settings.placement.indenter(&pose).position_mm.z;
        if height_mm < settings.approach_height_mm {
            return Ok(Err(Cause::DeviceError {
                stream: Source::Robot.to_string(),
                problem: format!(
                    "the indenter is {height_mm:.2} mm above the gel and may touch it: raise it to {} mm or more",
                    settings.approach_height_mm
                ),
            }));
        }
        let event = Event::Tare {
            force_n: tare.force_n,
            torque_n_mm: tare.torque_n_mm,
        };
        journal.event(now_s, event)?;
        let start = Start {
            now_s,
            pose,
            force_n: self.last_force_n - tare.force_n,
        };
        Ok(Ok(Rest { start, tare }))
    }
}
