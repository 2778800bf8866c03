//! Which records arrived, and when they were measured.

use std::collections::VecDeque;
use std::fmt;

use super::Record;

/// Ticks of the sensor's clock per second.
pub const TICKS_PER_SECOND: f64 = 7000.0;
/// A record that is older than the newest one by more than this many ticks does not count as late:
/// the sensor was restarted.
const LATEST_TICKS: i32 = 7000;
/// Most gaps that are remembered, to tell late records from duplicates.
const MOST_GAPS: usize = 64;

/// How a record arrived.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Arrival {
    /// As the next record.
    InOrder,
    /// After a gap: records before it are missing so far.
    AfterGap {
        /// How many are missing.
        lost: u32,
    },
    /// After later records. It was counted as lost, and is now counted as late.
    Late,
    /// As a duplicate.
    Doubled,
    /// As the first record of another stream: the stream was started again, or the sensor was
    /// switched off and on.
    Restarted,
}

/// A record's arrival and time.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Tracked {
    /// How it arrived.
    pub arrival: Arrival,
    /// When it was measured, on the sensor's own clock, s since power-up. The time stays continuous
    /// when the counter wraps around.
    pub time_s: f64,
}

/// Counts of a stream's records by how they arrived.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct SequenceReport {
    /// Records that arrived, each counted once.
    pub received: u64,
    /// Records that never arrived.
    pub lost: u64,
    /// Records that arrived after later ones.
    pub late: u64,
    /// Duplicates that arrived.
    pub doubled: u64,
    /// How many times the stream restarted.
    pub restarts: u64,
    /// Longest gap: most records that were missing in a row when the gap was found.
    pub longest_gap: u32,
}

impl fmt::Display for SequenceReport {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(
            f,
            "{} records received, {} lost (at most {} in a row), {} late, {} doubled, {} restarts",
            self.received, self.lost, self.longest_gap, self.late, self.doubled, self.restarts
        )
    }
}

#[derive(Clone, Copy, Debug)]
struct Newest {
    rdt_sequence: u32,
    ft_sequence: u32,
    ticks: i64,
}

#[derive(Clone, Copy, Debug)]
struct Gap {
    first: u32,
    count: u32,
}

/// Follows the two counters of a stream's records.
///
/// Both counters together tell apart cases that one counter cannot. A late or duplicate record is
/// older by both counters. The first record of another stream is older by one counter only, or by a
/// large amount.
#[derive(Clone, Debug, Default)]
pub struct SequenceTracker {
    newest: Option<Newest>,
    gaps: VecDeque<Gap>,
    report: SequenceReport,
}

impl SequenceTracker {
    /// Classifies a record and counts it.
    pub fn track(&mut self, record: &Record) -> Tracked {
        let fresh = Newest {
            rdt_sequence: record.rdt_sequence,
            ft_sequence: record.ft_sequence,
            ticks: i64::from(record.ft_sequence),
        };
        let Some(newest) = self.newest else {
            return self.advance(fresh, Arrival::InOrder);
        };
        let ahead = record
            .rdt_sequence
            .wrapping_sub(newest.rdt_sequence)
            .cast_signed();
        let ticks_ahead = record.ft_sequence.wrapping_sub(newest.ft_sequence).cast_signed();
        let ticks = newest.ticks + i64::from(ticks_ahead);
        let fresh_here = Newest { ticks, ..fresh };
        match (ahead, ticks_ahead) {
            (1, 1..) => self.advance(fresh_here, Arrival::InOrder),
            (2.., 1..) => {
                let gap = Gap {
                    first: newest.rdt_sequence.wrapping_add(1),
                    count: ahead.cast_unsigned() - 1,
                };
                self.remember(gap);
                self.advance(fresh_here, Arrival::AfterGap { lost: gap.count })
            }
            (..=0, ..=0) if ticks_ahead >= -LATEST_TICKS => Tracked {
                arrival: self.behind(record.rdt_sequence),
                time_s: ticks as f64 / TICKS_PER_SECOND,
            },
            _ => {
                self.gaps.clear();
                self.report.restarts += 1;
                self.advance(fresh, Arrival::Restarted)
            }
        }
    }

    /// The counts so far.
    #[must_use]
    pub fn report(&self) -> SequenceReport {
        self.report
    }

    fn advance(&mut self, newest: Newest, arrival: Arrival) -> Tracked {
        self.newest = Some(newest);
        self.report.received += 1;
        Tracked {
            arrival,
            time_s: newest.ticks as f64 / TICKS_PER_SECOND,
        }
    }

    fn remember(&mut self, gap: Gap) {
        self.report.lost += u64::from(gap.count);
        self.report.longest_gap = self.report.longest_gap.max(gap.count);
        if self.gaps.len() == MOST_GAPS {
            self.gaps.pop_front();
        }
        self.gaps.push_back(gap);
    }

