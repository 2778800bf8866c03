//! Footprints, in the library and on the board.

use std::collections::BTreeMap;
use std::fmt::Write as _;

use glam::DVec2;

use super::text::{GENERATOR, LIBRARY, effects, id, mm, on_sheet, pair, quoted};
use crate::circuit::Part;
use crate::design::Design;
use crate::land::{Land, Pad, Placement, Side};
use crate::rules::{SCREW_DRILL_MM, SCREW_FREE_MM};
use crate::shapes::Area;

const HOLE: &str = "MountingHole_2.2mm_M2";

/// A footprint on the board.
pub(super) struct OnBoard<'a> {
    pub(super) part: &'a Part,
    pub(super) place: Placement,
    /// The part's symbol on the schematic.
    pub(super) symbol_id: String,
    /// The net of a pad as `(net 1 "GND")`.
    pub(super) net: &'a dyn Fn(&Part, &str) -> String,
}

/// The footprints of the library, by name.
pub(super) fn library(board: &Design) -> BTreeMap<String, String> {
    let mut files = BTreeMap::new();
    for part in &board.circuit.parts {
        let land = &part.device.land;
        files.entry(land.name.to_owned()).or_insert_with(|| {
            let mut text = format!(
                "(footprint {}\n  (version 20241229)\n  (generator \"{GENERATOR}\")\n  (generator_version \
                \"9.0\")\n  (layer \"F.Cu\")\n",
                quoted(land.name)
            );
            text += &body(land, None);
            text + ")\n"
        });
    }
    let hole = format!(
        "(footprint \"{HOLE}\"\n  (version 20241229)\n  (generator \"{GENERATOR}\")\n  (generator_version \
        \"9.0\")\n  (layer \"F.Cu\")\n{})\n",
        hole_body("REF**", None)
    );
    files.insert(HOLE.to_owned(), hole);
    files
}

/// A part's footprint on the board.
pub(super) fn on_board(part: &OnBoard<'_>) -> String {
    let land = &part.part.device.land;
    let layer = layer(part.place.side, "Cu");
    let mut text = format!(
        "  (footprint \"{LIBRARY}:{}\"\n  (layer \"{layer}\")\n  (uuid {})\n  (at {}{})\n",
        land.name,
        id(&format!("footprint {}", part.part.reference)),
        pair(on_sheet(part.place.at)),
        angle(part.place),
    );
    text += &body(land, Some(part));
    text + "  )\n"
}

/// A hole for a screw on the board.
pub(super) fn hole_on_board(index: usize, at: DVec2) -> String {
    let reference = format!("H{}", index + 1);
    format!(
        "  (footprint \"{LIBRARY}:{HOLE}\"\n  (layer \"F.Cu\")\n  (uuid {})\n  (at {})\n{}  )\n",
        id(&format!("footprint {reference}")),
        pair(on_sheet(at)),
        hole_body(&reference, Some(&reference)),
    )
}

fn layer(side: Side, of: &str) -> String {
    let face = if side == Side::Top { "F" } else { "B" };
    format!("{face}.{of}")
}

fn angle(place: Placement) -> String {
    match place.quarters % 4 {
        0 => String::new(),
        quarters => format!(" {}", 90 * u32::from(quarters)),
    }
}

/// Only footprints on boards have identifiers.
fn uuid(part: Option<&OnBoard<'_>>, what: &str) -> String {
    part.map_or(String::new(), |part| {
        format!(" (uuid {})", id(&format!("{} {what}", part.part.reference)))
    })
}

