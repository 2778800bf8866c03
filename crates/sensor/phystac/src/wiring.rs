//! The chip and the location of each taxel.

use core::fmt;

use crate::channels::{Channels, SwitchAddress};
use crate::chip::{Chip, Speed};

/// A taxel's barometer and its location on the bus.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Wired {
    /// The chip.
    pub chip: Chip,
    /// The chip's 7-bit address.
    pub address: u8,
    /// The switch, and its channel, 0 to 7. `None`: the chip is on the bus itself.
    pub behind: Option<(SwitchAddress, u8)>,
    /// Samples averaged for one pressure. `None`: the chip's
    /// [`usual_samples`](crate::ChipData::usual_samples).
    pub samples: Option<u16>,
}

impl Wired {
    /// A chip at its first address, on a channel of a switch at 0x70.
    #[must_use]
    pub fn on_channel(chip: Chip, channel: u8) -> Self {
        Self {
            chip,
            address: chip.data().addresses[0],
            behind: Some((SwitchAddress::default(), channel)),
            samples: None,
        }
    }

    /// Whether it is behind the switch with this address.
    fn is_behind(&self, address: u8) -> bool {
        self.behind.is_some_and(|(switch, _)| switch.get() == address)
    }
}

/// The location of a taxel, checked.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Place {
    pub(crate) chip: Chip,
    pub(crate) address: u8,
    /// The switch's address, and its one channel.
    pub(crate) behind: Option<(SwitchAddress, Channels)>,
}

/// Chip and location of up to `N` taxels, such that each can be addressed alone. `N` is at most 64.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Wiring<const N: usize>([Option<Wired>; N]);

impl<const N: usize> Wiring<N> {
    /// The wiring of these taxels, in their order.
    ///
    /// # Errors
    /// Taxels that cannot be wired so, or cannot be distinguished on the bus.
    pub fn new(taxels: &[Wired]) -> Result<Self, WiringError> {
        const { assert!(N <= 64, "a sensor has at most 64 taxels") }
        if taxels.len() > N {
            return Err(WiringError::TooMany { most: N });
        }
        let mut wiring = [None; N];
        for (taxel, wired) in taxels.iter().enumerate() {
            check_alone(taxel, wired)?;
            for (other, before) in taxels[..taxel].iter().enumerate() {
                check_pair((taxel, wired), (other, before))?;
            }
            wiring[taxel] = Some(*wired);
        }
        Ok(Self(wiring))
    }

    /// Taxel `i` is a CPS135B on channel `channels[i]` of a switch at 0x70.
    ///
    /// # Errors
    /// A channel beyond 7, or given twice.
    pub fn of_cps135b(channels: [u8; N]) -> Result<Self, WiringError> {
        Self::new(&channels.map(|channel| Wired::on_channel(Chip::Cps135b, channel)))
    }

    /// The taxels that are wired, in their order.
    pub fn taxels(&self) -> impl Iterator<Item = Wired> + use<N> {
        self.0.into_iter().flatten()
    }

    pub(crate) fn place(&self, taxel: usize) -> Option<Place> {
        let wired = (*self.0.get(taxel)?)?;
        Some(Place {
            chip: wired.chip,
            address: wired.address,
            behind: wired
                .behind
                .and_then(|(switch, channel)| Some((switch, Channels::only(channel)?))),
        })
    }

    pub(crate) fn speed(&self, taxel: usize) -> Option<Speed> {
        let wired = (*self.0.get(taxel)?)?;
        wired.chip.data().speed(wired.samples)?
    }

    /// The switches, each once.
    pub(crate) fn switches(&self) -> impl Iterator<Item = SwitchAddress> + use<N> {
        let used = self.taxels().fold(0_u8, |used, wired| {
            used | wired
                .behind
                .map_or(0, |(switch, _)| 1 << (switch.get() - SwitchAddress::FIRST))
        });
        (0..8)
            .filter(move |number| used >> number & 1 == 1)
            .filter_map(|number| SwitchAddress::new(SwitchAddress::FIRST + number))
    }
}

