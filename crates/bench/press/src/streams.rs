//! Listens to all devices.

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

/// How long a thread waits before it checks whether it must end.
const WAIT: Duration = Duration::from_millis(50);
/// Pause after a frame that failed. Without it a bus that fails at once would keep one core busy.
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

/// A message of a device, and its time.
#[derive(Clone, Debug, PartialEq)]
pub struct Heard {
    /// Time on the bench clock, s: the time of arrival; for a tactile frame the time at which its
    /// taxels were triggered.
    pub bench_s: f64,
    /// The content.
    pub event: StreamEvent,
}

/// The content of a message of a device.
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
        /// Pose of its tool.
        pose: TcpPose,
        /// Whether it is in error, or stopped.
        in_error: bool,
    },
    /// A stream has ended.
    Failed {
        /// The device.
        source: Source,
        /// Why.
        problem: String,
    },
}

/// Threads that listen to one device each. They end when this value is dropped.
#[derive(Debug)]
pub struct Streams {
    clock: BenchClock,
    sender: Sender<Heard>,
    receiver: Receiver<Heard>,
    is_over: Arc<AtomicBool>,
    threads: Vec<JoinHandle<()>>,
}

/// The data of a thread.
struct Ear {
    clock: BenchClock,
    sender: Sender<Heard>,
    is_over: Arc<AtomicBool>,
}

impl Streams {
    /// Streams without a device.
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

    /// The bench clock.
    #[must_use]
    pub fn clock(&self) -> BenchClock {
        self.clock
    }

    /// Listens to a force/torque sensor. Its samples must be stamped on this bench clock.
    ///
    /// # Errors
    /// The thread cannot be started.
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

    /// Listens to a robot's reports.
    ///
    /// # Errors
    /// The thread cannot be started.
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
                        // It was ready before and is not any more, or somebody else changed its
                        // mode.
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

    /// Listens to a tactile sensor. Its frames must be stamped on this bench clock
    /// ([`BenchClock::now_us`]).
    ///
    /// # Errors
    /// The thread cannot be started.
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

    /// The messages since the last call, in the order of arrival.
    pub fn heard(&self) -> impl Iterator<Item = Heard> {
        self.receiver.try_iter()
    }

    /// Discards the messages since the last call. Returns a cause if one of them means that nothing
    /// may be pressed.
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
            let _ = thread.join(); // a thread that panicked has reported it
        }
    }
}

impl Ear {
    fn goes_on(&self) -> bool {
        !self.is_over.load(Ordering::Relaxed)
    }

    fn say(&self, bench_s: f64, event: StreamEvent) {
        // Fails only when the receiver is dropped.
        let _ = self.sender.send(Heard { bench_s, event });
    }

    fn fail(&self, source: Source, problem: &str) {
        let problem = problem.to_owned();
        self.say(self.clock.now_s(), StreamEvent::Failed { source, problem });
    }
}

/// Development reports have no error code. In an error their state is another one.
fn is_ready(report: &Report) -> bool {
    let is_moving = matches!(report.state, MotionState::Ready | MotionState::Moving);
    is_moving && report.status.is_none_or(|status| status.error == 0)
}