    /// Takes the record out of the gap to which it belongs. It is late if there is such a gap, else
    /// a duplicate.
    fn behind(&mut self, rdt_sequence: u32) -> Arrival {
        let within = |gap: &Gap| rdt_sequence.wrapping_sub(gap.first) < gap.count;
        let Some(index) = self.gaps.iter().position(within) else {
            self.report.doubled += 1;
            return Arrival::Doubled;
        };
        let gap = self.gaps[index];
        let before = rdt_sequence.wrapping_sub(gap.first);
        self.gaps[index].count = before;
        if before + 1 < gap.count {
            let rest = Gap {
                first: rdt_sequence.wrapping_add(1),
                count: gap.count - before - 1,
            };
            self.gaps.insert(index + 1, rest);
            if self.gaps.len() > MOST_GAPS {
                self.gaps.pop_front();
            }
        }
        self.gaps.retain(|gap| gap.count > 0);
        self.report.lost -= 1;
        self.report.late += 1;
        self.report.received += 1;
        Arrival::Late
    }
}

#[cfg(test)]
mod tests {
    use std::collections::BTreeSet;

    use proptest::prelude::*;

    use super::*;
    use crate::netft::Status;

    /// Record number `number` of a stream at a tenth of the sensor's rate.
    fn record(first: u32, number: u32) -> Record {
        Record {
            rdt_sequence: first.wrapping_add(number),
            ft_sequence: (u32::MAX - 500).wrapping_add(10 * number),
            status: Status::HEALTHY,
            counts: [0; 6],
        }
    }

    fn arrivals(numbers: &[u32]) -> (Vec<Arrival>, SequenceReport) {
        let mut tracker = SequenceTracker::default();
        let arrivals = numbers
            .iter()
            .map(|&number| tracker.track(&record(u32::MAX - 2, number)).arrival)
            .collect();
        (arrivals, tracker.report())
    }

    #[test]
    fn gaps_late_and_doubled_records_are_told_apart_across_the_wrap() {
        use Arrival::{AfterGap, Doubled, InOrder, Late};
        let (arrivals, report) = arrivals(&[0, 1, 4, 3, 5, 3, 5, 6]);
        let lost = 2;
        assert_eq!(
            arrivals,
            [
                InOrder,
                InOrder,
                AfterGap { lost },
                Late,
                InOrder,
                Doubled,
                Doubled,
                InOrder
            ]
        );
        assert_eq!(
            report.to_string(),
            "6 records received, 1 lost (at most 2 in a row), 1 late, 2 doubled, 0 restarts"
        );
    }

    #[test]
    fn time_goes_on_where_the_counter_wraps() {
        let mut tracker = SequenceTracker::default();
        let times: Vec<f64> = (0..200)
            .map(|number| tracker.track(&record(1, number)).time_s)
            .collect();
        assert!((times[0] - f64::from(u32::MAX - 500) / 7000.0).abs() < 1e-6);
        assert!(
            times
                .windows(2)
                .all(|pair| (pair[1] - pair[0] - 10.0 / 7000.0).abs() < 1e-9)
        );
    }

    #[test]
    fn a_stream_that_begins_anew_is_noticed() {
        let mut tracker = SequenceTracker::default();
        let mut arrival = |rdt_sequence, ft_sequence| {
            let record = Record {
                rdt_sequence,
                ft_sequence,
                ..record(0, 0)
            };
            tracker.track(&record).arrival
        };
        assert_eq!(arrival(500, 1_000_000), Arrival::InOrder);
        assert_eq!(arrival(1, 1_000_700), Arrival::Restarted, "started again");
        assert_eq!(arrival(2, 1_000_701), Arrival::InOrder);
        assert_eq!(arrival(1, 30), Arrival::Restarted, "switched off and on");
        assert_eq!(arrival(2, 31), Arrival::InOrder);
        assert_eq!(arrival(3, 31), Arrival::Restarted, "a clock that stands still");
    }

    proptest! {
        /// Records are dropped, shuffled and duplicated at random: each record is counted in the
        /// right class.
        #[test]
        fn counts_add_up(
            first in any::<u32>(),
            fates in prop::collection::vec((0..10_u8, 0..8_u32), 1..300),
        ) {
            // The first record arrives first, because a record before it would belong to no stream
            // yet.
            let mut sent = vec![(0, 0)];
            for (number, (fate, delay)) in (1_u32..).zip(fates) {
                if fate > 0 {
                    sent.push((number + delay, number));
                }
                if fate == 9 {
                    sent.push((number + delay + 3, number));
                }
            }
            sent.sort_unstable();
            let mut tracker = SequenceTracker::default();
            for (_, number) in &sent {
                tracker.track(&record(first, *number));
            }
            let distinct: BTreeSet<u32> = sent.iter().map(|(_, number)| *number).collect();
            let newest = *distinct.last().unwrap();
            let report = tracker.report();
            prop_assert_eq!(report.received, distinct.len() as u64);
            prop_assert_eq!(report.lost, u64::from(newest + 1) - distinct.len() as u64);
            prop_assert_eq!(report.doubled, (sent.len() - distinct.len()) as u64);
            prop_assert_eq!(report.restarts, 0);
        }
    }
}