/// Taxel `i` is a CPS135B on channel `i` of a switch at 0x70: the PhysTac.
impl Default for Wiring<8> {
    fn default() -> Self {
        Self([0, 1, 2, 3, 4, 5, 6, 7].map(|channel| Some(Wired::on_channel(Chip::Cps135b, channel))))
    }
}

fn check_alone(taxel: usize, wired: &Wired) -> Result<(), WiringError> {
    let data = wired.chip.data();
    if !data.addresses.contains(&wired.address) {
        let (chip, address) = (wired.chip, wired.address);
        return Err(WiringError::Address { taxel, chip, address });
    }
    if let Some((_, channel)) = wired.behind
        && channel > 7
    {
        return Err(WiringError::Channel { taxel, channel });
    }
    if wired.is_behind(wired.address) {
        return Err(WiringError::AddressOfSwitch { taxel, other: taxel });
    }
    if data.speed(wired.samples).is_none() {
        let (chip, samples) = (wired.chip, wired.samples.unwrap_or_default());
        return Err(WiringError::Samples { taxel, chip, samples });
    }
    Ok(())
}

fn check_pair((taxel, one): (usize, &Wired), (other, two): (usize, &Wired)) -> Result<(), WiringError> {
    if one.is_behind(two.address) || two.is_behind(one.address) {
        return Err(WiringError::AddressOfSwitch { taxel, other });
    }
    if one.address != two.address {
        return Ok(());
    }
    match (one.behind, two.behind) {
        (Some(here), Some(there)) if here != there => Ok(()),
        (Some(_), None) | (None, Some(_)) => Err(WiringError::Hidden { taxel, other }),
        _ => Err(WiringError::SamePlace { taxel, other }),
    }
}

/// Why taxels cannot be wired so.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum WiringError {
    /// There are more taxels than the driver's capacity.
    TooMany {
        /// The capacity.
        most: usize,
    },
    /// The chip cannot have this address.
    Address {
        /// The taxel.
        taxel: usize,
        /// Its chip.
        chip: Chip,
        /// The address.
        address: u8,
    },
    /// The channel is beyond the switch's channels 0 to 7.
    Channel {
        /// The taxel.
        taxel: usize,
        /// The channel.
        channel: u8,
    },
    /// The chip has no such number of samples.
    Samples {
        /// The taxel.
        taxel: usize,
        /// Its chip.
        chip: Chip,
        /// The samples.
        samples: u16,
    },
    /// Two taxels answer at the same address of the same channel.
    SamePlace {
        /// The taxel.
        taxel: usize,
        /// The taxel before it with the same location.
        other: usize,
    },
    /// One of two taxels is on the bus itself and has the same address as the other, which is
    /// behind a switch: both would answer.
    Hidden {
        /// The second of the two.
        taxel: usize,
        /// The first of the two.
        other: usize,
    },
    /// One of the two has the address of a switch.
    AddressOfSwitch {
        /// The second of the two.
        taxel: usize,
        /// The first of the two.
        other: usize,
    },
}

impl WiringError {
    /// The index of the taxel that is wrong, if it is one.
    #[must_use]
    pub const fn taxel(&self) -> Option<usize> {
        match self {
            Self::TooMany { .. } => None,
            Self::Address { taxel, .. }
            | Self::Channel { taxel, .. }
            | Self::Samples { taxel, .. }
            | Self::SamePlace { taxel, .. }
            | Self::Hidden { taxel, .. }
            | Self::AddressOfSwitch { taxel, .. } => Some(*taxel),
        }
    }
}

