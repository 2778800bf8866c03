//! The board file.

use std::fmt::Write as _;

use glam::DVec2;

use super::footprint::{OnBoard, hole_on_board, on_board};
use super::schematic::symbol_id;
use super::text::{GENERATOR, effects, id, mm, on_sheet, pair, quoted};
use crate::circuit::{GND, Part};
use crate::contour::Polygon;
use crate::design::Design;
use crate::land::Side;
use crate::rules::{CLEARANCE_MM, POUR_WIDTH_MM, THICKNESS_MM, VIA_DRILL_MM, VIA_MM};

const LAYERS: &str = r#"  (layers
    (0 "F.Cu" signal)
    (2 "B.Cu" signal)
    (13 "F.Paste" user)
    (15 "B.Paste" user)
    (5 "F.SilkS" user "F.Silkscreen")
    (7 "B.SilkS" user "B.Silkscreen")
    (1 "F.Mask" user)
    (3 "B.Mask" user)
    (25 "Edge.Cuts" user)
    (27 "Margin" user)
    (31 "F.CrtYd" user "F.Courtyard")
    (29 "B.CrtYd" user "B.Courtyard")
    (35 "F.Fab" user)
    (33 "B.Fab" user)
  )
"#;

/// Nets by number: first those of the circuit, then those of unconnected pins, which KiCad names
/// after the pin.
struct Nets<'a> {
    board: &'a Design,
    open: Vec<String>,
}

impl<'a> Nets<'a> {
    fn new(board: &'a Design) -> Self {
        let mut open = Vec::new();
        for part in &board.circuit.parts {
            for (pin, net) in part.device.pins.iter().zip(&part.nets) {
                if net.is_none() {
                    open.push(Self::open_name(part, pin.name, pin.number));
                }
            }
        }
        Self { board, open }
    }

    fn open_name(part: &Part, pin: &str, pad: &str) -> String {
        format!("unconnected-({}-{pin}-Pad{pad})", part.reference)
    }

    fn of_pad(&self, part: &Part, pad: &str) -> String {
        let name = match part.net_of_pad(pad) {
            Some(net) => net.to_owned(),
            None => {
                let pin = part.device.pins.iter().find(|pin| pin.number == pad);
                Self::open_name(part, pin.map_or("", |pin| pin.name), pad)
            }
        };
        let mut all = self.board.nets.iter().chain(&self.open);
        let number = all.position(|net| *net == name).map_or(0, |number| number + 1);
        format!(" (net {number} {})", quoted(&name))
    }
}

/// The whole file.
pub(super) fn pcb(board: &Design) -> String {
    let nets = Nets::new(board);
    let mut text = format!(
        "(kicad_pcb\n  (version 20241229)\n  (generator \"{GENERATOR}\")\n  (generator_version \"9.0\")\n  \
        (general (thickness {}) (legacy_teardrops no))\n  (paper \"A4\")\n",
        mm(THICKNESS_MM)
    );
    let _ = writeln!(
        text,
        "  (title_block (title {}) (comment 1 \"Never built yet\"))",
        quoted(&format!("TwinTac {}", board.variant))
    );
    text += LAYERS;
    text += "  (setup (pad_to_mask_clearance 0) (allow_soldermask_bridges_in_footprints no) (tenting front back))\n";
    text += "  (net 0 \"\")\n";
    for (index, net) in board.nets.iter().chain(&nets.open).enumerate() {
        let _ = writeln!(text, "  (net {} {})", index + 1, quoted(net));
    }
    for (part, place) in board.circuit.parts.iter().zip(&board.places) {
        text += &on_board(&OnBoard {
            part,
            place: *place,
            symbol_id: symbol_id(&part.reference),
            net: &|part, pad| nets.of_pad(part, pad),
        });
    }
    for (index, hole) in board.outline.holes.iter().enumerate() {
        text += &hole_on_board(index, *hole);
    }
    text += &outline(board);
    text += &labels(board);
    text += &copper(board);
    text += &zone(board, Side::Top, &board.pour.top);
    text += &zone(board, Side::Bottom, &board.pour.bottom);
    text + "  (embedded_fonts no)\n)\n"
}

fn layer(side: Side) -> &'static str {
    if side == Side::Top { "F.Cu" } else { "B.Cu" }
}

fn outline(board: &Design) -> String {
    let corners = &board.outline.corners;
    let mut text = String::new();
    for (index, (from, to)) in corners.iter().zip(corners.iter().cycle().skip(1)).enumerate() {
        let _ = writeln!(
            text,
            "  (gr_line (start {}) (end {}) (stroke (width 0.05) (type solid)) (layer \"Edge.Cuts\") (uuid {}))",
            pair(on_sheet(*from)),
            pair(on_sheet(*to)),
            id(&format!("edge {index}"))
        );
    }
    text
}

fn labels(board: &Design) -> String {
    let mut text = String::new();
    for (index, label) in board.labels.iter().enumerate() {
        let is_back = label.side == Side::Bottom;
        let _ = writeln!(
            text,
            "  (gr_text {} (at {}{}) (layer \"{}.SilkS\") (uuid {}) {})",
            quoted(&label.text),
            pair(on_sheet(label.at)),
            if label.is_upright { " 90" } else { "" },
            if is_back { "B" } else { "F" },
            id(&format!("label {index}")),
            effects(label.height_mm, is_back)
        );
    }
    text
}

fn copper(board: &Design) -> String {
    let mut text = String::new();
    for (index, track) in board.routed.tracks.iter().enumerate() {
        let _ = writeln!(
            text,
            "  (segment (start {}) (end {}) (width {}) (layer \"{}\") (net {}) (uuid {}))",
            pair(on_sheet(track.from)),
            pair(on_sheet(track.to)),
            mm(track.width),
            layer(track.side),
            track.net + 1,
            id(&format!("track {index}"))
        );
    }
    for (index, via) in board.routed.vias.iter().chain(&board.pour.vias).enumerate() {
        let _ = writeln!(
            text,
            "  (via (at {}) (size {}) (drill {}) (layers \"F.Cu\" \"B.Cu\") (net {}) (uuid {}))",
            pair(on_sheet(via.at)),
            mm(VIA_MM),
            mm(VIA_DRILL_MM),
            via.net + 1,
            id(&format!("via {index}"))
        );
    }
    text
}

fn points(all: &[DVec2]) -> String {
    let all: Vec<String> = all
        .iter()
        .map(|point| format!("(xy {})", pair(on_sheet(*point))))
        .collect();
    format!("(pts {})", all.join(" "))
}

/// A ground pour: its zone, which is the whole board, and the polygons of copper in it.
fn zone(board: &Design, side: Side, polygons: &[Polygon]) -> String {
    let number = board
        .nets
        .iter()
        .position(|net| net == GND)
        .map_or(0, |net| net + 1);
    let layer = layer(side);
    let (clearance, width) = (mm(CLEARANCE_MM), mm(POUR_WIDTH_MM));
    let mut text = format!(
        "  (zone (net {number}) (net_name \"{GND}\") (layer \"{layer}\") (uuid {}) (hatch edge 0.5)\n    \
        (connect_pads no (clearance {clearance})) (min_thickness {width}) (filled_areas_thickness no)\n    (fill \
        yes (thermal_gap {clearance}) (thermal_bridge_width 0.3))\n    (polygon {})\n",
        id(&format!("zone {layer}")),
        points(&board.outline.corners)
    );
    for polygon in polygons {
        let _ = writeln!(
            text,
            "    (filled_polygon (layer \"{layer}\") {})",
            points(&polygon.points)
        );
    }
    text + "  )\n"
}
