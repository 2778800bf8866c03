//! A board: circuit, placement, tracks, ground pour and texts.

use std::collections::BTreeMap;

use glam::DVec2;
use twintac_sensor::Sensor;

use crate::active::ADDRESS;
use crate::barometer::Barometer;
use crate::circuit::{Circuit, GND, SUPPLY};
use crate::design::Design;
use crate::kicad;
use crate::label::{Wanted, place};
use crate::land::{Placement, Side};
use crate::outline::Outline;
use crate::pour::pour;
use crate::route::{PadCopper, route};
use crate::shapes::Shape;
use crate::{BoardError, Geometry, place as placing};

/// The circuit board of a sensor, placed and routed.
#[derive(Clone, Debug)]
pub struct Board {
    design: Design,
    sensor: Sensor,
    chip: Barometer,
}

/// Parts of one kind to buy.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct PartLine {
    /// Their references, such as `C1`.
    pub references: Vec<String>,
    /// The value on the schematic.
    pub value: String,
    /// The name of the part in the list of parts with numbers and prices.
    pub part: String,
    /// The land pattern.
    pub footprint: String,
}

/// The pins that a taxel's chip is connected to, for comparison with a netlist.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct TaxelWiring {
    /// The taxel's name.
    pub taxel: String,
    /// Reference of its chip.
    pub chip: String,
    /// Pins of the chip: data and clock.
    pub chip_pins: [String; 2],
    /// Reference of its switch.
    pub switch: String,
    /// Pins of the switch: data and clock of its channel.
    pub switch_pins: [String; 2],
}

impl Board {
    /// Designs the board of a sensor. All taxels have the chip named `chip`. Takes seconds.
    ///
    /// # Errors
    ///
    /// An unknown chip; a taxel without a channel of a switch, or with its port off the plane z =
    /// 0; parts that collide, or for which there is no room; a net that cannot be routed.
    pub fn design(variant: &str, sensor: &Sensor, chip: &str) -> Result<Self, BoardError> {
        let chip = Barometer::named(chip)?;
        let circuit = Circuit::new(sensor, &chip)?;
        let on_top = placing::on_top(sensor, &circuit)?;
        let rooms: Vec<_> = on_top
            .iter()
            .map(|place| place.area(&chip.device.land.courtyard))
            .collect();
        let bounds = sensor.gel.solid.bounds_mm(&sensor.surfaces);
        let outline = Outline::new(bounds, sensor.shell.as_ref(), &rooms);
        let places = placing::place(&circuit, &on_top, &outline)?;
        let nets = circuit.nets();
        let number = |net: &str| nets.iter().position(|other| other == net);
        let pads = pads(&circuit, &places, &number);
        let is_power = |net: usize| nets[net] == GND || nets[net] == SUPPLY;
        let routed = route(&outline, &pads, nets.len(), &is_power).map_err(|failure| {
            let at = |point: DVec2| format!("({:.1}, {:.1}) mm", point.x, point.y);
            let across: Vec<&str> = failure.across.iter().map(|net| nets[*net].as_str()).collect();
            BoardError::NoRoute {
                net: nets[failure.net].clone(),
                from: at(failure.from),
                to: at(failure.to),
                across: if across.is_empty() {
                    String::new()
                } else {
                    format!(" without crossing {}", across.join(", "))
                },
            }
        })?;
        let pour = pour(&outline, &pads, &routed, number(GND).unwrap_or_default());
        let mut all = routed.clone();
        all.vias.extend(&pour.vias);
        let labels = place(
            texts(variant, sensor, &chip, &circuit, &places, &outline),
            &circuit,
            &places,
            &outline,
            &all,
        );
        Ok(Self {
            design: Design {
                variant: variant.to_owned(),
                circuit,
                places,
                outline,
                nets,
                routed,
                pour,
                labels,
            },
            sensor: sensor.clone(),
            chip,
        })
    }

    /// The files of the KiCad 9 project, by their paths in its folder. The same board gives the
    /// same bytes.
    #[must_use]
    pub fn files(&self) -> BTreeMap<String, String> {
        kicad::project(&self.design)
    }

    /// The geometry that the mechanics are made from. `sensor_sha256` is the SHA-256 of the
    /// description's file.
    #[must_use]
    pub fn geometry(&self, sensor_sha256: &str) -> Geometry {
        Geometry::new(&self.design, &self.sensor, &self.chip, sensor_sha256)
    }

    /// Whether the land pattern of the barometers comes from a data sheet.
    #[must_use]
    pub fn is_footprint_confirmed(&self) -> bool {
        self.chip.is_confirmed
    }

    /// The parts to buy, in the order of their references.
    #[must_use]
    pub fn parts(&self) -> Vec<PartLine> {
        let mut lines: Vec<PartLine> = Vec::new();
        for part in &self.design.circuit.parts {
            let Some(bought) = part.device.bought else {
                continue;
            };
            match lines.iter_mut().find(|line| line.part == bought) {
                Some(line) => line.references.push(part.reference.clone()),
                None => lines.push(PartLine {
                    references: vec![part.reference.clone()],
                    value: part.value.clone(),
                    part: bought.to_owned(),
                    footprint: part.device.land.name.to_owned(),
                }),
            }
        }
        lines
    }

