//! Writes the messages of one press to its log.

use twintac_log::{
    Body, Event, LogError, LogSender, Message, PoseReading, Stream, TactileFrame, WrenchReading,
};
use twintac_rig::{TcpPose, WrenchSample};

/// Hands messages to a log, and marks what is missing between them.
#[derive(Debug)]
pub(crate) struct Journal {
    log: LogSender,
    frames: Continuity,
    reports: Continuity,
    wrench_s: Option<f64>,
    /// Tactile frames, wrenches and poses that were handed over.
    pub(crate) handed: u64,
    taxels: Vec<twintac_log::TaxelState>,
}

/// Tracks whether a stream has gaps.
#[derive(Debug)]
struct Continuity {
    stream: Stream,
    longest_s: f64,
    begun_s: f64,
    last_s: Option<f64>,
    /// Total time of all intervals without a gap, s, and their number. Their mean gives the number
    /// of messages that a gap lacks.
    whole_s: f64,
    n_whole: u32,
    problem: Option<String>,
}

impl Journal {
    /// For a log that begins at a time, s.
    pub(crate) fn new(log: LogSender, begun_s: f64, frame_gap_s: f64, report_gap_s: f64) -> Self {
        Self {
            log,
            frames: Continuity::new(Stream::Tactile, begun_s, frame_gap_s),
            reports: Continuity::new(Stream::Pose, begun_s, report_gap_s),
            wrench_s: None,
            handed: 0,
            taxels: Vec::new(),
        }
    }

    /// Messages that the log refuses because it is behind are marked by the log itself.
    fn send(&mut self, bench_s: f64, body: Body) -> Result<(), LogError> {
        if !matches!(body, Body::Event(_)) {
            self.handed += 1;
        }
        match self.log.send(Message::at_s(bench_s, body)) {
            Err(LogError::Behind { .. }) | Ok(()) => Ok(()),
            Err(other) => Err(other),
        }
    }

    pub(crate) fn event(&mut self, bench_s: f64, event: Event) -> Result<(), LogError> {
        self.send(bench_s, Body::Event(event))
    }

    pub(crate) fn frame(&mut self, bench_s: f64, frame: TactileFrame) -> Result<(), LogError> {
        if let Some(gap) = self.frames.go_on(bench_s) {
            self.event(bench_s, gap)?;
        }
        let states: Vec<_> = frame.taxels.iter().map(|taxel| taxel.state).collect();
        if !self.taxels.is_empty() && states != self.taxels {
            let changed = (0..).zip(&states).zip(&self.taxels);
            let changes: Vec<String> = changed
                .filter(|((_, now), before)| now != before)
                .map(|((taxel, now), _)| format!("taxel {taxel} is {}", now.fault().unwrap_or("good again")))
                .collect();
            let text = changes.join(", ");
            self.event(bench_s, Event::Note { text })?;
        }
        self.taxels = states;
        self.send(bench_s, Body::Tactile(frame))
    }

    /// Stores the cause of the next gap in the tactile frames.
    pub(crate) fn no_frame(&mut self, problem: String) {
        self.frames.problem.get_or_insert(problem);
    }

    pub(crate) fn wrench(&mut self, sample: &WrenchSample) -> Result<(), LogError> {
        let now_s = sample.stamp.bench_s;
        if sample.lost_before > 0 {
            let gap = Event::Gap {
                stream: Some(Stream::Wrench),
                cause: "readings did not arrive in time".to_owned(),
                from_ns: ns(self.wrench_s.unwrap_or(now_s)),
                to_ns: ns(now_s),
                lost: Some(sample.lost_before.into()),
            };
            self.event(now_s, gap)?;
        }
        self.wrench_s = Some(now_s);
        self.send(now_s, Body::Wrench(wrench_reading(sample)))
    }

    pub(crate) fn pose(&mut self, bench_s: f64, pose: &TcpPose) -> Result<(), LogError> {
        if let Some(gap) = self.reports.go_on(bench_s) {
            self.event(bench_s, gap)?;
        }
        let reading = PoseReading {
            source_s: None,
            position_mm: pose.position_mm,
            base_from_tool: pose.base_from_tool(),
        };
        self.send(bench_s, Body::Pose(reading))
    }

    /// Ends the log. Streams that fell silent before get a gap up to here.
    pub(crate) fn end(&mut self, bench_s: f64) -> Result<(), LogError> {
        let gaps = [self.frames.go_on(bench_s), self.reports.go_on(bench_s)];
        gaps.into_iter()
            .flatten()
            .try_for_each(|gap| self.event(bench_s, gap))
    }
}

impl Continuity {
    fn new(stream: Stream, begun_s: f64, longest_s: f64) -> Self {
        Self {
            stream,
            longest_s,
            begun_s,
            last_s: None,
            whole_s: 0.0,
            n_whole: 0,
            problem: None,
        }
    }

    /// Returns the gap that ends now, if there is one.
    fn go_on(&mut self, now_s: f64) -> Option<Event> {
        let problem = self.problem.take();
        let last_s = match self.last_s.replace(now_s) {
            Some(last_s) => last_s,
            // Before the first message a gap exists only if a loss is known.
            None if problem.is_some() => self.begun_s.min(now_s),
            None => return None,
        };
        let interval_s = now_s - last_s;
        if interval_s <= self.longest_s && problem.is_none() {
            self.whole_s += interval_s;
            self.n_whole += 1;
            return None;
        }
        let usual_s = self.whole_s / f64::from(self.n_whole);
        let lost = (interval_s / usual_s).round() - 1.0;
        Some(Event::Gap {
            stream: Some(self.stream),
            cause: problem.unwrap_or_else(|| "nothing came in time".to_owned()),
            from_ns: ns(last_s),
            to_ns: ns(now_s),
            lost: (self.n_whole > 0).then(|| lost.max(1.0) as u64),
        })
    }
}

fn wrench_reading(sample: &WrenchSample) -> WrenchReading {
    WrenchReading {
        source_s: sample.stamp.source_s,
        sequence: sample.sequence,
        status: sample.status,
        lost_before: sample.lost_before,
        force_n: sample.wrench.force_n,
        torque_n_mm: sample.wrench.torque_n_mm,
    }
}

fn ns(bench_s: f64) -> u64 {
    (bench_s * 1e9).round() as u64
}
