//! Readings of a Net F/T.

use std::collections::VecDeque;
use std::time::{Duration, Instant};

use super::{WrenchSample, WrenchSource};
use crate::netft::{Arrival, Client, Health, Record, SequenceReport, SequenceTracker};
use crate::{BenchClock, RigError, Stamp};

/// A Net F/T that streams. Records that arrive late or twice are counted but not returned, so the
/// readings are in order.
#[derive(Debug)]
pub struct NetFtSource {
    client: Client,
    clock: BenchClock,
    tracker: SequenceTracker,
    arrived: VecDeque<(f64, Record)>,
}

impl NetFtSource {
    /// The readings of a client that was started.
    #[must_use]
    pub fn new(client: Client, clock: BenchClock) -> Self {
        Self {
            client,
            clock,
            tracker: SequenceTracker::default(),
            arrived: VecDeque::new(),
        }
    }

    /// Counts of the records so far.
    #[must_use]
    pub fn report(&self) -> SequenceReport {
        self.tracker.report()
    }

    /// The reading of a record, unless the record is late or a duplicate.
    fn sample(&mut self, bench_s: f64, record: &Record) -> Result<Option<WrenchSample>, RigError> {
        let tracked = self.tracker.track(record);
        if record.status.health() == Health::Error {
            return Err(RigError::ForceSensorStatus {
                status: record.status,
            });
        }
        let lost_before = match tracked.arrival {
            Arrival::InOrder => 0,
            Arrival::AfterGap { lost } => lost,
            Arrival::Late | Arrival::Doubled => return Ok(None),
            Arrival::Restarted => {
                return Err(RigError::ForceSensor {
                    problem: "its stream started again".to_owned(),
                    hint: "check whether it lost power, or whether another client uses it",
                });
            }
        };
        Ok(Some(WrenchSample {
            stamp: Stamp {
                bench_s,
                source_s: Some(tracked.time_s),
            },
            wrench: self.client.configuration().wrench(record.counts),
            sequence: Some(record.rdt_sequence),
            status: record.status.0,
            lost_before,
        }))
    }
}

impl WrenchSource for NetFtSource {
    fn next_sample(&mut self, within: Duration) -> Result<Option<WrenchSample>, RigError> {
        let asked = Instant::now();
        loop {
            while let Some((bench_s, record)) = self.arrived.pop_front() {
                if let Some(sample) = self.sample(bench_s, &record)? {
                    return Ok(Some(sample));
                }
            }
            let records = self.client.receive(within.saturating_sub(asked.elapsed()))?;
            let bench_s = self.clock.now_s();
            self.arrived
                .extend(records.into_iter().map(|record| (bench_s, record)));
            if self.arrived.is_empty() && asked.elapsed() >= within {
                return Ok(None);
            }
        }
    }
}