    /// The wiring of the taxels that the description asks for, by pins of the schematic.
    #[must_use]
    pub fn wiring(&self) -> Vec<TaxelWiring> {
        let number = |part: usize, name: &str| {
            let device = &self.design.circuit.parts[part].device;
            let pin = device.pin_named(name).map(|pin| device.pins[pin].number);
            pin.unwrap_or_default().to_owned()
        };
        let mut wirings: Vec<(usize, TaxelWiring)> = Vec::new();
        for switch in &self.design.circuit.switches {
            for &index in &switch.taxels {
                let taxel = &self.sensor.taxels[index];
                let chip = self.design.circuit.taxels[index].chip;
                let channel = taxel.channel.unwrap_or_default();
                let wiring = TaxelWiring {
                    taxel: taxel.name.clone(),
                    chip: self.design.circuit.parts[chip].reference.clone(),
                    chip_pins: [number(chip, "SDA"), number(chip, "SCL")],
                    switch: self.design.circuit.parts[switch.switch].reference.clone(),
                    switch_pins: ["SD", "SC"].map(|pin| number(switch.switch, &format!("{pin}{channel}"))),
                };
                wirings.push((index, wiring));
            }
        }
        wirings.sort_by_key(|(index, _)| *index);
        wirings.into_iter().map(|(_, wiring)| wiring).collect()
    }
}

/// All pads, and the copper bridges of jumpers.
fn pads(circuit: &Circuit, places: &[Placement], number: &dyn Fn(&str) -> Option<usize>) -> Vec<PadCopper> {
    let mut pads = Vec::new();
    for (part, place) in circuit.parts.iter().zip(places) {
        let land = &part.device.land;
        for pad in &land.pads {
            pads.push(PadCopper {
                shape: place.pad(pad),
                side: place.side,
                net: part.net_of_pad(pad.number).and_then(number),
                is_pin: true,
            });
        }
        if let Some((_, copper)) = &land.bridge {
            let area = place.area(copper);
            pads.push(PadCopper {
                shape: Shape::Rect {
                    center: area.center(),
                    half: 0.5 * area.size(),
                },
                side: place.side,
                net: None,
                is_pin: false,
            });
        }
    }
    pads
}

/// The texts of the silk screen.
fn texts(
    variant: &str,
    sensor: &Sensor,
    chip: &Barometer,
    circuit: &Circuit,
    places: &[Placement],
    outline: &Outline,
) -> Vec<Wanted> {
    let mut wanted = Vec::new();
    let mut want = |text: &str, near: DVec2, side: Side, height_mm: f64, is_upright: bool| {
        wanted.push(Wanted {
            text: text.to_owned(),
            near,
            side,
            height_mm,
            is_upright,
            is_fixed: is_upright,
        });
    };
    let connector = &circuit.parts[circuit.connector];
    let place = places[circuit.connector];
    for (number, text) in [("1", "GND"), ("2", "3V3"), ("3", "SDA"), ("4", "SCL")] {
        let pad = connector.device.land.pads.iter().find(|pad| pad.number == number);
        if let Some(pad) = pad {
            let beyond = pad.at - DVec2::new(0.0, 2.4);
            want(text, place.on_board(beyond), Side::Bottom, 0.8, true);
        }
    }
    for switch in &circuit.switches {
        want(
            &circuit.parts[switch.switch].reference,
            places[switch.switch].at + DVec2::new(0.0, 5.0),
            Side::Bottom,
            0.8,
            false,
        );
        for (bit, jumper) in switch.jumpers.into_iter().enumerate() {
            // "1" marks the end that is connected to the supply.
            let land = &circuit.parts[jumper].device.land;
            want(ADDRESS[bit], places[jumper].at, Side::Bottom, 0.8, false);
            want(
                "1",
                places[jumper].on_board(land.pads[2].at),
                Side::Bottom,
                0.8,
                false,
            );
        }
    }
    want("RESET", places[circuit.reset[1]].at, Side::Bottom, 0.8, false);
    for (taxel, parts) in sensor.taxels.iter().zip(&circuit.taxels) {
        let at = places[parts.chip].at;
        want(&taxel.name, at + DVec2::new(0.0, 2.6), Side::Top, 0.8, false);
    }
    let middle = outline.middle.center();
    let upper = DVec2::new(middle.x, outline.middle.max.y - 1.2);
    let title = format!("TwinTac {variant}");
    want(&title, upper, Side::Bottom, 1.0, false);
    want(
        &title,
        DVec2::new(middle.x, outline.middle.min.y + 1.0),
        Side::Top,
        1.0,
        false,
    );
    if !chip.is_confirmed {
        let warning = format!("{}: TO BE CONFIRMED", chip.name);
        want(&warning, upper, Side::Top, 1.0, false);
        want(&warning, upper - DVec2::new(0.0, 1.5), Side::Bottom, 0.8, false);
    }
    wanted
}