fn body(land: &Land, part: Option<&OnBoard<'_>>) -> String {
    let side = part.map_or(Side::Top, |part| part.place.side);
    let is_back = side == Side::Bottom;
    let local = |point: DVec2| {
        if is_back {
            DVec2::new(point.x, -point.y)
        } else {
            point
        }
    };
    let turned = part.map_or(0, |part| 90 * u32::from(part.place.quarters % 4));
    let fab = layer(side, "Fab");
    let height = (0.35 * land.body.size().min_element()).clamp(0.25, 0.8);
    let mut text = String::new();
    let (reference, value) = part.map_or(("REF**", land.name), |part| {
        (part.part.reference.as_str(), part.part.value.as_str())
    });
    for (name, of, up) in [("Reference", reference, -0.6), ("Value", value, 0.6)] {
        let at = local(DVec2::new(0.0, up * height));
        let _ = writeln!(
            text,
            "  (property \"{name}\" {} (at {} {turned}) (layer \"{fab}\"){} {})",
            quoted(of),
            pair(at),
            uuid(part, name),
            effects(height, is_back)
        );
    }
    if let Some(part) = part {
        let _ = writeln!(text, "  (path \"/{}\")", part.symbol_id.trim_matches('"'));
    }
    let _ = writeln!(text, "  (descr {})", quoted(land.description));
    text += if land.is_placed {
        "  (attr smd)\n"
    } else {
        "  (attr smd exclude_from_pos_files exclude_from_bom)\n"
    };
    if let Some((joined, _)) = &land.bridge {
        let _ = writeln!(text, "  (net_tie_pad_groups \"{}, {}\")", joined[0], joined[1]);
    }
    for (of, width, area) in [("CrtYd", 0.05, &land.courtyard), ("Fab", 0.1, &land.body)] {
        text += &rectangle(area, local, &layer(side, of), width, false, &uuid(part, of));
    }
    for (index, [from, to]) in land.silk.iter().enumerate() {
        let _ = writeln!(
            text,
            "  (fp_line (start {}) (end {}) (stroke (width 0.12) (type solid)) (layer \"{}\"){})",
            pair(local((*from).into())),
            pair(local((*to).into())),
            layer(side, "SilkS"),
            uuid(part, &format!("silk {index}"))
        );
    }
    if let Some((_, copper)) = &land.bridge {
        text += &rectangle(
            copper,
            local,
            &layer(side, "Cu"),
            0.0,
            true,
            &uuid(part, "bridge"),
        );
    }
    for (index, pad) in land.pads.iter().enumerate() {
        text += &pad_text(pad, index, side, local(pad.at), turned, part);
    }
    if land.height_mm > 0.0 {
        let _ = writeln!(
            text,
            "  (model \"${{KIPRJMOD}}/models/{}.step\" (offset (xyz 0 0 0)) (scale (xyz 1 1 1)) (rotate (xyz 0 \
            0 0)))",
            land.name
        );
    }
    text
}

fn pad_text(
    pad: &Pad,
    index: usize,
    side: Side,
    at: DVec2,
    turned: u32,
    part: Option<&OnBoard<'_>>,
) -> String {
    let shape = if pad.is_round { "circle" } else { "roundrect" };
    let rounding = if pad.is_round {
        ""
    } else {
        " (roundrect_rratio 0.2)"
    };
    let mut layers = vec![layer(side, "Cu"), layer(side, "Mask")];
    if pad.has_paste {
        layers.push(layer(side, "Paste"));
    }
    let layers: Vec<String> = layers.iter().map(|layer| quoted(layer)).collect();
    let turned = if turned == 0 {
        String::new()
    } else {
        format!(" {turned}")
    };
    let net = part.map_or(String::new(), |part| (part.net)(part.part, pad.number));
    format!(
        "  (pad {} smd {shape} (at {}{turned}) (size {}) (layers {}){rounding}{net}{})\n",
        quoted(pad.number),
        pair(at),
        pair(pad.size),
        layers.join(" "),
        uuid(part, &format!("pad {index}"))
    )
}

fn rectangle(
    area: &Area,
    local: impl Fn(DVec2) -> DVec2,
    layer: &str,
    width: f64,
    is_filled: bool,
    uuid: &str,
) -> String {
    format!(
        "  (fp_rect (start {}) (end {}) (stroke (width {}) (type solid)) (fill {}) (layer \"{layer}\"){uuid})\n",
        pair(local(area.min)),
        pair(local(area.max)),
        mm(width),
        if is_filled { "yes" } else { "no" },
    )
}

fn hole_body(reference: &str, of: Option<&str>) -> String {
    let uuid = |what: &str| {
        of.map_or(String::new(), |of| {
            format!(" (uuid {})", id(&format!("{of} {what}")))
        })
    };
    let mut text = String::new();
    for (name, value) in [("Reference", reference), ("Value", HOLE)] {
        let _ = writeln!(
            text,
            "  (property \"{name}\" {} (at 0 0 0) (layer \"F.Fab\"){} {})",
            quoted(value),
            uuid(name),
            effects(0.5, false)
        );
    }
    text +=
        "  (descr \"Hole for an M2 screw\")\n  (attr exclude_from_pos_files exclude_from_bom board_only)\n";
    for layer in ["F.CrtYd", "B.CrtYd"] {
        let _ = writeln!(
            text,
            "  (fp_circle (center 0 0) (end {} 0) (stroke (width 0.05) (type solid)) (fill no) (layer \
            \"{layer}\"){})",
            mm(SCREW_FREE_MM),
            uuid(layer)
        );
    }
    let drill = mm(SCREW_DRILL_MM);
    let _ = writeln!(
        text,
        "  (pad \"\" np_thru_hole circle (at 0 0) (size {drill} {drill}) (drill {drill}) (layers \"*.Cu\" \
        \"*.Mask\"){})",
        uuid("pad")
    );
    text
}
