//! Press after press.

use std::path::Path;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::{Duration, SystemTime, UNIX_EPOCH};

use glam::DVec3;
use twintac_log::{Description, Event, Recorder};
use twintac_protocol::PressPlan;
use twintac_rig::{Cause, SensorLimits, Start, Wrench};

use crate::audit::audit;
use crate::folder::Folder;
use crate::journal::Journal;
use crate::press::{Press, Standing};
use crate::{Arm, Heard, Mounting, Operator, PressError, PressSettings, Source, StreamEvent, Streams};

/// How long devices may take to be heard at all, before a press, s.
const FIRST_WORDS_S: f64 = 2.0;

/// How long to wait before asking again whether an indenter is mounted.
const MOUNTING: Duration = Duration::from_millis(20);

/// A robot in servo mode, and what hears all devices.
#[derive(Debug)]
pub struct Bench<A> {
    /// The robot.
    pub arm: A,
    /// What hears it, and the sensors.
    pub streams: Streams,
}

/// Carries out presses, within limits that were checked.
#[derive(Clone, Debug)]
pub struct Runner {
    settings: PressSettings,
    sensor: SensorLimits,
    description: Description,
}

/// What came of a run.
#[derive(Clone, Debug, PartialEq)]
pub struct RunSummary {
    /// Tactile frames a second, over the time that was recorded, Hz.
    pub rate_hz: f64,
    /// Tactile frames in this run's logs.
    pub frames: u64,
    /// Readings that are missing in the logs without a mark, as found by reading them again.
    pub lost_unmarked: u64,
    /// Presses that are done, those of earlier runs included.
    pub presses_done: usize,
    /// Why the run was stopped.
    pub stopped: Option<Cause>,
    /// What else there is to say about the stop.
    pub remarks: Vec<String>,
    /// Whether the robot confirmed that it stopped, if it was told to: one that did not may be pressing.
    pub is_stop_confirmed: bool,
    /// From the arrival of what stopped it to the stop, in servo periods.
    pub stop_latency_periods: Option<f64>,
}

/// The bench at rest before a press.
struct Rest {
    start: Start,
    tare: Wrench,
}

impl Runner {
    /// What carries out presses with these settings, on a sensor that has these limits ([`sensor_limits`](crate::sensor_limits)).
    /// `description` says what the logs are about; the run sets its placement and the start of its clock. Where its provenance is
    /// [`Real`](twintac_recording::Provenance::Real), the devices may be silent for 0.1 s (force sensor) and 0.5 s (others) at most.
    ///
    /// # Errors
    /// [`PressError::Setting`].
    pub fn new(
        settings: PressSettings,
        sensor: SensorLimits,
        description: Description,
    ) -> Result<Self, PressError> {
        settings.check_for(description.provenance)?;
        Ok(Self {
            settings,
            sensor,
            description,
        })
    }

    /// Carries out the presses that the folder does not hold yet, one log each, until all are done, something is wrong, or `interrupt` is
    /// set.
    ///
    /// # Errors
    /// Settings or plans that cannot be carried out, a folder of another run, a disk that fails. The robot is stopped then.
    pub fn run<A: Arm>(
        &self,
        bench: &mut Bench<A>,
        plans: &[PressPlan],
        out: &Path,
        interrupt: &AtomicBool,
        operator: &mut dyn Operator,
    ) -> Result<RunSummary, PressError> {
        let run = self.run_presses(bench, plans, out, interrupt, operator);
        if run.is_err() {
            // The error is the one that is told.
            let _ = bench.arm.stop();
        }
        run
    }

