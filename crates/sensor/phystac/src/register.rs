//! The barometer's registers: which bytes go out, and what those that come back mean.
//!
//! The map is the one that CFSensor's XGZP6847D and XGZP6897D (data sheet V2.5) and NOVOSENSE's NSA2300 share.

use crate::conversion::{Counts, Sample};

/// The 7-bit address, the same for every part.
pub(crate) const ADDRESS: u8 = 0x6D;

/// Pressure, 3 bytes, then temperature, 2 bytes; the most significant first.
pub(crate) const DATA: u8 = 0x06;
/// What the part does, and whether it still does.
pub(crate) const COMMAND: u8 = 0x30;
/// Input swap, the factory's gain, and in the lowest three bits the oversampling of the pressure.
pub(crate) const PRESSURE_CONFIGURATION: u8 = 0xA6;

/// A register and what it is written.
///
/// There are two ways to make one. None makes code 100 of [`COMMAND`], which would burn the part's one-time memory.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Write([u8; 2]);

impl Write {
    /// Starts one conversion of temperature, then pressure.
    pub(crate) const TRIGGER: Self = Self([COMMAND, 0b0000_1010]);

    /// Sets the oversampling in what [`PRESSURE_CONFIGURATION`] was read as; its upper bits are the factory's and stay.
    pub(crate) const fn oversampling(oversampling: Oversampling, configuration: u8) -> Self {
        let kept = configuration & !Oversampling::BITS;
        Self([PRESSURE_CONFIGURATION, kept | oversampling as u8])
    }

    pub(crate) const fn bytes(self) -> [u8; 2] {
        self.0
    }
}

/// Whether the byte read from [`COMMAND`] says that a conversion is under way (`Sco`, which clears itself at the end).
pub(crate) const fn is_converting(command: u8) -> bool {
    command & 0b0000_1000 != 0
}

/// The sample in the five bytes read from [`DATA`]; none in zeros, which a part holds that woke up and has not converted since.
///
/// Counts of 0 at 0 °C sharp would look the same, but are no air.
pub(crate) fn sample(data: [u8; 5]) -> Option<Sample> {
    let [high, middle, low, temperature @ ..] = data;
    (data != [0; 5]).then(|| Sample {
        counts: Counts::from_be_bytes([high, middle, low]),
        temperature_c: f32::from(i16::from_be_bytes(temperature)) / 256.0,
    })
}

/// How many conversions the part averages into one pressure.
///
/// More is quieter and slower; how much slower is not published. The part wakes up with what its factory set.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[allow(missing_docs)] // the names say it
pub enum Oversampling {
    X256 = 0b100,
    X512 = 0b101,
    X1024 = 0b000,
    X2048 = 0b001,
    X4096 = 0b010,
    X8192 = 0b011,
    X16384 = 0b110,
    X32768 = 0b111,
}

impl Oversampling {
    const BITS: u8 = 0b111;

    /// What the byte read from [`PRESSURE_CONFIGURATION`] says.
    pub(crate) const fn of(configuration: u8) -> Self {
        match configuration & Self::BITS {
            0b000 => Self::X1024,
            0b001 => Self::X2048,
            0b010 => Self::X4096,
            0b011 => Self::X8192,
            0b100 => Self::X256,
            0b101 => Self::X512,
            0b110 => Self::X16384,
            _ => Self::X32768,
        }
    }

    /// Conversions averaged.
    #[must_use]
    pub const fn samples(self) -> u32 {
        match self {
            Self::X256 => 256,
            Self::X512 => 512,
            Self::X1024 => 1024,
            Self::X2048 => 2048,
            Self::X4096 => 4096,
            Self::X8192 => 8192,
            Self::X16384 => 16384,
            Self::X32768 => 32768,
        }
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    #[test]
    fn golden_bytes() {
        assert_eq!(Write::TRIGGER.bytes(), [0x30, 0x0A]);
        assert!(is_converting(0x0A) && !is_converting(0x02));
        let sample = sample([0x31, 0x79, 0x80, 0x19, 0x80]).unwrap();
        assert_eq!(sample.counts.unsigned(), 3_242_368);
        assert_eq!(sample.temperature_c, 25.5);
    }

    #[test]
    fn the_factorys_gain_stays() {
        assert_eq!(Oversampling::of(0x28), Oversampling::X1024);
        assert_eq!(
            Write::oversampling(Oversampling::X4096, 0x28).bytes(),
            [0xA6, 0x2A]
        );
        assert_eq!(
            Write::oversampling(Oversampling::X32768, 0xFA).bytes(),
            [0xA6, 0xFF]
        );
    }

    proptest! {
        #[test]
        fn oversampling_reads_back_as_written(configuration: u8, code in 0_u8..8) {
            let oversampling = Oversampling::of(code);
            let [register, written] = Write::oversampling(oversampling, configuration).bytes();
            prop_assert_eq!(register, PRESSURE_CONFIGURATION);
            prop_assert_eq!(Oversampling::of(written), oversampling);
            prop_assert_eq!(written & !7, configuration & !7);
        }

        #[test]
        fn any_five_bytes_but_zeros_are_a_sample(data: [u8; 5]) {
            let Some(sample) = sample(data) else {
                prop_assert_eq!(data, [0; 5]);
                return Ok(());
            };
            let [a, b, c, d, e] = data;
            prop_assert_eq!(sample.counts.unsigned(), u32::from_be_bytes([0, a, b, c]));
            prop_assert_eq!(sample.temperature_c * 256.0, f32::from(i16::from_be_bytes([d, e])));
        }
    }
}
