//! The chips of a sensor's taxels and their locations on the bus.

use phystac::{Chip, SwitchAddress, Wired, Wiring, WiringError};

use crate::{Sensor, Taxel};

/// The largest number of taxels that can be read.
pub const MOST_TAXELS: usize = 64;

/// A wrong field, what is wrong with it, and what to do.
pub(crate) struct Miswired {
    pub(crate) field: String,
    pub(crate) problem: String,
    pub(crate) remedy: String,
}

impl Sensor {
    /// Whether the description says how the taxels are wired. If not, the sensor is not read over
    /// I²C.
    #[must_use]
    pub fn is_wired(&self) -> bool {
        let says = |taxel: &Taxel| {
            taxel.channel.is_some()
                || taxel.switch.is_some()
                || taxel.address.is_some()
                || taxel.chip.is_some()
        };
        self.readout.chip.is_some() || self.taxels.iter().any(says)
    }

    /// The wiring of the taxels, in their order.
    ///
    /// # Errors
    /// The taxels cannot be wired so. This does not happen for a description that was read and
    /// [`is_wired`](Self::is_wired).
    pub fn wiring(&self) -> Result<Wiring<MOST_TAXELS>, WiringError> {
        let wired: Vec<Wired> = self.taxels.iter().filter_map(|taxel| self.wired(taxel)).collect();
        Wiring::new(&wired)
    }

    /// Whether any chip has an unknown scale of counts, which somebody must confirm.
    #[must_use]
    pub fn has_unscaled_chips(&self) -> bool {
        let mut chips = self.taxels.iter().filter_map(|taxel| self.chip(taxel));
        chips.any(|chip| !chip.data().knows_its_scale)
    }

    /// The chip of a taxel. `None`: there is no chip of this name.
    #[must_use]
    pub fn chip(&self, taxel: &Taxel) -> Option<Chip> {
        match taxel.chip.as_deref().or(self.readout.chip.as_deref()) {
            Some(name) => Chip::named(name),
            None => Some(Chip::Cps135b),
        }
    }

    /// Number and kind of chips as text.
    pub(crate) fn chips_in_words(&self) -> String {
        let mut kinds: Vec<(Chip, usize)> = Vec::new();
        for chip in self.taxels.iter().filter_map(|taxel| self.chip(taxel)) {
            match kinds.iter_mut().find(|(kind, _)| *kind == chip) {
                Some((_, n)) => *n += 1,
                None => kinds.push((chip, 1)),
            }
        }
        let kinds: Vec<String> = kinds.iter().map(|(chip, n)| format!("{n} {chip}")).collect();
        kinds.join(", ")
    }

    fn wired(&self, taxel: &Taxel) -> Option<Wired> {
        let chip = self.chip(taxel)?;
        let switch = taxel
            .switch
            .map_or(Some(SwitchAddress::default()), SwitchAddress::new)?;
        Some(Wired {
            chip,
            address: taxel.address.unwrap_or(chip.data().addresses[0]),
            behind: taxel.channel.map(|channel| (switch, channel)),
            samples: taxel.samples.or(self.readout.samples),
        })
    }

    /// The first error in the wiring.
    pub(crate) fn miswired(&self) -> Option<Miswired> {
        if !self.is_wired() {
            return None;
        }
        let of_taxels = self
            .taxels
            .iter()
            .enumerate()
            .map(|(index, taxel)| (Some(index), taxel.chip.as_deref()));
        for (index, name) in std::iter::once((None, self.readout.chip.as_deref())).chain(of_taxels) {
            if let Some(name) = name.filter(|name| Chip::named(name).is_none()) {
                return Some(unknown_chip(index, name));
            }
        }
        for (index, taxel) in self.taxels.iter().enumerate() {
            let problem = match (taxel.switch, taxel.channel) {
                (Some(_), None) => "is given without a channel".to_owned(),
                (Some(switch), _) if SwitchAddress::new(switch).is_none() => format!("is {switch:#04x}"),
                _ => continue,
            };
            return Some(Miswired {
                field: format!("taxels[{index}].switch"),
                problem,
                remedy:
                    "give an address from 0x70 to 0x77 and a channel, or neither for a chip on the bus itself"
                        .to_owned(),
            });
        }
        let error = self.wiring().err()?;
        let name = match error {
            WiringError::Address { .. } | WiringError::AddressOfSwitch { .. } => "address",
            WiringError::Samples { .. } => "samples",
            _ => "channel",
        };
        let field = error
            .taxel()
            .map_or("taxels".to_owned(), |index| format!("taxels[{index}].{name}"));
        let remedy = match error {
            WiringError::TooMany { .. } => "describe fewer taxels",
            WiringError::Samples { .. } => "give one of those",
            WiringError::Address { .. } => "give one of those, or leave it out",
            WiringError::AddressOfSwitch { .. } => "give the switch another address",
            WiringError::Channel { .. } => {
                "give its `switch` and a channel of that; a sensor that is not read over I2C needs no channels"
            }
            _ => "give each taxel a channel, an address or a switch of its own",
        };
        Some(Miswired {
            field,
            problem: self.told(error),
            remedy: remedy.to_owned(),
        })
    }

    /// The error as text, with the fields that a reader finds in the file.
    fn told(&self, error: WiringError) -> String {
        match error {
            WiringError::SamePlace { taxel, other } => {
                let channel = self.taxels[taxel]
                    .channel
                    .map_or("left out".to_owned(), |channel| channel.to_string());
                format!("is {channel}, the same as that of taxels[{other}], whose chip has the same address")
            }
            WiringError::Hidden { other, .. } => format!(
                "is wrong: this taxel or taxels[{other}] is not behind a switch, and their chips have the same address"
            ),
            error => format!("cannot be: {error}"),
        }
    }
}

fn unknown_chip(index: Option<usize>, name: &str) -> Miswired {
    let known: Vec<&str> = Chip::ALL.iter().map(|chip| chip.data().name).collect();
    Miswired {
        field: index.map_or("readout.chip".to_owned(), |index| format!("taxels[{index}].chip")),
        problem: format!("is `{name}`, which cannot be read"),
        remedy: format!("give one of {}", known.join(", ")),
    }
}
