//! Placement of parts: barometers where the description has the taxels, all other parts on the
//! bottom face, each as close as there is room to the pads it connects to.

use glam::DVec2;
use twintac_sensor::Sensor;

use crate::BoardError;
use crate::active::CONNECTOR_REACH_MM;
use crate::circuit::{Circuit, GND, SUPPLY, SwitchParts, TaxelParts};
use crate::land::{Placement, Side};
use crate::outline::Outline;
use crate::rules::{EDGE_CLEARANCE_MM, SCREW_FREE_MM};
use crate::shapes::Area;

/// Step of the positions that are tried, mm.
const STEP_MM: f64 = 0.25;
/// Free distance between the courtyards of parts, mm, for tracks and vias.
const AISLE_MM: f64 = 0.4;
/// Free distance around a switch, where all tracks meet, mm.
const SWITCH_AISLE_MM: f64 = 0.7;
/// Distance between the middles of small parts in a row, mm.
const ROW_MM: f64 = 1.5;
/// Largest distance of a part from its wanted position, mm.
const FAR_MM: f64 = 12.0;

/// Free distance around a jumper, whose ends have names beside them, mm.
const JUMPER_AISLE_MM: f64 = 1.2;
/// Free distance beyond the connector's pads, for their names, mm.
const PIN_NAMES_MM: f64 = 3.0;
/// Cost of a part under a chip, mm of wish: vias of the chip then have to go around the part.
const UNDER_CHIP_MM: f64 = 4.0;

/// Distance of parts from the edge of the rectangle, mm: the walls of a lid are there.
const RIM_MM: f64 = 1.0;

/// A wish: a pad, the point that it should be near to, and a weight.
type Wish = (&'static str, DVec2, f64);

/// Places the chips on the top face, at their taxels.
pub(crate) fn on_top(sensor: &Sensor, circuit: &Circuit) -> Result<Vec<Placement>, BoardError> {
    let mut placed: Vec<(Placement, Area)> = Vec::new();
    for (index, taxel) in sensor.taxels.iter().enumerate() {
        if taxel.position_mm.z.abs() > 1e-6 {
            return Err(BoardError::PortNotInPlane {
                taxel: taxel.name.clone(),
                z_mm: taxel.position_mm.z,
            });
        }
        let place = Placement {
            at: taxel.position_mm.truncate(),
            quarters: 0,
            side: Side::Top,
        };
        let land = &circuit.parts[circuit.taxels[index].chip].device.land;
        let area = place.area(&land.courtyard);
        if let Some(other) = placed.iter().position(|(_, other)| other.meets(&area)) {
            let apart = (place.at - placed[other].0.at).abs();
            return Err(BoardError::ChipsCollide {
                taxel: taxel.name.clone(),
                other: sensor.taxels[other].name.clone(),
                apart_mm: format!("{:.2} by {:.2}", apart.x, apart.y),
                need_mm: land.courtyard.size().max_element(),
            });
        }
        placed.push((place, area));
    }
    Ok(placed.into_iter().map(|(place, _)| place).collect())
}

/// Places all parts. The placements of the chips are given.
pub(crate) fn place(
    circuit: &Circuit,
    chips: &[Placement],
    outline: &Outline,
) -> Result<Vec<Placement>, BoardError> {
    let mut placer = Placer {
        circuit,
        outline,
        places: vec![None; circuit.parts.len()],
        taken: outline
            .holes
            .iter()
            .map(|hole| Area::about(*hole, DVec2::splat(SCREW_FREE_MM)))
            .collect(),
        over: circuit
            .taxels
            .iter()
            .zip(chips)
            .map(|(taxel, place)| place.area(&circuit.parts[taxel.chip].device.land.courtyard))
            .collect(),
    };
    for (taxel, place) in circuit.taxels.iter().zip(chips) {
        placer.places[taxel.chip] = Some(*place);
    }
    placer.connector()?;
    for switch in &circuit.switches {
        placer.switch(switch)?;
    }
    let [trunk_data, trunk_clock, large, small] = circuit.at_connector;
    for (part, net) in [
        (large, SUPPLY),
        (small, SUPPLY),
        (trunk_data, "SDA"),
        (trunk_clock, "SCL"),
    ] {
        placer.beside(part, circuit.connector, net)?;
    }
    for switch in &circuit.switches {
        placer.beside(switch.capacitor, switch.switch, SUPPLY)?;
        for jumper in switch.jumpers {
            let net = circuit.parts[jumper].net_of_pad("2").unwrap_or_default();
            placer.beside(jumper, switch.switch, net)?;
        }
    }
    for taxel in &circuit.taxels {
        placer.row(taxel)?;
    }
    let first = circuit.switches.first().map(|switch| switch.switch);
    for part in circuit.reset {
        placer.beside(part, first.unwrap_or(circuit.connector), "RESET")?;
    }
    Ok(placer.places.into_iter().flatten().collect())
}

struct Placer<'a> {
    circuit: &'a Circuit,
    outline: &'a Outline,
    places: Vec<Option<Placement>>,
    /// Occupied areas on the bottom face.
    taken: Vec<Area>,
    /// Areas that chips cover on the top face.
    over: Vec<Area>,
}

