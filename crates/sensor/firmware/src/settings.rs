//! The settings of a node.

use phystac::{Chip, Settings, Transfer, Wired, Wiring, WiringError};

/// The settings of a node.
#[derive(Clone, Copy, Debug)]
pub struct NodeSettings<const N: usize> {
    /// The chip and location of each taxel, and their timing.
    pub sensor: Settings<N>,
    /// The scale of chips with an unknown scale. `None`: readings of such chips are marked until
    /// the host sends the scale.
    pub transfer: Option<Transfer>,
    /// Time from one round to the next, µs. 0: as short as possible.
    pub period_us: u32,
    /// Time limit of a transaction, µs.
    pub transaction_us: u32,
    /// Clock of the bus, Hz, for computing rates.
    pub bus_hz: u32,
}

impl<const N: usize> NodeSettings<N> {
    /// Taxel `i` is a chip on channel `i` of the switch at 0x70, or on channel `i - 8` of the one
    /// at 0x71, and so on. Rounds as fast as possible at 400 kHz, transactions of at most 5 ms.
    ///
    /// # Errors
    /// More than 64 taxels.
    pub fn of(chip: Chip) -> Result<Self, WiringError> {
        let wired = core::array::from_fn::<_, N, _>(|taxel| {
            let switch = phystac::SwitchAddress::new(0x70 + (taxel / 8) as u8).unwrap_or_default();
            Wired {
                behind: Some((switch, (taxel % 8) as u8)),
                ..Wired::on_channel(chip, 0)
            }
        });
        Ok(Self {
            sensor: Settings::new(Wiring::new(&wired)?),
            transfer: None,
            period_us: 0,
            transaction_us: 5000,
            bus_hz: 400_000,
        })
    }
}

/// The chip whose name in [`Chip`]'s table is exactly this text, upper and lower case included. For
/// names that are given when the program is built.
///
/// # Panics
/// There is no such chip. In a constant, the build fails then.
#[must_use]
pub const fn chip_named(name: &str) -> Chip {
    let mut index = 0;
    while index < Chip::ALL.len() {
        if is_same(Chip::ALL[index].data().name.as_bytes(), name.as_bytes()) {
            return Chip::ALL[index];
        }
        index += 1;
    }
    panic!(
        "no chip has this name: expected one as in the table of docs/guides/hardware.md, such as `MS5837-30BA`"
    )
}

/// The counts per Pa in a text; 0 for an empty text. For values that are given when the program is
/// built.
///
/// # Panics
/// The text is not a number from 0 to 65535. In a constant, the build fails then.
#[must_use]
pub const fn scale_of(text: &str) -> u16 {
    if text.is_empty() {
        return 0;
    }
    match u16::from_str_radix(text, 10) {
        Ok(scale) => scale,
        Err(_) => panic!("the scale is not a number of counts per Pa: expected one such as `32`"),
    }
}

const fn is_same(one: &[u8], other: &[u8]) -> bool {
    if one.len() != other.len() {
        return false;
    }
    let mut index = 0;
    while index < one.len() {
        if one[index] != other[index] {
            return false;
        }
        index += 1;
    }
    true
}

#[cfg(test)]
mod tests {
    use super::*;

    const CHIP: Chip = chip_named("MS5837-02BA");

    #[test]
    fn chips_are_found_when_the_program_is_built() {
        assert_eq!(CHIP, Chip::Ms5837_02Ba);
        for chip in Chip::ALL {
            assert_eq!(chip_named(chip.data().name), *chip);
        }
        assert_eq!((scale_of(""), scale_of("32")), (0, 32));
        let settings = NodeSettings::<12>::of(Chip::Bmp390).unwrap();
        let places = settings.sensor.wiring.taxels().map(|wired| {
            let (switch, channel) = wired.behind.unwrap();
            (switch.get(), channel)
        });
        assert!(places.eq((0..12).map(|taxel| (0x70 + taxel / 8, taxel % 8))));
    }

    #[test]
    #[should_panic(expected = "no chip has this name")]
    fn a_name_that_is_none_is_refused() {
        let _ = chip_named("BMP280");
    }
}
