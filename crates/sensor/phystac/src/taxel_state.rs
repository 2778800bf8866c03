//! The state of a taxel as a number, for files and serial lines.

use core::fmt;

use crate::Fault;

/// Whether a taxel's pressure can be used, and if not, why. Logs and serial lines contain these
/// numbers: they never change.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[repr(u8)]
pub enum TaxelState {
    /// The pressure can be used.
    #[default]
    Good = 0,
    /// Its barometer does not acknowledge.
    Missing = 1,
    /// It has no sample of this frame: its conversion did not end in time, or was lost when the
    /// part lost power.
    Stuck = 2,
    /// The bus failed while its channel was open.
    BusError = 3,
    /// Its channel hung the bus and stays closed.
    Isolated = 4,
    /// Its barometer does not keep its settings.
    Refused = 5,
    /// Its pressure is at an end of the range or beyond.
    Saturated = 6,
    /// Its value no longer changes.
    Frozen = 7,
    /// The part at its address is not the one described.
    WrongChip = 8,
    /// The calibration of its barometer cannot be read, or fails its check.
    Uncalibrated = 9,
    /// Its barometer lost power, and with it its settings.
    Restarted = 10,
    /// The barometer only counts, and its scale was not given.
    Unscaled = 11,
}

impl TaxelState {
    /// All states, each at the index of its number.
    const ALL: [Self; 12] = [
        Self::Good,
        Self::Missing,
        Self::Stuck,
        Self::BusError,
        Self::Isolated,
        Self::Refused,
        Self::Saturated,
        Self::Frozen,
        Self::WrongChip,
        Self::Uncalibrated,
        Self::Restarted,
        Self::Unscaled,
    ];

    /// Why the pressure cannot be used, in one or two words. `None` if it can.
    #[must_use]
    pub const fn fault(self) -> Option<&'static str> {
        match self {
            Self::Good => None,
            Self::Missing => Some("missing"),
            Self::Stuck => Some("stuck"),
            Self::BusError => Some("bus error"),
            Self::Isolated => Some("isolated"),
            Self::Refused => Some("refused"),
            Self::Saturated => Some("saturated"),
            Self::Frozen => Some("frozen"),
            Self::WrongChip => Some("wrong chip"),
            Self::Uncalibrated => Some("uncalibrated"),
            Self::Restarted => Some("restarted"),
            Self::Unscaled => Some("no scale"),
        }
    }

    /// The state with this number. `None`: there is no such state.
    #[must_use]
    pub fn from_code(code: u8) -> Option<Self> {
        Self::ALL.get(usize::from(code)).copied()
    }
}

impl From<Fault> for TaxelState {
    fn from(fault: Fault) -> Self {
        match fault {
            Fault::Missing | Fault::NotWired => Self::Missing,
            Fault::Stuck => Self::Stuck,
            Fault::Bus(_) => Self::BusError,
            Fault::Isolated => Self::Isolated,
            Fault::Refused => Self::Refused,
            Fault::Saturated => Self::Saturated,
            Fault::Frozen => Self::Frozen,
            Fault::WrongChip => Self::WrongChip,
            Fault::Uncalibrated => Self::Uncalibrated,
            Fault::Restarted => Self::Restarted,
        }
    }
}

/// `good`, or the fault in one or two words.
impl fmt::Display for TaxelState {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.fault().unwrap_or("good"))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_state_has_its_number() {
        for (number, state) in (0_u8..).zip(TaxelState::ALL) {
            assert_eq!(
                (state as u8, TaxelState::from_code(number)),
                (number, Some(state))
            );
        }
        assert_eq!(TaxelState::from_code(12), None);
    }
}