impl Placer<'_> {
    fn is_free(&self, area: &Area) -> bool {
        self.outline.middle.grown(-RIM_MM).holds(area) && !self.taken.iter().any(|taken| taken.meets(area))
    }

    fn no_room(&self, part: usize) -> BoardError {
        let size = self.outline.middle.size();
        BoardError::NoRoom {
            part: format!(
                "{} ({})",
                self.circuit.parts[part].reference, self.circuit.parts[part].value
            ),
            size_mm: format!("{:.1} by {:.1}", size.x, size.y),
        }
    }

    fn put(&mut self, part: usize, place: Placement, aisle_mm: f64) {
        let room = &self.circuit.parts[part].device.land.courtyard;
        self.taken.push(place.area(room).grown(aisle_mm));
        self.places[part] = Some(place);
    }

    /// Positions of the pads of a net, on a placed part.
    fn pads_of(&self, part: usize, net: &str) -> Vec<DVec2> {
        let Some(place) = self.places[part] else {
            return Vec::new();
        };
        let part = &self.circuit.parts[part];
        let pads = part.device.land.pads.iter();
        pads.filter(|pad| part.net_of_pad(pad.number) == Some(net))
            .map(|pad| place.on_board(pad.at))
            .collect()
    }

    fn bottom(at: DVec2, quarters: u8) -> Placement {
        Placement {
            at,
            quarters,
            side: Side::Bottom,
        }
    }

    /// Places the connector at the edge of smallest y, with its opening outwards, in the middle of
    /// that edge.
    fn connector(&mut self) -> Result<(), BoardError> {
        let part = self.circuit.connector;
        let middle = &self.outline.middle;
        let at = DVec2::new(
            middle.center().x,
            middle.min.y + EDGE_CLEARANCE_MM + CONNECTOR_REACH_MM,
        );
        let place = Self::bottom(at, 2);
        let room = place.area(&self.circuit.parts[part].device.land.courtyard);
        let fits = room.min.x >= middle.min.x + EDGE_CLEARANCE_MM && room.max.y <= middle.max.y;
        if !fits {
            return Err(self.no_room(part));
        }
        self.put(part, place, AISLE_MM);
        let names = Area {
            min: DVec2::new(room.min.x, room.max.y),
            max: DVec2::new(room.max.x, room.max.y + PIN_NAMES_MM),
        };
        self.taken.push(names);
        Ok(())
    }

    /// Places a switch in the middle of its taxels, turned so that its channels are near them.
    fn switch(&mut self, switch: &SwitchParts) -> Result<(), BoardError> {
        let chips = switch.taxels.iter().map(|taxel| self.circuit.taxels[*taxel].chip);
        let at: Vec<DVec2> = chips
            .clone()
            .filter_map(|chip| Some(self.places[chip]?.at))
            .collect();
        let middle = at.iter().sum::<DVec2>() / at.len().max(1) as f64;
        let part = &self.circuit.parts[switch.switch];
        let wishes: Vec<Wish> = part
            .device
            .land
            .pads
            .iter()
            .flat_map(|pad| {
                let net = part.net_of_pad(pad.number).unwrap_or_default();
                let mut ends: Vec<DVec2> = chips.clone().flat_map(|chip| self.pads_of(chip, net)).collect();
                if net == "SDA" || net == "SCL" {
                    ends = self.pads_of(self.circuit.connector, net);
                }
                if net == SUPPLY || net == GND {
                    ends.clear();
                }
                ends.into_iter().map(move |end| (pad.number, end, 1.0))
            })
            .collect();
        self.settle(switch.switch, &wishes, middle, SWITCH_AISLE_MM)
    }

    /// Places a part as near as possible to the pads of a net of another part.
    fn beside(&mut self, part: usize, other: usize, net: &str) -> Result<(), BoardError> {
        let ends = self.pads_of(other, net);
        let pads = &self.circuit.parts[part].device.land.pads;
        let wishes: Vec<Wish> = pads
            .iter()
            .flat_map(|pad| {
                let is_of_net = self.circuit.parts[part].net_of_pad(pad.number) == Some(net);
                let matters = if is_of_net { 1.0 } else { 0.15 };
                ends.iter().map(move |end| (pad.number, *end, matters))
            })
            .collect();
        let middle = ends.iter().sum::<DVec2>() / ends.len().max(1) as f64;
        let is_jumper = self.circuit.parts[part].device.prefix == "JP";
        let aisle_mm = if is_jumper { JUMPER_AISLE_MM } else { AISLE_MM };
        self.settle(part, &wishes, middle, aisle_mm)
    }

    /// Takes the free position with the lowest cost.
    fn settle(
        &mut self,
        part: usize,
        wishes: &[Wish],
        about: DVec2,
        aisle_mm: f64,
    ) -> Result<(), BoardError> {
        let land = &self.circuit.parts[part].device.land;
        let mut best: Option<(f64, Placement)> = None;
        for at in places_about(about) {
            for quarters in 0..4 {
                let place = Self::bottom(at, quarters);
                let wished = wishes.iter();
                let far: f64 = wished
                    .map(|(number, end, matters)| matters * nearest(land, place, number, *end))
                    .sum();
                let cost = far + self.under_chips(part, &place);
                let is_better = best.as_ref().is_none_or(|(least, _)| cost < least - 1e-9);
                if is_better && self.is_free(&place.area(&land.courtyard)) {
                    best = Some((cost, place));
                }
            }
        }
        let (_, place) = best.ok_or_else(|| self.no_room(part))?;
        self.put(part, place, aisle_mm);
        Ok(())
    }

    /// Places a chip's capacitor and its two pull-ups in a row.
    fn row(&mut self, taxel: &TaxelParts) -> Result<(), BoardError> {
        let Some(chip) = self.places[taxel.chip] else {
            return Err(self.no_room(taxel.chip));
        };
        let parts = [taxel.capacitor, taxel.pull_ups[0], taxel.pull_ups[1]];
        let wishes = parts.map(|part| self.wishes_at_chip(part, taxel.chip));
        let mut best: Option<(f64, [Placement; 3])> = None;
        for at in places_about(chip.at) {
            for (is_along_x, order) in orders() {
                let mut places = [Self::bottom(at, 0); 3];
                let mut cost = 0.0;
                for (index, part) in parts.into_iter().enumerate() {
                    let step = ROW_MM * order[index];
                    let aside = if is_along_x {
                        DVec2::new(step, 0.0)
                    } else {
                        DVec2::new(0.0, step)
                    };
                    let (far, place) =
                        self.better_turn(part, &wishes[index], at + aside, u8::from(is_along_x));
                    (cost, places[index]) = (cost + far, place);
                }
                if best.as_ref().is_some_and(|(least, _)| cost >= least - 1e-9) {
                    continue;
                }
                let are_free = parts.iter().zip(&places).all(|(part, place)| {
                    self.is_free(&place.area(&self.circuit.parts[*part].device.land.courtyard))
                });
                if are_free {
                    best = Some((cost, places));
                }
            }
        }
        let (_, places) = best.ok_or_else(|| self.no_room(taxel.capacitor))?;
        for (part, place) in parts.into_iter().zip(places) {
            self.put(part, place, AISLE_MM);
        }
        Ok(())
    }

    /// The better of two opposite orientations of a small part, with its cost.
    fn better_turn(&self, part: usize, wishes: &[RowWish], at: DVec2, quarters: u8) -> (f64, Placement) {
        let cost = |place: Placement| {
            let far = wishes.iter().map(|wish| {
                let pad = place.on_board(wish.pad);
                let ends = wish.ends.iter().map(|end| pad.distance(*end));
                wish.matters * ends.fold(FAR_MM, f64::min)
            });
            far.sum::<f64>()
        };
        let (one, two) = (Self::bottom(at, quarters), Self::bottom(at, quarters + 2));
        let (cost_of_one, cost_of_two) = (cost(one), cost(two));
        let (far, place) = if cost_of_one <= cost_of_two {
            (cost_of_one, one)
        } else {
            (cost_of_two, two)
        };
        (far + self.under_chips(part, &place), place)
    }

    /// Cost of a position under chips. A switch costs nothing, because it is too large to fit
    /// elsewhere.
    fn under_chips(&self, part: usize, place: &Placement) -> f64 {
        if self.circuit.parts[part].device.prefix == "U" {
            return 0.0;
        }
        let area = place.area(&self.circuit.parts[part].device.land.courtyard);
        let under = self.over.iter().filter(|chip| chip.meets(&area)).count();
        UNDER_CHIP_MM * under as f64
    }

    /// The wishes for the pads of a small part: near the chip's pads of the same net. The
    /// capacitor's have the largest weights.
    fn wishes_at_chip(&self, part: usize, chip: usize) -> Vec<RowWish> {
        let small = &self.circuit.parts[part];
        let pads = small.device.land.pads.iter();
        pads.map(|pad| {
            let net = small.net_of_pad(pad.number).unwrap_or_default();
            RowWish {
                pad: pad.at,
                ends: self.pads_of(chip, net),
                matters: match (small.device.prefix, net) {
                    ("C", SUPPLY) => 2.0,
                    ("C", _) => 1.5,
                    (_, SUPPLY) => 0.3,
                    _ => 1.0,
                },
            }
        })
        .collect()
    }
}

