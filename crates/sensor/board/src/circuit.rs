//! The circuit: parts and nets, from a sensor's taxels.

use std::collections::BTreeMap;

use phystac::SwitchAddress;
use twintac_sensor::{Sensor, Taxel};

use crate::active::{ADDRESS, CLOCK, DATA, connector, switch};
use crate::barometer::Barometer;
use crate::device::Device;
use crate::passive::{address_jumper, capacitor_10u, capacitor_100n, resistor_10k, test_pad};
use crate::{BoardError, active};

pub(crate) const GND: &str = "GND";
pub(crate) const SUPPLY: &str = "+3V3";

/// A part of the board.
#[derive(Clone, Debug)]
pub(crate) struct Part {
    pub(crate) reference: String,
    pub(crate) value: String,
    pub(crate) device: Device,
    /// The net of each pin, in the order of the device's pins. `None` for an unconnected pin.
    pub(crate) nets: Vec<Option<String>>,
}

impl Part {
    /// The net of a pad. `None` for an unconnected pad.
    pub(crate) fn net_of_pad(&self, number: &str) -> Option<&str> {
        let index = self.device.pins.iter().position(|pin| pin.number == number)?;
        self.nets[index].as_deref()
    }
}

/// Indices of the parts of one taxel.
#[derive(Clone, Debug)]
pub(crate) struct TaxelParts {
    pub(crate) chip: usize,
    pub(crate) capacitor: usize,
    pub(crate) pull_ups: [usize; 2],
}

/// Indices of a switch and of the parts that belong to it.
#[derive(Clone, Debug)]
pub(crate) struct SwitchParts {
    pub(crate) switch: usize,
    pub(crate) capacitor: usize,
    pub(crate) jumpers: [usize; 3],
    /// Indices of the taxels behind it.
    pub(crate) taxels: Vec<usize>,
}

/// All parts and nets.
#[derive(Clone, Debug)]
pub(crate) struct Circuit {
    pub(crate) parts: Vec<Part>,
    pub(crate) taxels: Vec<TaxelParts>,
    pub(crate) switches: Vec<SwitchParts>,
    pub(crate) connector: usize,
    /// Indices of the parts at the connector: two trunk pull-ups, 10 uF and 100 nF.
    pub(crate) at_connector: [usize; 4],
    /// Indices of the reset line's pull-up and test pad.
    pub(crate) reset: [usize; 2],
}

impl Circuit {
    /// The circuit of a sensor whose taxels are all chips of one kind.
    pub(crate) fn new(sensor: &Sensor, chip: &Barometer) -> Result<Self, BoardError> {
        let behind = channels(sensor)?;
        let mut maker = Maker::default();
        let taxels = sensor.taxels.iter();
        let chips: Vec<usize> = taxels.clone().map(|taxel| maker.chip(chip, taxel)).collect();
        let switches: Vec<(u8, usize)> = behind
            .keys()
            .map(|(address, _)| *address)
            .collect::<std::collections::BTreeSet<_>>()
            .into_iter()
            .map(|address| (address, maker.switch(sensor, &behind, address)))
            .collect();
        let at_chips: Vec<usize> = chips.iter().map(|_| maker.capacitor(false)).collect();
        let connector = maker.connector();
        let trunk = [maker.pull_up("SDA"), maker.pull_up("SCL")];
        let at_supply = [maker.capacitor(true), maker.capacitor(false)];
        let reset = [maker.pull_up("RESET"), maker.test_pad("RESET")];
        let taxels = taxels.enumerate().map(|(index, taxel)| TaxelParts {
            chip: chips[index],
            capacitor: at_chips[index],
            pull_ups: [data_net(taxel), clock_net(taxel)].map(|net| maker.pull_up(&net)),
        });
        let taxels = taxels.collect();
        let switches = switches.into_iter().map(|(address, switch)| SwitchParts {
            switch,
            capacitor: maker.capacitor(false),
            jumpers: [0, 1, 2].map(|bit| maker.jumper(switch, bit, address >> bit & 1 == 1)),
            taxels: behind
                .iter()
                .filter(|((of, _), _)| *of == address)
                .map(|(_, &index)| index)
                .collect(),
        });
        let switches = switches.collect();
        Ok(Self {
            taxels,
            switches,
            connector,
            at_connector: [trunk[0], trunk[1], at_supply[0], at_supply[1]],
            reset,
            parts: maker.parts,
        })
    }

    /// All nets in the order of their names, with ground and supply first.
    pub(crate) fn nets(&self) -> Vec<String> {
        let parts = self.parts.iter();
        let mut nets: Vec<String> = parts
            .flat_map(|part| part.nets.iter().flatten().cloned())
            .collect();
        nets.sort_by_key(|net| (net != GND, net != SUPPLY, net.clone()));
        nets.dedup();
        nets
    }
}

