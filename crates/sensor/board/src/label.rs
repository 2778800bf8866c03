//! Texts of the silk screen, placed where they cover no pads, no holes and no other texts.

use glam::DVec2;

use crate::circuit::Circuit;
use crate::land::{Placement, Side};
use crate::outline::Outline;
use crate::route::Routed;
use crate::rules::{EDGE_CLEARANCE_MM, SCREW_FREE_MM, VIA_MM};
use crate::shapes::Area;

/// Width of a character divided by its height. The widest characters of the stroke font are a
/// little narrower.
const WIDTH: f64 = 0.98;
/// Free distance around texts, mm.
const FREE_MM: f64 = 0.12;
/// Step of the positions that are tried, and largest distance from the wanted position, mm.
const STEP_MM: f64 = 0.25;
const FAR_MM: f64 = 14.0;

/// A text on a face.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Label {
    pub(crate) text: String,
    pub(crate) at: DVec2,
    pub(crate) side: Side,
    pub(crate) height_mm: f64,
    /// Whether it is turned by 90°.
    pub(crate) is_upright: bool,
}

impl Label {
    fn area(&self) -> Area {
        let along = 0.5 * WIDTH * self.height_mm * self.text.chars().count() as f64;
        let across = 0.65 * self.height_mm;
        let half = if self.is_upright {
            DVec2::new(across, along)
        } else {
            DVec2::new(along, across)
        };
        Area::about(self.at, half)
    }
}

/// A text that needs a position.
pub(crate) struct Wanted {
    pub(crate) text: String,
    pub(crate) near: DVec2,
    pub(crate) side: Side,
    pub(crate) height_mm: f64,
    pub(crate) is_upright: bool,
    /// Whether its position is fixed, as for the name of a pin.
    pub(crate) is_fixed: bool,
}

/// Places texts in their order. A text without room is left out.
pub(crate) fn place(
    wanted: Vec<Wanted>,
    circuit: &Circuit,
    places: &[Placement],
    outline: &Outline,
    routed: &Routed,
) -> Vec<Label> {
    let mut taken = Taken {
        solid: Vec::new(),
        vias: Vec::new(),
    };
    for (part, place) in circuit.parts.iter().zip(places) {
        let land = &part.device.land;
        for pad in &land.pads {
            let (min, max) = place.pad(pad).bounds();
            taken.solid.push((place.side, Area { min, max }.grown(FREE_MM)));
        }
        if land.height_mm > 0.0 {
            taken.solid.push((place.side, place.area(&land.body)));
        }
        for [from, to] in &land.silk {
            let line = Area {
                min: DVec2::from(*from).min((*to).into()),
                max: DVec2::from(*from).max((*to).into()),
            };
            taken.solid.push((place.side, place.area(&line).grown(0.15)));
        }
    }
    for hole in outline.holes {
        let area = Area::about(hole, DVec2::splat(SCREW_FREE_MM));
        taken.solid.extend([(Side::Top, area), (Side::Bottom, area)]);
    }
    for via in &routed.vias {
        taken.vias.push(Area::about(via.at, DVec2::splat(0.5 * VIA_MM)));
    }
    let mut labels = Vec::new();
    for wanted in wanted {
        if let Some(label) = taken.find(&wanted, outline) {
            // Names of pins may be as close as the pins.
            let free = if wanted.is_fixed { -FREE_MM } else { FREE_MM };
            taken.solid.push((label.side, label.area().grown(free)));
            labels.push(label);
        }
    }
    labels
}

struct Taken {
    solid: Vec<(Side, Area)>,
    /// Texts may cover vias, which have solder mask on them, at a cost.
    vias: Vec<Area>,
}

impl Taken {
    fn find(&self, wanted: &Wanted, outline: &Outline) -> Option<Label> {
        let steps = if wanted.is_fixed {
            0
        } else {
            (FAR_MM / STEP_MM) as i32
        };
        let mut best: Option<(f64, Label)> = None;
        for (row, column) in
            (-steps..=steps).flat_map(|row| (-steps..=steps).map(move |column| (row, column)))
        {
            let aside = STEP_MM * DVec2::new(f64::from(column), f64::from(row));
            let label = Label {
                text: wanted.text.clone(),
                at: wanted.near + aside,
                side: wanted.side,
                height_mm: wanted.height_mm,
                is_upright: wanted.is_upright,
            };
            let area = label.area();
            let on_vias = self.vias.iter().filter(|via| via.meets(&area)).count();
            let cost = aside.length() + 1.2 * on_vias as f64;
            if best.as_ref().is_some_and(|(least, _)| cost >= *least) || !self.is_free(&label, outline) {
                continue;
            }
            best = Some((cost, label));
        }
        best.map(|(_, label)| label)
    }

    fn is_free(&self, label: &Label, outline: &Outline) -> bool {
        let area = label.area();
        let corners = [
            area.min,
            area.max,
            DVec2::new(area.min.x, area.max.y),
            DVec2::new(area.max.x, area.min.y),
        ];
        let is_on_board = corners
            .iter()
            .all(|corner| outline.inside_mm(*corner) > EDGE_CLEARANCE_MM);
        let mut on_side = self.solid.iter().filter(|(side, _)| *side == label.side);
        is_on_board && !on_side.any(|(_, taken)| taken.meets(&area))
    }
}
