//! What a node is told when it starts.

use phystac::{Chip, Settings, Transfer, Wired, Wiring, WiringError};

/// How a node reads.
#[derive(Clone, Copy, Debug)]
pub struct NodeSettings<const N: usize> {
    /// Which chip each taxel is and where, and how long they take.
    pub sensor: Settings<N>,
    /// What counts stand for, of chips that do not know it. `None`: those are marked until the host says it.
    pub transfer: Option<Transfer>,
    /// Time from one round to the next, µs. 0: as short as it can be.
    pub period_us: u32,
    /// After how long a transaction is given up, µs.
    pub transaction_us: u32,
    /// Clock of the bus, Hz, for what is said of rates.
    pub bus_hz: u32,
}

impl<const N: usize> NodeSettings<N> {
    /// Taxel `i` a chip on channel `i` of the switch at 0x70, or on channel `i - 8` of the one at 0x71, and so on. As quick as it can be at
    /// 400 kHz, transactions of at most 5 ms.
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

/// The chip of that name as it stands in [`Chip`]'s table, capitals and all: for names that are given when the program is built.
///
/// # Panics
/// If there is none. In a constant, the build fails then.
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

/// The counts per Pa that stand in a text; 0 for an empty one: for what is given when the program is built.
///
/// # Panics
/// If it is no number from 0 to 65535. In a constant, the build fails then.
#[must_use]
pub const fn scale_of(text: &str) -> u16 {
    if text.is_empty() {
        return 0;
    }
    match u16::from_str_radix(text, 10) {
        Ok(scale) => scale,
        Err(_) => panic!("the scale is no number of counts per Pa: expected one such as `32`"),
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
