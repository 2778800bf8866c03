//! Carries out press after press.

use std::path::Path;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::{Duration, SystemTime, UNIX_EPOCH};

use twintac_log::{Description, Event, Recorder};
use twintac_protocol::PressPlan;
use twintac_rig::{Cause, SensorLimits};

use crate::audit::{Audit, audit};
use crate::folder::Folder;
use crate::journal::Journal;
use crate::press::{Press, Standing};
use crate::rest::{Rest, rest};
use crate::{Arm, Mounting, Operator, PressError, PressSettings, Streams};

/// Time between two questions whether an indenter is mounted.
const MOUNTING: Duration = Duration::from_millis(20);

/// A robot in servo mode, and the streams of all devices.
#[derive(Debug)]
pub struct Bench<A> {
    /// The robot.
    pub arm: A,
    /// The streams of the robot and the sensors.
    pub streams: Streams,
}

/// Carries out presses within limits that were checked.
#[derive(Clone, Debug)]
pub struct Runner {
    settings: PressSettings,
    sensor: SensorLimits,
    description: Description,
}

/// Result of a run.
#[derive(Clone, Debug, PartialEq)]
pub struct RunSummary {
    /// Tactile frames per second over the recorded time, Hz.
    pub rate_hz: f64,
    /// Tactile frames in this run's logs.
    pub frames: u64,
    /// Readings that are missing in the logs without a mark, found by reading the logs again.
    pub lost_unmarked: u64,
    /// Presses that are done, including those of earlier runs.
    pub presses_done: usize,
    /// Why the run was stopped.
    pub stopped: Option<Cause>,
    /// Further remarks about the stop.
    pub remarks: Vec<String>,
    /// Whether the robot confirmed its stop, if it was told to stop. A robot that did not confirm
    /// may still be pressing.
    pub is_stop_confirmed: bool,
    /// Time from the arrival of the cause to the stop, in servo periods.
    pub stop_latency_periods: Option<f64>,
}

/// A run under way.
struct Progress {
    summary: RunSummary,
    /// Time from the first tactile frame to the last, summed over all logs, s, and the number of
    /// intervals between frames in it.
    frames_s: f64,
    intervals: u64,
}

impl Runner {
    /// A runner with these settings, for a sensor with these limits
    /// ([`sensor_limits`](crate::sensor_limits)). `description` describes the logs; the run sets
    /// its placement and the start of its clock. If its provenance is
    /// [`Real`](twintac_recording::Provenance::Real), the settings must not allow a longer silence
    /// than 0.1 s for the force sensor and 0.5 s for the other devices.
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

    /// Carries out the presses that the folder does not hold yet, with one log each, until all are
    /// done, something is wrong, or `interrupt` is set.
    ///
    /// # Errors
    /// Settings or plans that cannot be carried out, a folder of another run, a disk that fails.
    /// The robot is then stopped.
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
            // The first error is the one to report.
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
        let _ = bench.streams.heard().count(); // discards what is older than this run
        let description = self.describe(&bench.streams);
        let mut progress = Progress::new();
        let mut mounted = None;
        for (index, plan) in plans.iter().enumerate() {
            if folder.is_done(index) {
                progress.summary.presses_done += 1;
                continue;
            }
            let is_mounted = mounted.replace(&plan.indenter) == Some(&plan.indenter);
            let trouble = match is_mounted {
                true => bench.streams.trouble(),
                false => mount(&bench.streams, operator, &plan.indenter, interrupt),
            };
            if trouble.is_some() {
                progress.stop_at_rest(&mut bench.arm);
                progress.summary.stopped = trouble;
                break;
            }
            operator.begin(index, plan);
            let log = folder.log(index)?;
            let recorder = Recorder::create(&log, &description)?;
            let stopped = self.record(bench, plan, recorder, &log, interrupt, &mut progress)?;
            if stopped.is_some() {
                folder.set_aside(&log)?;
                progress.summary.stopped = stopped;
                break;
            }
            folder.set_done(index)?;
            progress.summary.presses_done += 1;
        }
        Ok(progress.finish())
    }

    /// Carries out one press with its log, and reads the log again afterwards. Returns the cause if
    /// the press was stopped.
    fn record<A: Arm>(
        &self,
        bench: &mut Bench<A>,
        plan: &PressPlan,
        recorder: Recorder,
        log: &Path,
        interrupt: &AtomicBool,
        progress: &mut Progress,
    ) -> Result<Option<Cause>, PressError> {
        let settings = &self.settings;
        let clock = bench.streams.clock();
        let (frame_gap_s, report_gap_s) = (settings.frame_gap_s, settings.report_gap_s);
        let mut journal = Journal::new(recorder.sender(), clock.now_s(), frame_gap_s, report_gap_s);
        let stopped = match rest(settings, &bench.streams, &mut journal, interrupt)? {
            Ok(rest) => self.press(bench, plan, &mut journal, rest, interrupt, &mut progress.summary)?,
            Err(cause) => {
                let event = Event::Stopped {
                    cause: cause.to_string(),
                };
                journal.event(clock.now_s(), event)?;
                progress.stop_at_rest(&mut bench.arm);
                Some(cause)
            }
        };
        journal.end(clock.now_s())?;
        let handed = journal.handed;
        let recorded = recorder.finish()?;
        let found = audit(log, frame_gap_s, report_gap_s)?;
        progress.count(&found, handed.saturating_sub(found.readings + recorded.lost));
        Ok(stopped)
    }

    /// The description of this run's logs.
    fn describe(&self, streams: &Streams) -> Description {
        let unix_ns = SystemTime::now()
            .duration_since(UNIX_EPOCH)
            .map_or(0, |since| since.as_nanos() as u64); // overflows after the year 2554
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

    /// Carries out one press. Returns the cause if it was stopped. Details go into the summary.
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
            // A late period is not caught up with.
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

impl Progress {
    fn new() -> Self {
        let summary = RunSummary {
            rate_hz: 0.0,
            frames: 0,
            lost_unmarked: 0,
            presses_done: 0,
            stopped: None,
            remarks: Vec::new(),
            is_stop_confirmed: true,
            stop_latency_periods: None,
        };
        Self {
            summary,
            frames_s: 0.0,
            intervals: 0,
        }
    }

    /// Stops a robot that got no pose since the last press.
    fn stop_at_rest(&mut self, arm: &mut impl Arm) {
        self.summary.is_stop_confirmed = arm.stop().is_ok();
        self.summary.remarks.extend(arm.error());
    }

    /// Adds the content of a log. `vanished` are readings that were handed over, that the log
    /// lacks, and that it did not refuse. Refused readings are marked in the log.
    fn count(&mut self, found: &Audit, vanished: u64) {
        self.summary.frames += found.frames;
        self.summary.lost_unmarked += found.lost_unmarked + vanished;
        self.frames_s += found.frames_s;
        self.intervals += found.frames.saturating_sub(1);
    }

    fn finish(mut self) -> RunSummary {
        if self.frames_s > 0.0 {
            self.summary.rate_hz = self.intervals as f64 / self.frames_s;
        }
        self.summary
    }
}

/// Waits until an indenter is mounted, and listens to all devices meanwhile. Returns the cause if
/// it will not be mounted.
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
