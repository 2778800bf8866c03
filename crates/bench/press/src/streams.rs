//! Hears all devices.

use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::{Receiver, Sender, channel};
use std::thread::JoinHandle;
use std::time::Duration;

use twintac_log::TactileFrame;
use twintac_rig::xarm::{Mode, MotionState, Report, ReportReader, Wire};
use twintac_rig::{BenchClock, Cause, TcpPose, WrenchSample, WrenchSource};
use twintac_source::TactileSource;

use crate::PressError;

/// How long a thread waits before it looks whether it is to end.
const WAIT: Duration = Duration::from_millis(50);
/// Rest after a frame that failed: a bus that fails at once would keep a core busy.
const AFTER_FAILURE: Duration = Duration::from_millis(1);

/// A device that streams.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Source {
    /// The force/torque sensor.
    Force,
    /// The robot's reports.
    Robot,
    /// The tactile sensor.
    Tactile,
}

impl std::fmt::Display for Source {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(match self {
            Self::Force => "the force sensor",
            Self::Robot => "the robot",
            Self::Tactile => "the tactile sensor",
        })
    }
}

/// What a device said, and when it arrived.
#[derive(Clone, Debug, PartialEq)]
pub struct Heard {
    /// Time on the bench's clock, s; of a tactile frame: when its taxels were triggered.
    pub bench_s: f64,
    /// What.
    pub event: StreamEvent,
}

/// What a device said.
#[derive(Clone, Debug, PartialEq)]
pub enum StreamEvent {
    /// All taxels were read.
    Frame(TactileFrame),
    /// A frame failed.
    NoFrame {
        /// Why.
        problem: String,
    },
    /// The force/torque sensor was read.
    Wrench(WrenchSample),
    /// The robot reported.
    Robot {
        /// Where its tool is.
        pose: TcpPose,
        /// Whether it is in error, or stopped.
        in_error: bool,
    },
    /// A stream has ended.
    Failed {
        /// Whose.
        source: Source,
        /// Why.
        problem: String,
    },
}

/// Threads that hear a device each. They end when this is dropped.
#[derive(Debug)]
pub struct Streams {
    clock: BenchClock,
    sender: Sender<Heard>,
    receiver: Receiver<Heard>,
    is_over: Arc<AtomicBool>,
    threads: Vec<JoinHandle<()>>,
}

/// What a thread has.
struct Ear {
    clock: BenchClock,
    sender: Sender<Heard>,
    is_over: Arc<AtomicBool>,
}

impl Streams {
    /// Hears nothing yet.
    #[must_use]
    pub fn new(clock: BenchClock) -> Self {
        let (sender, receiver) = channel();
        Self {
            clock,
            sender,
            receiver,
            is_over: Arc::default(),
            threads: Vec::new(),
        }
    }

    /// The bench's clock.
    #[must_use]
    pub fn clock(&self) -> BenchClock {
        self.clock
    }

    /// Hears a force/torque sensor, whose samples are stamped on this bench's clock.
    ///
    /// # Errors
    /// No thread.
    pub fn hear_force(&mut self, mut source: impl WrenchSource + Send + 'static) -> Result<(), PressError> {
        self.start("the force sensor", move |ear| {
            while ear.goes_on() {
                match source.next_sample(WAIT) {
                    Ok(Some(sample)) => ear.say(sample.stamp.bench_s, StreamEvent::Wrench(sample)),
                    Ok(None) => {}
                    Err(error) => return ear.fail(Source::Force, &error.to_string()),
                }
            }
        })
    }

    /// Hears a robot's reports.
    ///
    /// # Errors
    /// No thread.
    pub fn hear_robot<W: Wire + Send + 'static>(
        &mut self,
        mut reader: ReportReader<W>,
    ) -> Result<(), PressError> {
        self.start("the robot's reports", move |ear| {
            let (mut was_ready, mut has_followed) = (false, false);
            while ear.goes_on() {
                match reader.next_report(WAIT) {
                    Ok(Some(report)) => {
                        let (is_ready, follows) =
                            (is_ready(&report), report.known_mode() == Some(Mode::Servo));
                        was_ready |= is_ready;
                        has_followed |= follows;
                        // It was ready once and is no more, or somebody else changed its mode.
                        let in_error = was_ready && !is_ready || has_followed && !follows;
                        let pose = report.pose;
                        ear.say(ear.clock.now_s(), StreamEvent::Robot { pose, in_error });
                    }
                    Ok(None) => {}
                    Err(error) => return ear.fail(Source::Robot, &error.to_string()),
                }
            }
        })
    }

    /// Hears a tactile sensor, whose frames must be stamped on this bench's clock ([`BenchClock::now_us`]).
    ///
    /// # Errors
    /// No thread.
    pub fn hear_taxels(&mut self, mut source: impl TactileSource + 'static) -> Result<(), PressError> {
        self.start("the tactile sensor", move |ear| {
            while ear.goes_on() {
                match source.next_frame(WAIT) {
                    Ok(Some(reading)) => ear.say(reading.bench_s, StreamEvent::Frame(reading.frame)),
                    Ok(None) if source.is_over() => return ear.fail(Source::Tactile, "it has ended"),
                    Ok(None) => {}
                    Err(error) => {
                        let problem = error.to_string();
                        ear.say(ear.clock.now_s(), StreamEvent::NoFrame { problem });
                        std::thread::sleep(AFTER_FAILURE);
                    }
                }
            }
        })
    }

    /// What was heard since the last call, in the order of arrival.
    pub fn heard(&self) -> impl Iterator<Item = Heard> {
        self.receiver.try_iter()
    }

    /// Passes over what was heard since the last call; why nothing may be pressed, if something in it says so.
    pub(crate) fn trouble(&self) -> Option<Cause> {
        let mut trouble = None;
        for heard in self.heard() {
            let cause = match heard.event {
                StreamEvent::Robot { in_error: true, .. } => Cause::RobotInError,
                StreamEvent::Failed { source, problem } => Cause::DeviceError {
                    stream: source.to_string(),
                    problem,
                },
                _ => continue,
            };
            trouble.get_or_insert(cause);
        }
        trouble
    }

    fn start(
        &mut self,
        what: &'static str,
        body: impl FnOnce(&Ear) + Send + 'static,
    ) -> Result<(), PressError> {
        let ear = Ear {
            clock: self.clock,
            sender: self.sender.clone(),
            is_over: Arc::clone(&self.is_over),
        };
        let thread = std::thread::Builder::new()
            .name(what.to_owned())
            .spawn(move || body(&ear))
            .map_err(|source| PressError::Thread { what, source })?;
        self.threads.push(thread);
        Ok(())
    }
}

impl Drop for Streams {
    fn drop(&mut self) {
        self.is_over.store(true, Ordering::Relaxed);
        for thread in self.threads.drain(..) {
            let _ = thread.join(); // one that panicked has said so
        }
    }
}

impl Ear {
    fn goes_on(&self) -> bool {
        !self.is_over.load(Ordering::Relaxed)
    }

    fn say(&self, bench_s: f64, event: StreamEvent) {
        // Nobody hears it any more when the bench is gone.
        let _ = self.sender.send(Heard { bench_s, event });
    }

    fn fail(&self, source: Source, problem: &str) {
        let problem = problem.to_owned();
        self.say(self.clock.now_s(), StreamEvent::Failed { source, problem });
    }
}

/// Development reports have no error's code; in an error, the state is another.
fn is_ready(report: &Report) -> bool {
    let is_moving = matches!(report.state, MotionState::Ready | MotionState::Moving);
    is_moving && report.status.is_none_or(|status| status.error == 0)
}
