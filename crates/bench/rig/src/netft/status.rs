//! Status bits of the sensor.

use std::fmt;

/// Status bits of a record.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Status(
    /// The bits.
    pub u32,
);

/// What a status means for the readings.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Health {
    /// Readings can be trusted.
    Healthy,
    /// Readings can be trusted. A monitor condition is latched.
    Warning,
    /// Readings cannot be trusted.
    Error,
}

/// Summary bit: set whenever another bit is set.
const SUMMARY: u32 = 0x8000_0000;
const MONITOR_LATCHED: u32 = 0x0001_0000;

const NAMES: [(u32, &str); 29] = [
    (0x4000_0000, "processor or memory"),
    (0x2000_0000, "digital board"),
    (0x1000_0000, "analog board"),
    (0x0800_0000, "serial link"),
    (0x0400_0000, "program memory"),
    (0x0200_0000, "halted by its configuration"),
    (0x0100_0000, "settings not valid"),
    (0x0080_0000, "configuration does not fit the calibration"),
    (0x0040_0000, "network"),
    (0x0020_0000, "CAN"),
    (0x0010_0000, "raw data transfer"),
    (0x0008_0000, "EtherNet/IP"),
    (0x0004_0000, "DeviceNet"),
    (0x0002_0000, "saturation or A/D"),
    (MONITOR_LATCHED, "monitor condition latched"),
    (0x0000_4000, "watchdog"),
    (0x0000_2000, "stack"),
    (0x0000_1000, "EEPROM"),
    (0x0000_0800, "flash"),
    (0x0000_0400, "analog watchdog"),
    (0x0000_0200, "excitation high"),
    (0x0000_0100, "excitation low"),
    (0x0000_0080, "analog ground"),
    (0x0000_0040, "supply high"),
    (0x0000_0020, "supply low"),
    (0x0000_0010, "serial data unavailable"),
    (0x0000_0008, "reference"),
    (0x0000_0004, "temperature"),
    (0x0000_0002, "HTTP"),
];

impl Status {
    /// No bit set.
    pub const HEALTHY: Self = Self(0);

    /// What the status means for the readings.
    #[must_use]
    pub fn health(self) -> Health {
        match self.0 {
            0 => Health::Healthy,
            bits if bits == SUMMARY | MONITOR_LATCHED => Health::Warning,
            _ => Health::Error,
        }
    }

    /// Names of the bits that are set, most severe first. Bits without a known meaning have no
    /// name.
    pub fn names(self) -> impl Iterator<Item = &'static str> {
        NAMES
            .into_iter()
            .filter(move |(bit, _)| self.0 & bit != 0)
            .map(|(_, name)| name)
    }
}

impl fmt::Display for Status {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{:#010x}", self.0)?;
        let names: Vec<&str> = self.names().collect();
        if names.is_empty() {
            Ok(())
        } else {
            write!(f, " ({})", names.join(", "))
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_a_latched_monitor_alone_is_a_mere_warning() {
        for (bits, health) in [
            (0, Health::Healthy),
            (0x8001_0000, Health::Warning),
            (0x0001_0000, Health::Error),
            (0x8003_0000, Health::Error),
            (0x8000_0000, Health::Error),
            (0x8002_0000, Health::Error),
        ] {
            assert_eq!(Status(bits).health(), health, "{bits:#x}");
        }
    }

    #[test]
    fn bits_have_names() {
        assert_eq!(
            Status(0x8003_0000).to_string(),
            "0x80030000 (saturation or A/D, monitor condition latched)"
        );
        assert_eq!(Status(0).to_string(), "0x00000000");
        assert_eq!(Status(2).names().collect::<Vec<_>>(), ["HTTP"]);
        // Each bit has one name, except the summary, 0x8000 and 0x0001, which the sensor does not
        // use.
        assert_eq!(Status(u32::MAX).names().count(), 29);
    }
}