/// The taxel of each channel of each switch.
fn channels(sensor: &Sensor) -> Result<BTreeMap<(u8, u8), usize>, BoardError> {
    let mut behind = BTreeMap::new();
    for (index, taxel) in sensor.taxels.iter().enumerate() {
        let no_channel = || BoardError::NoChannel {
            taxel: taxel.name.clone(),
        };
        let channel = taxel.channel.ok_or_else(no_channel)?;
        let address = taxel
            .switch
            .map_or(Some(SwitchAddress::default()), SwitchAddress::new);
        let address = address.ok_or_else(no_channel)?;
        if let Some(other) = behind.insert((address.get(), channel), index) {
            return Err(BoardError::SameChannel {
                taxel: taxel.name.clone(),
                other: sensor.taxels[other].name.clone(),
                channel,
                switch: address.get(),
            });
        }
    }
    Ok(behind)
}

fn data_net(taxel: &Taxel) -> String {
    format!("SDA_{}", taxel.name)
}

fn clock_net(taxel: &Taxel) -> String {
    format!("SCL_{}", taxel.name)
}

/// Creates parts and numbers their references.
#[derive(Default)]
struct Maker {
    parts: Vec<Part>,
    counts: BTreeMap<&'static str, usize>,
}

impl Maker {
    /// Adds a part. `net` gives the net of each pin by the pin's name. Returns the part's index.
    fn part(&mut self, device: Device, value: &str, net: impl Fn(&str) -> Option<String>) -> usize {
        let count = self.counts.entry(device.prefix).or_default();
        *count += 1;
        self.parts.push(Part {
            reference: format!("{}{count}", device.prefix),
            value: value.to_owned(),
            nets: device.pins.iter().map(|pin| net(pin.name)).collect(),
            device,
        });
        self.parts.len() - 1
    }

    fn chip(&mut self, chip: &Barometer, taxel: &Taxel) -> usize {
        self.part(chip.device.clone(), chip.name, |pin| match pin {
            "VDD" => Some(SUPPLY.to_owned()),
            "GND" => Some(GND.to_owned()),
            "SDA" => Some(data_net(taxel)),
            "SCL" => Some(clock_net(taxel)),
            _ => None,
        })
    }

    fn switch(&mut self, sensor: &Sensor, behind: &BTreeMap<(u8, u8), usize>, address: u8) -> usize {
        let reference = format!("U{}", self.counts.get("U").copied().unwrap_or_default() + 1);
        let of_channel = |pin: &str, names: &[&str], net: fn(&Taxel) -> String| {
            let channel = names.iter().position(|name| *name == pin)?;
            let index = behind.get(&(address, u8::try_from(channel).ok()?))?;
            Some(net(&sensor.taxels[*index]))
        };
        self.part(switch(), "TCA9548APWR", |pin| match pin {
            "VCC" => Some(SUPPLY.to_owned()),
            "GND" => Some(GND.to_owned()),
            "SDA" | "SCL" => Some(pin.to_owned()),
            "~{RESET}" => Some("RESET".to_owned()),
            pin if ADDRESS.contains(&pin) => Some(format!("{pin}_{reference}")),
            pin => of_channel(pin, &DATA, data_net).or_else(|| of_channel(pin, &CLOCK, clock_net)),
        })
    }

    fn connector(&mut self) -> usize {
        self.part(connector(), "Qwiic", |pin| {
            let net = match pin {
                "3V3" => SUPPLY,
                "SDA" | "SCL" => pin,
                _ => GND,
            };
            Some(net.to_owned())
        })
    }

    fn capacitor(&mut self, is_large: bool) -> usize {
        let (device, value) = if is_large {
            (capacitor_10u(), "10u")
        } else {
            (capacitor_100n(), "100n")
        };
        self.part(device, value, |pin| {
            Some(if pin == "1" { SUPPLY } else { GND }.to_owned())
        })
    }

    fn pull_up(&mut self, net: &str) -> usize {
        self.part(resistor_10k(), "10k", |pin| {
            Some(if pin == "1" { SUPPLY } else { net }.to_owned())
        })
    }

    fn test_pad(&mut self, net: &str) -> usize {
        self.part(test_pad(), net, |_| Some(net.to_owned()))
    }

    fn jumper(&mut self, switch: usize, bit: usize, is_high: bool) -> usize {
        let pin = self.parts[switch].device.pin_named(active::ADDRESS[bit]);
        let net = pin.and_then(|pin| self.parts[switch].nets[pin].clone());
        self.part(address_jumper(is_high), active::ADDRESS[bit], |pin| match pin {
            "GND" => Some(GND.to_owned()),
            "VCC" => Some(SUPPLY.to_owned()),
            _ => net.clone(),
        })
    }
}
