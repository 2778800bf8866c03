//! The schematic: parts in rows. Each pin is labelled with its net.

use std::fmt::Write as _;

use glam::DVec2;

use super::symbol;
use super::text::{GENERATOR, LIBRARY, id, mm, pair, quoted};
use crate::circuit::{GND, Part, SUPPLY};
use crate::design::Design;

/// Distances of columns and rows, mm; multiples of KiCad's grid.
const COLUMN_MM: f64 = 50.8;
const ROW_MM: f64 = 27.94;
const BORDER_MM: f64 = 38.1;
/// Number of taxels in one column.
const TAXELS_IN_COLUMN: usize = 8;

/// The identifier of a part's symbol.
pub(super) fn symbol_id(reference: &str) -> String {
    id(&format!("symbol {reference}"))
}

fn root_id() -> String {
    id("schematic")
}

/// The whole file.
pub(super) fn schematic(board: &Design) -> String {
    let places = places(board);
    let reach = places.iter().fold(DVec2::ZERO, |reach, at| reach.max(*at));
    let size = (reach + DVec2::new(COLUMN_MM, 2.0 * BORDER_MM)).max(DVec2::new(420.0, 297.0));
    let mut text = format!(
        "(kicad_sch\n  (version 20250114)\n  (generator \"{GENERATOR}\")\n  (generator_version \"9.0\")\n  \
        (uuid {})\n  (paper \"User\" {})\n",
        root_id(),
        pair(size)
    );
    let _ = writeln!(
        text,
        "  (title_block (title {}) (comment 1 \"Never built yet\"))",
        quoted(&format!("TwinTac {}", board.variant))
    );
    text += &symbol::kept(board);
    for (part, at) in board.circuit.parts.iter().zip(&places) {
        text += &labels(part, *at);
        text += &instance(board, part, *at);
    }
    for (index, net) in [SUPPLY, GND].into_iter().enumerate() {
        let at = DVec2::new(BORDER_MM + COLUMN_MM * index as f64, BORDER_MM - 12.7);
        text += &flag(board, index + 1, net, at);
    }
    text + "  (sheet_instances (path \"/\" (page \"1\")))\n  (embedded_fonts no)\n)\n"
}

/// The position of each part on the sheet.
fn places(board: &Design) -> Vec<DVec2> {
    let circuit = &board.circuit;
    let mut places = vec![DVec2::ZERO; circuit.parts.len()];
    let cell =
        |column: usize, row: f64| DVec2::new(BORDER_MM + COLUMN_MM * column as f64, BORDER_MM + ROW_MM * row);
    for (index, taxel) in circuit.taxels.iter().enumerate() {
        let (column, row) = (4 * (index / TAXELS_IN_COLUMN), (index % TAXELS_IN_COLUMN) as f64);
        places[taxel.chip] = cell(column, row);
        places[taxel.capacitor] = cell(column + 1, row);
        places[taxel.pull_ups[0]] = cell(column + 2, row);
        places[taxel.pull_ups[1]] = cell(column + 3, row);
    }
    let first = 4 * circuit.taxels.len().div_ceil(TAXELS_IN_COLUMN);
    places[circuit.connector] = cell(first, 0.0);
    for (index, part) in circuit.at_connector.into_iter().enumerate() {
        places[part] = cell(first + 1 + index % 2, (index / 2) as f64);
    }
    for (index, part) in circuit.reset.into_iter().enumerate() {
        places[part] = cell(first + 1 + index, 2.0);
    }
    for (index, switch) in circuit.switches.iter().enumerate() {
        let row = 4.0 + 3.0 * index as f64;
        places[switch.switch] = cell(first, row);
        places[switch.capacitor] = cell(first + 1, row - 1.0);
        // Beside the capacitor, and below it.
        let beside = [(2, -1.0), (1, 0.0), (2, 0.0)];
        for (jumper, (column, down)) in switch.jumpers.into_iter().zip(beside) {
            places[jumper] = cell(first + column, row + down);
        }
    }
    places
}

