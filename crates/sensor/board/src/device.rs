//! Devices: a symbol of the schematic with its pins, and a land pattern.

use crate::land::Land;

/// The electrical type of a pin, in KiCad's terms for electrical rule checks.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Electrical {
    Supply,
    Input,
    TwoWay,
    Passive,
    Unused,
}

impl Electrical {
    pub(crate) fn word(self) -> &'static str {
        match self {
            Self::Supply => "power_in",
            Self::Input => "input",
            Self::TwoWay => "bidirectional",
            Self::Passive => "passive",
            Self::Unused => "no_connect",
        }
    }
}

/// A pin of a symbol. Its number is also that of its pads.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Pin {
    pub(crate) number: &'static str,
    pub(crate) name: &'static str,
    pub(crate) electrical: Electrical,
    /// Whether it is on the left side of the symbol.
    pub(crate) is_left: bool,
}

/// A symbol with its land pattern.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Device {
    /// The symbol's name in the project's library.
    pub(crate) symbol: &'static str,
    /// The prefix of references.
    pub(crate) prefix: &'static str,
    pub(crate) pins: Vec<Pin>,
    pub(crate) land: Land,
    /// The name in the list of parts to buy. `None` for a part that is only copper.
    pub(crate) bought: Option<&'static str>,
}

impl Device {
    pub(crate) fn pin_named(&self, name: &str) -> Option<usize> {
        self.pins.iter().position(|pin| pin.name == name)
    }
}

/// Pins of one side of a symbol, from a table of numbers, names and electrical types.
pub(crate) fn pins(is_left: bool, table: &[(&'static str, &'static str, Electrical)]) -> Vec<Pin> {
    table
        .iter()
        .map(|&(number, name, electrical)| Pin {
            number,
            name,
            electrical,
            is_left,
        })
        .collect()
}
