//! What goes wrong, and when.

use serde::{Deserialize, Serialize};

use crate::{CHANNELS, EmulateError};

/// Something that goes wrong, from a moment on.
///
/// ```
/// # #[derive(serde::Deserialize)]
/// # struct File { faults: Vec<twintac_emulate::Fault> }
/// # let file: File = toml::from_str(r#"
/// [[faults]]                                   # the third barometer is away for half a second
/// what = { no_acknowledge = { channel = 2 } }
/// begins = { time_s = 1.5 }
/// lasts = { time_s = 0.5 }
///
/// [[faults]]                                   # the 200th transaction finds the switch without its mask
/// what = "switch_brown_out"
/// begins = { count = 200 }
/// # "#).unwrap();
/// # assert_eq!(file.faults.len(), 2);
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Fault {
    /// What goes wrong.
    pub what: What,
    /// When.
    pub begins: Moment,
    /// For how long, if it is something that lasts; left out: for ever.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub lasts: Option<Moment>,
}

/// A moment, or how long something lasts.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Moment {
    /// Time of the lab's clock, s.
    TimeS(f64),
    /// Transactions on the bus, requests to the robot, or datagrams of the force sensor: those of the wire that the fault is on, from 0.
    Count(u64),
}

/// Something that can go wrong.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case", deny_unknown_fields)]
pub enum What {
    /// Lasts: a channel's barometer, or without a channel the switch, does not acknowledge.
    NoAcknowledge {
        /// The channel.
        channel: Option<u8>,
    },
    /// Lasts: a channel's data line is shorted to ground, so that the bus is held while the channel is open.
    Short {
        /// The channel.
        channel: u8,
    },
    /// Happens: a channel's barometer, or without a channel the switch, waits for nine clocks and holds the data line until it gets them. The
    /// switch's reset frees its own side.
    StuckBus {
        /// The channel.
        channel: Option<u8>,
    },
    /// Lasts: each transaction takes longer.
    ClockStretch {
        /// By how much, s.
        by_s: f64,
    },
    /// Happens: the switch loses power for a moment, and with it its mask.
    SwitchBrownOut,
    /// Happens: a channel's barometer loses power for a moment, and with it what it measures and how.
    BarometerBrownOut {
        /// The channel.
        channel: u8,
    },
    /// Lasts: conversions of a channel's barometer do not end.
    EndlessConversion {
        /// The channel.
        channel: u8,
    },
    /// Happens: the robot's connections end.
    ConnectionReset,
    /// Happens: the robot stops with an error.
    RobotError {
        /// The controller's code.
        code: u8,
    },
    /// Lasts: the robot carries requests out, and does not answer.
    UnansweredRequests,
    /// Lasts: datagrams of the force sensor are lost.
    LostDatagrams,
    /// Lasts: datagrams arrive late, after those that are not.
    LateDatagrams {
        /// By how much, s.
        by_s: f64,
    },
    /// Lasts: datagrams arrive twice.
    DoubledDatagrams,
    /// Lasts: datagrams arrive in pairs, the second one first.
    ReorderedDatagrams,
    /// Lasts: the force sensor's gauges are saturated.
    SaturatedForce,
}

/// Where a fault shows, and whose events count for it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Wire {
    /// The sensor's bus.
    I2c,
    /// The robot's connections.
    Robot,
    /// The force sensor's datagrams.
    Force,
}

impl What {
    /// Where it shows.
    #[must_use]
    pub fn wire(&self) -> Wire {
        match self {
            Self::NoAcknowledge { .. }
            | Self::Short { .. }
            | Self::StuckBus { .. }
            | Self::ClockStretch { .. }
            | Self::SwitchBrownOut
            | Self::BarometerBrownOut { .. }
            | Self::EndlessConversion { .. } => Wire::I2c,
            Self::ConnectionReset | Self::RobotError { .. } | Self::UnansweredRequests => Wire::Robot,
            Self::LostDatagrams
            | Self::LateDatagrams { .. }
            | Self::DoubledDatagrams
            | Self::ReorderedDatagrams
            | Self::SaturatedForce => Wire::Force,
        }
    }

    /// Whether it lasts, rather than happens once.
    #[must_use]
    pub fn lasts(&self) -> bool {
        !matches!(
            self,
            Self::StuckBus { .. }
                | Self::SwitchBrownOut
                | Self::BarometerBrownOut { .. }
                | Self::ConnectionReset
                | Self::RobotError { .. }
        )
    }

    fn channel(&self) -> Option<u8> {
        match *self {
            Self::NoAcknowledge { channel } | Self::StuckBus { channel } => channel,
            Self::Short { channel }
            | Self::BarometerBrownOut { channel }
            | Self::EndlessConversion { channel } => Some(channel),
            _ => None,
        }
    }
}