impl fmt::Display for WiringError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::TooMany { most } => write!(f, "there are more than {most} taxels"),
            Self::Address { chip, address, .. } => {
                write!(f, "{address:#04x} is not an address of a {chip}, which can have")?;
                for (index, possible) in chip.data().addresses.iter().enumerate() {
                    write!(f, "{} {possible:#04x}", if index == 0 { "" } else { " or" })?;
                }
                Ok(())
            }
            Self::Channel { channel, .. } => write!(f, "{channel} is not a channel of a switch, 0 to 7"),
            Self::Samples { chip, samples, .. } => {
                write!(f, "a {chip} cannot average over {samples} samples, but over")?;
                for (index, speed) in chip.data().speeds.iter().enumerate() {
                    write!(f, "{} {}", if index == 0 { "" } else { "," }, speed.samples)?;
                }
                Ok(())
            }
            Self::SamePlace { other, .. } => {
                write!(
                    f,
                    "has the address and the channel of taxel {other}: both would answer at once"
                )
            }
            Self::Hidden { other, .. } => write!(
                f,
                "has the address of taxel {other}, and one of the two is behind no switch: both would answer at once"
            ),
            Self::AddressOfSwitch { other, .. } => {
                write!(
                    f,
                    "a switch has the address of a barometer, of this taxel or of taxel {other}"
                )
            }
        }
    }
}

impl core::error::Error for WiringError {}

#[cfg(test)]
mod tests {
    use std::string::ToString;

    use super::*;

    fn bmp(address: u8, switch: u8, channel: u8) -> Wired {
        Wired {
            chip: Chip::Bmp390,
            address,
            behind: SwitchAddress::new(switch).map(|switch| (switch, channel)),
            samples: None,
        }
    }

    fn on_the_bus(chip: Chip, address: u8) -> Wired {
        Wired {
            chip,
            address,
            behind: None,
            samples: None,
        }
    }

    #[test]
    fn what_each_taxel_can_be_told_from_is_wired() {
        let pair = [
            bmp(0x76, 0x70, 3),
            bmp(0x77, 0x70, 3),
            bmp(0x76, 0x71, 3),
            on_the_bus(Chip::Mpl3115a2, 0x60),
        ];
        let wiring = Wiring::<8>::new(&pair).unwrap();
        assert_eq!(wiring.taxels().count(), 4);
        assert!(wiring.switches().map(SwitchAddress::get).eq([0x70, 0x71]));
        assert_eq!(wiring.place(4), None);
        let full: [u8; 8] = core::array::from_fn(|index| index as u8);
        assert_eq!(Wiring::of_cps135b(full), Ok(Wiring::default()));
    }

    #[test]
    fn what_would_speak_at_once_is_refused() {
        let wrong = |taxels: &[Wired]| Wiring::<4>::new(taxels).unwrap_err();
        assert_eq!(
            wrong(&[bmp(0x76, 0x70, 1); 2]),
            WiringError::SamePlace { taxel: 1, other: 0 }
        );
        assert_eq!(
            wrong(&[bmp(0x76, 0x70, 1), on_the_bus(Chip::Bmp390, 0x76)]),
            WiringError::Hidden { taxel: 1, other: 0 }
        );
        assert_eq!(
            wrong(&[bmp(0x76, 0x70, 1), bmp(0x77, 0x76, 1)]),
            WiringError::AddressOfSwitch { taxel: 1, other: 0 }
        );
        assert_eq!(
            wrong(&[bmp(0x76, 0x70, 8)]),
            WiringError::Channel { taxel: 0, channel: 8 }
        );
        assert_eq!(wrong(&[bmp(0x76, 0x70, 0); 5]), WiringError::TooMany { most: 4 });
        let samples = Wired {
            samples: Some(5),
            ..bmp(0x76, 0x70, 0)
        };
        assert_eq!(
            wrong(&[samples]).to_string(),
            "a BMP390 cannot average over 5 samples, but over 1, 2, 4, 8, 16, 32"
        );
        assert_eq!(
            wrong(&[bmp(0x75, 0x70, 0)]).to_string(),
            "0x75 is not an address of a BMP390, which can have 0x76 or 0x77"
        );
        assert!(Wiring::of_cps135b([3, 5, 3]).is_err());
    }
}