/// The wanted position of a pad of a small part.
struct RowWish {
    pad: DVec2,
    ends: Vec<DVec2>,
    matters: f64,
}

/// Rows along x and along y, in all orders.
fn orders() -> impl Iterator<Item = (bool, [f64; 3])> {
    [true, false]
        .into_iter()
        .flat_map(|along| ORDERS.map(|order| (along, order)))
}

/// The orders of three parts in a row.
const ORDERS: [[f64; 3]; 6] = [
    [0.0, -1.0, 1.0],
    [0.0, 1.0, -1.0],
    [-1.0, 0.0, 1.0],
    [-1.0, 1.0, 0.0],
    [1.0, 0.0, -1.0],
    [1.0, -1.0, 0.0],
];

/// Distance from the nearest pad with this number to a point.
fn nearest(land: &crate::land::Land, place: Placement, number: &str, end: DVec2) -> f64 {
    let pads = land.pads.iter().filter(|pad| pad.number == number);
    pads.map(|pad| place.on_board(pad.at).distance(end))
        .fold(FAR_MM, f64::min)
}

/// The positions that are tried, row by row.
fn places_about(middle: DVec2) -> impl Iterator<Item = DVec2> {
    let steps = (FAR_MM / STEP_MM) as i32;
    let middle = (middle / STEP_MM).round() * STEP_MM;
    (-steps..=steps).flat_map(move |row| {
        (-steps..=steps).map(move |column| middle + STEP_MM * DVec2::new(f64::from(column), f64::from(row)))
    })
}