fn labels(part: &Part, at: DVec2) -> String {
    let mut text = String::new();
    let ends = symbol::pin_ends(&part.device);
    for (index, (pin, end)) in part.device.pins.iter().zip(ends).enumerate() {
        let place = at + DVec2::new(end.x, -end.y);
        let name = format!("{} {}", part.reference, index);
        match &part.nets[index] {
            Some(net) => text += &label(net, place, pin.is_left, &name),
            None => {
                let _ = writeln!(
                    text,
                    "  (no_connect (at {}) (uuid {}))",
                    pair(place),
                    id(&format!("open {name}"))
                );
            }
        }
    }
    text
}

fn label(net: &str, at: DVec2, is_left: bool, name: &str) -> String {
    let (angle, justify) = if is_left { (180, "right") } else { (0, "left") };
    format!(
        "  (global_label {} (shape passive) (at {} {angle}) (effects (font (size 1.27 1.27)) (justify \
        {justify})) (uuid {}))\n",
        quoted(net),
        pair(at),
        id(&format!("label {name}"))
    )
}

fn instance(board: &Design, part: &Part, at: DVec2) -> String {
    let up = 2.54 * (symbol::rows(&part.device) as f64 / 2.0 + 1.5);
    let in_bom = if part.device.bought.is_some() { "yes" } else { "no" };
    let footprint = format!("{LIBRARY}:{}", part.device.land.name);
    let mut text = format!(
        "  (symbol (lib_id \"{LIBRARY}:{}\") (at {} 0) (unit 1) (exclude_from_sim no) (in_bom {in_bom}) \
        (on_board yes) (dnp no) (uuid {})\n",
        part.device.symbol,
        pair(at),
        symbol_id(&part.reference)
    );
    for (name, value, y, hidden) in [
        ("Reference", part.reference.as_str(), at.y - up, ""),
        ("Value", part.value.as_str(), at.y + up, ""),
        ("Footprint", &footprint, at.y, " (hide yes)"),
        ("Datasheet", "", at.y, " (hide yes)"),
        ("Description", "", at.y, " (hide yes)"),
    ] {
        let _ = writeln!(
            text,
            "    (property \"{name}\" {} (at {} {} 0) (effects (font (size 1.27 1.27)){hidden}))",
            quoted(value),
            mm(at.x),
            mm(y)
        );
    }
    for pin in &part.device.pins {
        let pin_id = id(&format!("pin {} {}", part.reference, pin.number));
        let _ = writeln!(text, "    (pin {} (uuid {pin_id}))", quoted(pin.number));
    }
    text + &of_project(board, &part.reference)
}

fn of_project(board: &Design, reference: &str) -> String {
    format!(
        "    (instances (project {} (path \"/{}\" (reference {}) (unit 1))))\n  )\n",
        quoted(&board.variant),
        root_id().trim_matches('"'),
        quoted(reference)
    )
}

/// A power flag: the net is supplied from outside.
fn flag(board: &Design, index: usize, net: &str, at: DVec2) -> String {
    let reference = format!("#FLG{index:02}");
    let mut text = label(net, at, true, &reference);
    let _ = writeln!(
        text,
        "  (symbol (lib_id \"{LIBRARY}:PWR_FLAG\") (at {} 0) (unit 1) (exclude_from_sim no) (in_bom yes) \
        (on_board yes) (dnp no) (uuid {})",
        pair(at),
        symbol_id(&reference)
    );
    for (name, value, hidden) in [
        ("Reference", reference.as_str(), " (hide yes)"),
        ("Value", "PWR_FLAG", ""),
        ("Footprint", "", " (hide yes)"),
        ("Datasheet", "", " (hide yes)"),
        ("Description", "", " (hide yes)"),
    ] {
        let _ = writeln!(
            text,
            "    (property \"{name}\" {} (at {} {} 0) (effects (font (size 1.27 1.27)){hidden}))",
            quoted(value),
            mm(at.x),
            mm(at.y - 3.81)
        );
    }
    let _ = writeln!(text, "    (pin \"1\" (uuid {}))", id(&format!("pin {reference}")));
    text + &of_project(board, &reference)
}
