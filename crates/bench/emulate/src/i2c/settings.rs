//! Settings of the board.

use serde::{Deserialize, Serialize};

use super::barometer_settings::BarometerSettings;
use super::chip::{CHIPS, kind};
use crate::error::{check_not_negative, check_positive};
use crate::{EmulateError, MOST_TAXELS};

/// A board of switches and barometers, and its bus.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct BoardSettings {
    /// Clock frequency of the bus, Hz.
    pub bus_hz: f64,
    /// Time after which the controller gives up a transaction that cannot begin, s.
    pub timeout_s: f64,
    /// The barometers, in the order of the pressures that they feel.
    pub parts: Vec<PartSettings>,
    /// The properties of a CPS135B that no data sheet states.
    pub barometer: BarometerSettings,
    /// Standard deviation of readings, Pa, of chips other than the CPS135B. If left out: that of
    /// their data sheets.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub noise_pa: Option<f64>,
    /// Seed of the noise and of the differences between parts.
    pub seed: u64,
}

/// A barometer and its position on the bus.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct PartSettings {
    /// The manufacturer's name of the chip, such as `BMP390`.
    pub chip: String,
    /// Its 7-bit address. If left out: the chip's first address.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub address: Option<u8>,
    /// The 7-bit address of the switch that it is behind. If left out: it is on the bus itself.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub switch: Option<u8>,
    /// The channel of that switch, 0 to 7.
    #[serde(default)]
    pub channel: u8,
}

impl PartSettings {
    /// A chip on a channel of a switch at 0x70.
    #[must_use]
    pub fn on_channel(chip: &str, channel: u8) -> Self {
        Self {
            chip: chip.to_owned(),
            address: None,
            switch: Some(0x70),
            channel,
        }
    }

    /// The 7-bit address. 0 for an unknown chip.
    pub(super) fn address(&self) -> u8 {
        let usual = kind(&self.chip).map_or(0, |kind| kind.addresses[0]);
        self.address.unwrap_or(usual)
    }

    fn check(&self, field: &str) -> Result<(), EmulateError> {
        let bad =
            |name: &str, problem: String| Err(EmulateError::setting(format!("{field}.{name}"), problem));
        let Some(kind) = kind(&self.chip) else {
            let names: Vec<&str> = CHIPS.iter().map(|kind| kind.name).collect();
            return bad(
                "chip",
                format!("is `{}`, expected one of {}", self.chip, names.join(", ")),
            );
        };
        if !kind.addresses.contains(&self.address()) {
            return bad(
                "address",
                format!("is {:#04x}, which a {} cannot have", self.address(), kind.name),
            );
        }
        match self.switch {
            Some(switch) if !(0x70..=0x77).contains(&switch) => {
                bad("switch", format!("is {switch:#04x}, expected 0x70 to 0x77"))
            }
            Some(_) if self.channel >= 8 => bad("channel", format!("is {}, expected 0 to 7", self.channel)),
            _ => Ok(()),
        }
    }
}

impl Default for BoardSettings {
    /// Eight CPS135B on a bus of 400 kHz, behind a switch at 0x70, seed 1.
    fn default() -> Self {
        Self {
            bus_hz: 400_000.0,
            timeout_s: 1e-3,
            parts: (0..8)
                .map(|channel| PartSettings::on_channel("CPS135B", channel))
                .collect(),
            barometer: BarometerSettings::default(),
            noise_pa: None,
            seed: 1,
        }
    }
}

impl BoardSettings {
    /// The addresses of the switches, each once, lowest first.
    pub(super) fn switches(&self) -> Vec<u8> {
        let mut addresses: Vec<u8> = self.parts.iter().filter_map(|part| part.switch).collect();
        addresses.sort_unstable();
        addresses.dedup();
        addresses
    }

    pub(crate) fn check(&self) -> Result<(), EmulateError> {
        check_positive(&[("board.bus_hz", self.bus_hz), ("board.timeout_s", self.timeout_s)])?;
        if self.parts.len() > MOST_TAXELS {
            let problem = format!("are {}, expected at most {MOST_TAXELS}", self.parts.len());
            return Err(EmulateError::setting("board.parts", problem));
        }
        for (index, part) in self.parts.iter().enumerate() {
            part.check(&format!("board.parts[{index}]"))?;
        }
        check_not_negative(&[("board.noise_pa", self.noise_pa.unwrap_or_default())])?;
        let barometer = &self.barometer;
        check_positive(&[
            ("board.barometer.counts_per_pa", barometer.counts_per_pa),
            ("board.barometer.conversion_s", barometer.conversion_s),
        ])?;
        check_not_negative(&[
            ("board.barometer.noise_pa", barometer.noise_pa),
            (
                "board.barometer.conversion_s_per_1024",
                barometer.conversion_s_per_1024,
            ),
            ("board.barometer.conversion_spread", barometer.conversion_spread),
        ])
    }
}