    fn run_presses<A: Arm>(
        &self,
        bench: &mut Bench<A>,
        plans: &[PressPlan],
        out: &Path,
        interrupt: &AtomicBool,
        operator: &mut dyn Operator,
    ) -> Result<RunSummary, PressError> {
        let mut folder = Folder::open(out, plans)?;
        let _ = bench.streams.heard().count(); // what is older than this run
        let description = self.describe(&bench.streams);
        let mut summary = RunSummary {
            rate_hz: 0.0,
            frames: 0,
            lost_unmarked: 0,
            presses_done: 0,
            stopped: None,
            remarks: Vec::new(),
            is_stop_confirmed: true,
            stop_latency_periods: None,
        };
        let (mut frames_s, mut intervals) = (0.0, 0);
        let mut mounted = None;
        for (index, plan) in plans.iter().enumerate() {
            if folder.is_done(index) {
                summary.presses_done += 1;
                continue;
            }
            let is_mounted = mounted.replace(&plan.indenter) == Some(&plan.indenter);
            let trouble = match is_mounted {
                true => bench.streams.trouble(),
                false => mount(&bench.streams, operator, &plan.indenter, interrupt),
            };
            if trouble.is_some() {
                summary.is_stop_confirmed = bench.arm.stop().is_ok();
                summary.remarks.extend(bench.arm.error());
                summary.stopped = trouble;
                break;
            }
            operator.begin(index, plan);
            let log = folder.log(index)?;
            let recorder = Recorder::create(&log, &description)?;
            let settings = &self.settings;
            let begun_s = bench.streams.clock().now_s();
            let mut journal = Journal::new(
                recorder.sender(),
                begun_s,
                settings.frame_gap_s,
                settings.report_gap_s,
            );
            let stopped = match self.rest(&bench.streams, &mut journal, interrupt)? {
                Ok(rest) => self.press(bench, plan, &mut journal, rest, interrupt, &mut summary)?,
                Err(cause) => {
                    let event = Event::Stopped {
                        cause: cause.to_string(),
                    };
                    journal.event(bench.streams.clock().now_s(), event)?;
                    // Nothing moves: the robot was not sent a pose since the last press.
                    summary.is_stop_confirmed = bench.arm.stop().is_ok();
                    summary.remarks.extend(bench.arm.error());
                    Some(cause)
                }
            };
            journal.end(bench.streams.clock().now_s())?;
            let handed = journal.handed;
            let recorded = recorder.finish()?;
            let found = audit(&log, settings.frame_gap_s, settings.report_gap_s)?;
            summary.frames += found.frames;
            // What the log refused, it has marked.
            summary.lost_unmarked +=
                found.lost_unmarked + handed.saturating_sub(found.readings + recorded.lost);
            frames_s += found.frames_s;
            intervals += found.frames.saturating_sub(1);
            if stopped.is_some() {
                folder.set_aside(&log)?;
                summary.stopped = stopped;
                break;
            }
            folder.set_done(index)?;
            summary.presses_done += 1;
        }
        if frames_s > 0.0 {
            summary.rate_hz = intervals as f64 / frames_s;
        }
        Ok(summary)
    }

    /// The description of this run's logs.
    fn describe(&self, streams: &Streams) -> Description {
        let unix_ns = SystemTime::now()
            .duration_since(UNIX_EPOCH)
            .map_or(0, |since| since.as_nanos() as u64); // until the year 2554
        let bench_ns = (streams.clock().now_s() * 1e9) as u64;
        let placement = &self.settings.placement;
        Description {
            base_from_gel: placement.base_from_gel,
            tool_from_indenter: placement.tool_from_indenter,
            force_axis: placement.force_axis,
            start_unix_ns: unix_ns.saturating_sub(bench_ns),
            ..self.description.clone()
        }
    }