impl Fault {
    /// That it makes sense; `field` is its path in errors.
    pub(crate) fn check(&self, field: &str) -> Result<(), EmulateError> {
        let bad = |name: &str, problem: &str| Err(EmulateError::setting(format!("{field}.{name}"), problem));
        if self
            .what
            .channel()
            .is_some_and(|channel| usize::from(channel) >= CHANNELS)
        {
            return bad("what.channel", "expected 0 to 7");
        }
        if let What::ClockStretch { by_s } | What::LateDatagrams { by_s } = self.what
            && !(by_s > 0.0 && by_s.is_finite())
        {
            return bad("what.by_s", "expected a time above zero");
        }
        if matches!(self.what, What::RobotError { code: 0 }) {
            return bad("what.code", "expected a code from 1 on");
        }
        for (name, moment) in [("begins", Some(self.begins)), ("lasts", self.lasts)] {
            if let Some(Moment::TimeS(time_s)) = moment
                && !(time_s >= 0.0 && time_s.is_finite())
            {
                return bad(name, "expected a time not below zero");
            }
        }
        if self.lasts.is_some() && !self.what.lasts() {
            return bad("lasts", "is given, but the fault happens once");
        }
        Ok(())
    }
}

/// That all faults make sense.
pub(crate) fn check_all(faults: &[Fault]) -> Result<(), EmulateError> {
    let mut indexed = faults.iter().enumerate();
    indexed.try_for_each(|(index, fault)| fault.check(&format!("faults[{index}]")))
}

/// The faults of one wire, as its time and its events go by.
#[derive(Clone, Debug, Default)]
pub(crate) struct Schedule {
    faults: Vec<(Fault, Stage)>,
    count: u64,
}

#[derive(Clone, Copy, Debug, PartialEq)]
enum Stage {
    Ahead,
    /// Since a time, s, and an event.
    Active(f64, u64),
    Over,
}

impl Schedule {
    /// Those of all faults that show on a wire.
    pub(crate) fn new(faults: &[Fault], wire: Wire) -> Self {
        let here = faults.iter().filter(|fault| fault.what.wire() == wire);
        Self {
            faults: here.map(|fault| (*fault, Stage::Ahead)).collect(),
            count: 0,
        }
    }

    /// The next event happens: its number, from 0, and what goes wrong once now.
    pub(crate) fn next_event(&mut self, now_s: f64) -> (u64, Vec<What>) {
        let event = self.count;
        let happened = self.look(now_s);
        self.count += 1;
        (event, happened)
    }

    /// What goes wrong once now, with the next event still ahead.
    pub(crate) fn look(&mut self, now_s: f64) -> Vec<What> {
        let mut happened = Vec::new();
        for (fault, stage) in &mut self.faults {
            let is_due = match fault.begins {
                Moment::TimeS(time_s) => now_s >= time_s,
                Moment::Count(count) => self.count >= count,
            };
            if *stage == Stage::Ahead && is_due {
                // What begins at a time has lasted since then, however late somebody looks.
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

    /// What goes wrong all the while, as of the last look.
    pub(crate) fn active(&self) -> impl Iterator<Item = What> {
        let active = self
            .faults
            .iter()
            .filter(|(_, stage)| matches!(stage, Stage::Active(..)));
        active.map(|(fault, _)| fault.what)
    }

    /// Whether one of those is this one.
    pub(crate) fn has(&self, what: What) -> bool {
        self.active().any(|active| active == what)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn lost(begins: Moment, lasts: Option<Moment>) -> Fault {
        let what = What::LostDatagrams;
        Fault { what, begins, lasts }
    }

    #[test]
    fn counts_and_times_begin_and_end_what_lasts() {
        let active_at = |fault: Fault| -> Vec<u64> {
            let mut schedule = Schedule::new(&[fault], Wire::Force);
            let mut active = Vec::new();
            for event in 0..10 {
                assert_eq!(schedule.next_event(event as f64), (event, Vec::new()));
                if schedule.has(What::LostDatagrams) {
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
        let fault = Fault {
            what: What::SwitchBrownOut,
            begins: Moment::Count(1),
            lasts: None,
        };
        let mut schedule = Schedule::new(&[fault, lost(Moment::Count(0), None)], Wire::I2c);
        let happened: Vec<usize> = (0..4).map(|_| schedule.next_event(0.0).1.len()).collect();
        assert_eq!(happened, [0, 1, 0, 0]);
        assert_eq!(schedule.active().count(), 0);
    }

    #[test]
    fn what_makes_no_sense_is_named() {
        let begins = Moment::Count(0);
        let lasts = None;
        for (fault, words) in [
            (
                Fault {
                    what: What::Short { channel: 8 },
                    begins,
                    lasts,
                },
                "`faults[0].what.channel` expected 0 to 7",
            ),
            (
                lost(Moment::TimeS(-1.0), None),
                "`faults[0].begins` expected a time not below zero",
            ),
            (
                lost(begins, Some(Moment::TimeS(f64::NAN))),
                "`faults[0].lasts` expected a time not below zero",
            ),
            (
                Fault {
                    what: What::ConnectionReset,
                    begins,
                    lasts: Some(begins),
                },
                "`faults[0].lasts` is given, but the fault happens once",
            ),
            (
                Fault {
                    what: What::ClockStretch { by_s: 0.0 },
                    begins,
                    lasts,
                },
                "`faults[0].what.by_s` expected a time above zero",
            ),
        ] {
            assert_eq!(fault.check("faults[0]").unwrap_err().to_string(), words);
        }
    }
}
