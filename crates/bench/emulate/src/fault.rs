//! Faults, and when they happen.

use serde::{Deserialize, Serialize};

use crate::{EmulateError, MOST_TAXELS};

/// A fault that begins at a moment.
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
    /// The fault.
    pub what: FaultKind,
    /// When it begins.
    pub begins: Moment,
    /// How long it lasts, if it is a lasting fault. If left out, it does not end.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub lasts: Option<Moment>,
}

/// A moment, or a duration.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Moment {
    /// Time of the emulator's clock, s.
    TimeS(f64),
    /// Number of an event of the connection that the fault is on, counted from 0: transactions on
    /// the bus, requests to the robot, or datagrams of the force sensor.
    Count(u64),
}

/// A fault. Lasting faults have a duration; momentary faults happen once. Channels are counted over
/// all switches, by address: the first switch has 0 to 7, the second 8 to 15.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case", deny_unknown_fields)]
pub enum FaultKind {
    /// Lasting: the barometer of a channel does not acknowledge; without a channel, no switch does.
    NoAcknowledge {
        /// The channel.
        channel: Option<u8>,
    },
    /// Lasting: the data line of a channel is shorted to ground, so the bus is held while the
    /// channel is open.
    Short {
        /// The channel.
        channel: u8,
    },
    /// Momentary: the barometer of a channel, or without a channel the first switch, holds the data
    /// line until it gets nine clocks. The switch's reset frees the switch's own side.
    StuckBus {
        /// The channel.
        channel: Option<u8>,
    },
    /// Lasting: each transaction takes longer.
    ClockStretch {
        /// Additional time, s.
        by_s: f64,
    },
    /// Momentary: all switches lose power briefly, and with it their masks.
    SwitchBrownOut,
    /// Momentary: the barometer of a channel loses power briefly, and with it its settings and its
    /// conversion.
    BarometerBrownOut {
        /// The channel.
        channel: u8,
    },
    /// Momentary: the barometer of a channel loses its factory calibration, if the calibration is
    /// kept where it can be read.
    LostCalibration {
        /// The channel.
        channel: u8,
    },
    /// Lasting: conversions of the barometer of a channel do not end.
    EndlessConversion {
        /// The channel.
        channel: u8,
    },
    /// Momentary: the robot's connections end.
    ConnectionReset,
    /// Momentary: the robot stops with an error.
    RobotError {
        /// The controller's code.
        code: u8,
    },
    /// Lasting: the robot carries out requests, and does not answer.
    UnansweredRequests,
    /// Lasting: datagrams of the force sensor are lost.
    LostDatagrams,
    /// Lasting: datagrams arrive late, after those that are not late.
    LateDatagrams {
        /// Delay, s.
        by_s: f64,
    },
    /// Lasting: datagrams arrive twice.
    DoubledDatagrams,
    /// Lasting: datagrams arrive in pairs, the second one first.
    ReorderedDatagrams,
    /// Lasting: the force sensor's gauges are saturated.
    SaturatedForce,
}

/// The connection on which a fault shows, and whose events count for it.
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
    /// The connection on which it shows.
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

    /// Whether it is lasting and not momentary.
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
    /// Checks that the fault is valid. `field` is its path in errors.
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

/// Checks that all faults are valid.
///
/// # Errors
/// The first fault that is not valid, by its field.
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
