//! Which chips a sensor's taxels are, and where they are on the bus.

use phystac::{Chip, SwitchAddress, Wired, Wiring, WiringError};

use crate::{Sensor, Taxel};

/// The most taxels that a sensor can be read with.
pub const MOST_TAXELS: usize = 64;

/// A field that is wrong, what is wrong with it, and what to do.
pub(crate) struct Miswired {
    pub(crate) field: String,
    pub(crate) problem: String,
    pub(crate) remedy: String,
}

impl Sensor {
    /// Whether it says how its taxels are wired. One that does not is not read over I²C.
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

    /// How its taxels are wired, in their order.
    ///
    /// # Errors
    /// What cannot be wired; no description that [`is_wired`](Self::is_wired) and was read.
    pub fn wiring(&self) -> Result<Wiring<MOST_TAXELS>, WiringError> {
        let wired: Vec<Wired> = self.taxels.iter().filter_map(|taxel| self.wired(taxel)).collect();
        Wiring::new(&wired)
    }

    /// Whether somebody must confirm what counts of any of its chips stand for.
    #[must_use]
    pub fn has_unscaled_chips(&self) -> bool {
        let mut chips = self.taxels.iter().filter_map(|taxel| self.chip(taxel));
        chips.any(|chip| !chip.data().knows_its_scale)
    }

    /// The chip of a taxel. `None`: nobody makes one of that name.
    #[must_use]
    pub fn chip(&self, taxel: &Taxel) -> Option<Chip> {
        match taxel.chip.as_deref().or(self.readout.chip.as_deref()) {
            Some(name) => Chip::named(name),
            None => Some(Chip::Cps135b),
        }
    }

    /// How many of which chips, for people to read.
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

    /// What is wrong with the wiring, if anything is.
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
                (Some(_), None) => "stands without a channel".to_owned(),
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

    /// What is wrong, with the fields that a reader finds in the file.
    fn told(&self, error: WiringError) -> String {
        match error {
            WiringError::SamePlace { taxel, other } => {
                let channel = self.taxels[taxel]
                    .channel
                    .map_or("left out".to_owned(), |channel| channel.to_string());
                format!("is {channel}, as that of taxels[{other}], whose chip has the same address")
            }
            WiringError::Hidden { other, .. } => format!(
                "is such that one of this taxel and taxels[{other}] is behind no switch, and their chips have the same address"
            ),
            error => format!("cannot be: {error}"),
        }
    }
}

fn unknown_chip(index: Option<usize>, name: &str) -> Miswired {
    let known: Vec<&str> = Chip::ALL.iter().map(|chip| chip.data().name).collect();
    Miswired {
        field: index.map_or("readout.chip".to_owned(), |index| format!("taxels[{index}].chip")),
        problem: format!("is `{name}`, which nobody here can read"),
        remedy: format!("give one of {}", known.join(", ")),
    }
}
