//! What goes wrong, and when.

use serde::{Deserialize, Serialize};

use crate::{EmulateError, MOST_TAXELS};

/// Something that goes wrong, from a moment on.
///
/// ```
/// # #[derive(serde::Deserialize)]
/// # struct File { faults: Vec<twintac_emulate::ScheduledFault> }
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
pub struct ScheduledFault {
    /// What goes wrong.
    pub what: FaultKind,
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

/// Something that can go wrong. Channels are counted over all switches, by address: those of the first are 0 to 7, of the second 8 to 15.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case", deny_unknown_fields)]
pub enum FaultKind {
    /// Lasts: a channel's barometer, or without a channel every switch, does not acknowledge.
    NoAcknowledge {
        /// The channel.
        channel: Option<u8>,
    },
    /// Lasts: a channel's data line is shorted to ground, so that the bus is held while the channel is open.
    Short {
        /// The channel.
        channel: u8,
    },
    /// Happens: a channel's barometer, or without a channel the first switch, waits for nine clocks and holds the data line until it gets
    /// them. The switch's reset frees its own side.
    StuckBus {
        /// The channel.
        channel: Option<u8>,
    },
    /// Lasts: each transaction takes longer.
    ClockStretch {
        /// By how much, s.
        by_s: f64,
    },
    /// Happens: all switches lose power for a moment, and with it their masks.
    SwitchBrownOut,
    /// Happens: a channel's barometer loses power for a moment, and with it what it measures and how.
    BarometerBrownOut {
        /// The channel.
        channel: u8,
    },
    /// Happens: a channel's barometer loses what its factory calibrated it to, if it keeps that where it can be read.
    LostCalibration {
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
pub(crate) enum FaultWire {
    /// The sensor's bus.
    I2c,
    /// The robot's connections.
    Robot,
    /// The force sensor's datagrams.
    Force,
}

impl FaultKind {
    /// Where it shows.
    #[must_use]
    pub(crate) fn wire(&self) -> FaultWire {
        match self {
            Self::NoAcknowledge { .. }
            | Self::Short { .. }
            | Self::StuckBus { .. }
            | Self::ClockStretch { .. }
            | Self::SwitchBrownOut
            | Self::BarometerBrownOut { .. }
            | Self::LostCalibration { .. }
            | Self::EndlessConversion { .. } => FaultWire::I2c,
            Self::ConnectionReset | Self::RobotError { .. } | Self::UnansweredRequests => FaultWire::Robot,
            Self::LostDatagrams
            | Self::LateDatagrams { .. }
            | Self::DoubledDatagrams
            | Self::ReorderedDatagrams
            | Self::SaturatedForce => FaultWire::Force,
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
                | Self::LostCalibration { .. }
                | Self::ConnectionReset
                | Self::RobotError { .. }
        )
    }

    fn channel(&self) -> Option<u8> {
        match *self {
            Self::NoAcknowledge { channel } | Self::StuckBus { channel } => channel,
            Self::Short { channel }
            | Self::BarometerBrownOut { channel }
            | Self::LostCalibration { channel }
            | Self::EndlessConversion { channel } => Some(channel),
            _ => None,
        }
    }
}

impl ScheduledFault {
    /// That it makes sense; `field` is its path in errors.
    pub(crate) fn check(&self, field: &str) -> Result<(), EmulateError> {
        let bad = |name: &str, problem: &str| Err(EmulateError::setting(format!("{field}.{name}"), problem));
        if self
            .what
            .channel()
            .is_some_and(|channel| usize::from(channel) >= MOST_TAXELS)
        {
            return bad("what.channel", "expected 0 to 63");
        }
        if let FaultKind::ClockStretch { by_s } | FaultKind::LateDatagrams { by_s } = self.what
            && !(by_s > 0.0 && by_s.is_finite())
        {
            return bad("what.by_s", "expected a time above zero");
        }
        if matches!(self.what, FaultKind::RobotError { code: 0 }) {
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
///
/// # Errors
/// The first that does not, by its field.
pub fn check_faults(faults: &[ScheduledFault]) -> Result<(), EmulateError> {
    let mut indexed = faults.iter().enumerate();
    indexed.try_for_each(|(index, fault)| fault.check(&format!("faults[{index}]")))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn lost(begins: Moment, lasts: Option<Moment>) -> ScheduledFault {
        let what = FaultKind::LostDatagrams;
        ScheduledFault { what, begins, lasts }
    }

    #[test]
    fn what_makes_no_sense_is_named() {
        let begins = Moment::Count(0);
        let lasts = None;
        for (fault, words) in [
            (
                ScheduledFault {
                    what: FaultKind::Short { channel: 64 },
                    begins,
                    lasts,
                },
                "`faults[0].what.channel` expected 0 to 63",
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
                ScheduledFault {
                    what: FaultKind::ConnectionReset,
                    begins,
                    lasts: Some(begins),
                },
                "`faults[0].lasts` is given, but the fault happens once",
            ),
            (
                ScheduledFault {
                    what: FaultKind::ClockStretch { by_s: 0.0 },
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
