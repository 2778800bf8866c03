//! The faults of one connection over time.

use crate::fault::{FaultKind, FaultWire, Moment, ScheduledFault};

/// The faults of one connection, with their state as time and events pass.
#[derive(Clone, Debug, Default)]
pub(crate) struct Schedule {
    faults: Vec<(ScheduledFault, Stage)>,
    count: u64,
}

#[derive(Clone, Copy, Debug, PartialEq)]
enum Stage {
    Ahead,
    /// Active since a time, s, and an event.
    Active(f64, u64),
    Over,
}

impl Schedule {
    /// Takes from all faults those that show on a connection.
    pub(crate) fn new(faults: &[ScheduledFault], wire: FaultWire) -> Self {
        let here = faults.iter().filter(|fault| fault.what.wire() == wire);
        Self {
            faults: here.map(|fault| (*fault, Stage::Ahead)).collect(),
            count: 0,
        }
    }

    /// Adds a fault. It begins later or at once.
    pub(crate) fn add(&mut self, fault: ScheduledFault) {
        self.faults.push((fault, Stage::Ahead));
    }

    /// Counts the next event. Returns the momentary faults that happen now.
    pub(crate) fn next_event(&mut self, now_s: f64) -> Vec<FaultKind> {
        let happened = self.look(now_s);
        self.count += 1;
        happened
    }

    /// Returns the momentary faults that happen now, without counting an event.
    pub(crate) fn look(&mut self, now_s: f64) -> Vec<FaultKind> {
        let mut happened = Vec::new();
        for (fault, stage) in &mut self.faults {
            let is_due = match fault.begins {
                Moment::TimeS(time_s) => now_s >= time_s,
                Moment::Count(count) => self.count >= count,
            };
            if *stage == Stage::Ahead && is_due {
                // A fault that begins at a time has lasted since then, however late this function
                // is called.
                let since_s = match fault.begins {
                    Moment::TimeS(time_s) => time_s,
                    Moment::Count(_) => now_s,
                };
                *stage = Stage::Active(since_s, self.count);
                if !fault.what.lasts() {
                    *stage = Stage::Over;
                    happened.push(fault.what);
                }
            }
            if let Stage::Active(since_s, since) = *stage {
                let is_over = match fault.lasts {
                    None => false,
                    Some(Moment::TimeS(time_s)) => now_s >= since_s + time_s,
                    Some(Moment::Count(count)) => self.count >= since + count,
                };
                if is_over {
                    *stage = Stage::Over;
                }
            }
        }
        happened
    }

    /// The lasting faults that are active, as of the last call of `look`.
    pub(crate) fn active(&self) -> impl Iterator<Item = FaultKind> {
        let active = self
            .faults
            .iter()
            .filter(|(_, stage)| matches!(stage, Stage::Active(..)));
        active.map(|(fault, _)| fault.what)
    }

    /// Whether this fault is active.
    pub(crate) fn has(&self, what: FaultKind) -> bool {
        self.active().any(|active| active == what)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn lost(begins: Moment, lasts: Option<Moment>) -> ScheduledFault {
        let what = FaultKind::LostDatagrams;
        ScheduledFault { what, begins, lasts }
    }

    #[test]
    fn counts_and_times_begin_and_end_what_lasts() {
        let active_at = |fault: ScheduledFault| -> Vec<u64> {
            let mut schedule = Schedule::new(&[fault], FaultWire::Force);
            let mut active = Vec::new();
            for event in 0..10 {
                assert_eq!(schedule.next_event(event as f64), []);
                if schedule.has(FaultKind::LostDatagrams) {
                    active.push(event);
                }
            }
            active
        };
        let (time, count) = (Moment::TimeS, Moment::Count);
        assert_eq!(active_at(lost(count(3), Some(count(2)))), [3, 4]);
        assert_eq!(active_at(lost(time(2.5), Some(time(3.0)))), [3, 4, 5]);
        assert_eq!(active_at(lost(count(7), Some(time(2.0)))), [7, 8]);
        assert_eq!(active_at(lost(time(7.5), None)), [8, 9]);
        assert_eq!(active_at(lost(count(3), Some(count(0)))), Vec::<u64>::new());
    }

    #[test]
    fn what_happens_happens_once_and_on_its_own_wire() {
        let fault = ScheduledFault {
            what: FaultKind::SwitchBrownOut,
            begins: Moment::Count(1),
            lasts: None,
        };
        let mut schedule = Schedule::new(&[fault, lost(Moment::Count(0), None)], FaultWire::I2c);
        let happened: Vec<usize> = (0..4).map(|_| schedule.next_event(0.0).len()).collect();
        assert_eq!(happened, [0, 1, 0, 0]);
        assert_eq!(schedule.active().count(), 0);
    }
}