    /// Listens while nothing moves: where the robot is, and the mean wrench, which is no load.
    fn rest(
        &self,
        streams: &Streams,
        journal: &mut Journal,
        interrupt: &AtomicBool,
    ) -> Result<Result<Rest, Cause>, PressError> {
        let settings = &self.settings;
        let begun_s = streams.clock().now_s();
        let (mut sum, mut n) = (Wrench::ZERO, 0_u32);
        let (mut pose, mut frames, mut last_n) = (None, 0_u32, DVec3::ZERO);
        loop {
            std::thread::sleep(Duration::from_secs_f64(settings.servo_period_s));
            for Heard { bench_s, event } in streams.heard() {
                match event {
                    StreamEvent::Wrench(sample) => {
                        journal.wrench(&sample)?;
                        last_n = sample.wrench.force_n;
                        sum.force_n += sample.wrench.force_n;
                        sum.torque_n_mm += sample.wrench.torque_n_mm;
                        n += 1;
                    }
                    StreamEvent::Robot { in_error: true, .. } => return Ok(Err(Cause::RobotInError)),
                    StreamEvent::Robot { pose: now, .. } => {
                        journal.pose(bench_s, &now)?;
                        pose = Some(now);
                    }
                    StreamEvent::Frame(frame) => {
                        journal.frame(bench_s, frame)?;
                        frames += 1;
                    }
                    StreamEvent::NoFrame { problem } => journal.no_frame(problem),
                    StreamEvent::Failed { source, problem } => {
                        let stream = source.to_string();
                        return Ok(Err(Cause::DeviceError { stream, problem }));
                    }
                }
            }
            if interrupt.load(Ordering::Relaxed) {
                return Ok(Err(Cause::Operator));
            }
            let now_s = streams.clock().now_s();
            let silent = [
                (n == 0, Source::Force),
                (pose.is_none(), Source::Robot),
                (frames == 0, Source::Tactile),
            ];
            let silent = silent.iter().find(|(is_silent, _)| *is_silent);
            if let Some((_, source)) = silent
                && now_s - begun_s > FIRST_WORDS_S
            {
                return Ok(Err(Cause::StreamSilent {
                    stream: source.to_string(),
                    silence_s: now_s - begun_s,
                    longest_silence_s: FIRST_WORDS_S,
                }));
            }
            let (Some(pose), None, true) = (pose, silent, now_s - begun_s >= settings.tare_s) else {
                continue;
            };
            let tare = Wrench {
                force_n: sum.force_n / f64::from(n),
                torque_n_mm: sum.torque_n_mm / f64::from(n),
            };
            let found_n = tare.force_n.length();
            let is_small = found_n <= settings.largest_tare_n;
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
                        "the indenter stands {height_mm:.2} mm above the gel and may touch it: raise it to {} mm or more",
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
                force_n: last_n - tare.force_n,
            };
            return Ok(Ok(Rest { start, tare }));
        }
    }

    /// One press; why it was stopped. How it was goes into the summary.
    fn press<A: Arm>(
        &self,
        bench: &mut Bench<A>,
        plan: &PressPlan,
        journal: &mut Journal,
        rest: Rest,
        interrupt: &AtomicBool,
        summary: &mut RunSummary,
    ) -> Result<Option<Cause>, PressError> {
        let Bench { arm, streams } = bench;
        let clock = streams.clock();
        let mut press = Press::new(&self.settings, &self.sensor, plan, journal, rest.start, rest.tare)?;
        let period_s = self.settings.servo_period_s;
        let mut due_s = clock.now_s();
        loop {
            // A period that came late is not caught up with.
            due_s = (due_s + period_s).max(clock.now_s());
            std::thread::sleep(Duration::from_secs_f64((due_s - clock.now_s()).max(0.0)));
            let is_interrupted = interrupt.load(Ordering::Relaxed);
            match press.period(clock.now_s(), streams.heard(), is_interrupted, arm)? {
                Standing::Going => {}
                Standing::Done => return Ok(None),
                Standing::Stopped => {
                    summary.stop_latency_periods = press.stop_latency_s.map(|latency_s| latency_s / period_s);
                    summary.is_stop_confirmed = press.is_stop_confirmed;
                    summary.remarks.append(&mut press.remarks);
                    return Ok(press.cause().cloned());
                }
            }
        }
    }
}

/// Waits for an indenter to be mounted, and hears everything meanwhile. Why it is not, if it isn't.
fn mount(
    streams: &Streams,
    operator: &mut dyn Operator,
    indenter: &str,
    interrupt: &AtomicBool,
) -> Option<Cause> {
    loop {
        let answer = operator.mount(indenter);
        if let Some(cause) = streams.trouble() {
            return Some(cause);
        }
        match answer {
            Mounting::Mounted => return None,
            Mounting::Waiting if !interrupt.load(Ordering::Relaxed) => std::thread::sleep(MOUNTING),
            Mounting::Waiting | Mounting::Refused => return Some(Cause::Operator),
        }
    }
}
