//! Symbols: a box with pins on its left and right.

use std::collections::BTreeMap;
use std::fmt::Write as _;

use glam::DVec2;

use super::text::{GENERATOR, LIBRARY, mm, quoted};
use crate::design::Design;
use crate::device::{Device, Pin};

/// Pitch of pins, and their length, mm.
const PITCH_MM: f64 = 2.54;
/// Half the width of a box, mm: of the usual box, of one with three pins, and of one with two.
const HALF_WIDE_MM: f64 = 10.16;
const HALF_MIDDLE_MM: f64 = 5.08;
const HALF_NARROW_MM: f64 = 2.54;

/// The end of each pin, in the order of the device's pins: x to the right, y up.
pub(super) fn pin_ends(device: &Device) -> Vec<DVec2> {
    let half = half_width(device) + PITCH_MM;
    let mut used = [0.0, 0.0];
    let top = PITCH_MM * ((rows(device) - 1) as f64 / 2.0).floor();
    device
        .pins
        .iter()
        .map(|pin| {
            let row = &mut used[usize::from(pin.is_left)];
            let y = top - PITCH_MM * *row;
            *row += 1.0;
            DVec2::new(if pin.is_left { -half } else { half }, y)
        })
        .collect()
}

/// Number of rows of pins of a symbol.
pub(super) fn rows(device: &Device) -> usize {
    let left = device.pins.iter().filter(|pin| pin.is_left).count();
    left.max(device.pins.len() - left)
}

fn half_width(device: &Device) -> f64 {
    match device.pins.len() {
        0..=2 => HALF_NARROW_MM,
        3 => HALF_MIDDLE_MM,
        _ => HALF_WIDE_MM,
    }
}

/// The library of all symbols of a board.
pub(super) fn library(board: &Design) -> String {
    let mut text = format!(
        "(kicad_symbol_lib\n  (version 20241209)\n  (generator \"{GENERATOR}\")\n  (generator_version \"9.0\")\n"
    );
    for (name, device) in devices(board) {
        text += &symbol(device, name);
    }
    text += &flag("PWR_FLAG");
    text + ")\n"
}

/// The same symbols in the form in which a schematic contains them.
pub(super) fn kept(board: &Design) -> String {
    let mut text = "  (lib_symbols\n".to_owned();
    for (name, device) in devices(board) {
        text += &symbol(device, &format!("{LIBRARY}:{name}"));
    }
    text += &flag(&format!("{LIBRARY}:PWR_FLAG"));
    text + "  )\n"
}

fn devices(board: &Design) -> BTreeMap<&str, &Device> {
    let parts = board.circuit.parts.iter();
    parts.map(|part| (part.device.symbol, &part.device)).collect()
}

/// The fields of every symbol.
fn fields(reference: &str, value: &str, top: f64) -> String {
    let mut text = String::new();
    for (name, of, y) in [
        ("Reference", reference, top + 1.27),
        ("Value", value, -top - 1.27),
    ] {
        let _ = writeln!(
            text,
            "    (property \"{name}\" {} (at 0 {} 0) (effects (font (size 1.27 1.27))))",
            quoted(of),
            mm(y)
        );
    }
    for name in ["Footprint", "Datasheet", "Description"] {
        let _ = writeln!(
            text,
            "    (property \"{name}\" \"\" (at 0 0 0) (effects (font (size 1.27 1.27)) (hide yes)))"
        );
    }
    text
}

fn symbol(device: &Device, name: &str) -> String {
    let half = half_width(device);
    let ends = pin_ends(device);
    let highest = ends.iter().map(|end| end.y).fold(f64::NEG_INFINITY, f64::max);
    let lowest = ends.iter().map(|end| end.y).fold(f64::INFINITY, f64::min);
    let (top, bottom) = (highest + PITCH_MM, lowest - PITCH_MM);
    let in_bom = if device.bought.is_some() { "yes" } else { "no" };
    let hidden = if device.pins.len() <= 2 { " (hide yes)" } else { "" };
    let mut text = format!(
        "  (symbol {} (pin_names (offset 1.016){hidden}) (exclude_from_sim no) (in_bom {in_bom}) (on_board yes)\n",
        quoted(name)
    );
    text += &fields(device.prefix, device.symbol, top.max(-bottom));
    let _ = writeln!(
        text,
        "    (symbol \"{}_0_1\" (rectangle (start {} {}) (end {} {}) (stroke (width 0.254) (type default)) \
        (fill (type background))))",
        device.symbol,
        mm(-half),
        mm(top),
        mm(half),
        mm(bottom)
    );
    let _ = writeln!(text, "    (symbol \"{}_1_1\"", device.symbol);
    for (pin, end) in device.pins.iter().zip(ends) {
        text += &pin_text(pin, end);
    }
    text + "    )\n    (embedded_fonts no)\n  )\n"
}

fn pin_text(pin: &Pin, end: DVec2) -> String {
    let angle = if pin.is_left { 0 } else { 180 };
    format!(
        "      (pin {} line (at {} {} {angle}) (length {PITCH_MM}) (name {} (effects (font (size 1.27 1.27)))) \
        (number {} (effects (font (size 1.27 1.27)))))\n",
        pin.electrical.word(),
        mm(end.x),
        mm(end.y),
        quoted(pin.name),
        quoted(pin.number)
    )
}

/// The symbol of a power flag: the net is supplied from outside.
fn flag(name: &str) -> String {
    let mut text = format!(
        "  (symbol {} (power) (pin_numbers (hide yes)) (pin_names (offset 0) (hide yes)) (exclude_from_sim no) \
        (in_bom yes) (on_board yes)\n",
        quoted(name)
    );
    text += &fields("#FLG", "PWR_FLAG", 2.54);
    text += "    (symbol \"PWR_FLAG_0_1\" (polyline (pts (xy 0 0) (xy 0 1.27) (xy -1.016 1.905) (xy 0 2.54) (xy \
        1.016 1.905) (xy 0 1.27)) (stroke (width 0) (type default)) (fill (type none))))\n";
    text += "    (symbol \"PWR_FLAG_1_1\" (pin power_out line (at 0 0 90) (length 0) (name \"~\" (effects (font \
        (size 1.27 1.27)))) (number \"1\" (effects (font (size 1.27 1.27))))))\n";
    text + "    (embedded_fonts no)\n  )\n"
}
