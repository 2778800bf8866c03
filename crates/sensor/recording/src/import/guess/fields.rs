//! The description as text: one line for each field, with a comment on what it was guessed from.

use std::fmt::Write as _;

use super::column::{Column, quoted};
use super::layout::Layout;
use super::roles::Roles;
use super::unit::{self, Length};

/// The lines of the description.
struct Lines(String);

impl Lines {
    /// Adds a field and the reason for its value.
    fn add(&mut self, field: &str, why: &str) {
        let comment = if why.is_empty() {
            String::new()
        } else {
            format!("    # {why}")
        };
        let _ = writeln!(self.0, "{field}{comment}");
    }

    /// An empty line.
    fn part(&mut self) {
        self.0.push('\n');
    }
}

/// The description of a file: a text with its layout and all its columns, or a bag.
pub(super) fn write(file: &str, layout: Option<&Layout>, columns: &[Column], roles: &Roles) -> String {
    let seen = match layout {
        Some(_) => "its first lines",
        None => "the types of its topics",
    };
    let mut lines = Lines(format!(
        "# How to read {file}: guessed from {seen}. Check each line; values marked with TODO are not in the file.\n\n"
    ));
    lines.add(
        "sensor = \"my-sensor\"",
        "TODO: the name in the sensor's description",
    );
    lines.add("provenance = \"real\"", "or \"emulated\", \"simulated\"");
    lines.add("indenter = \"tip\"", "TODO: the name in the sensor's description");
    lines.add(
        "gel_top_mm = 8.5",
        "TODO: height of the untouched gel above the board",
    );
    if let Some(layout) = layout {
        add_layout(&mut lines, layout, columns);
    }
    lines.part();
    add_motion(&mut lines, roles);
    lines.part();
    add_readings(&mut lines, roles);
    lines.part();
    add_presses(&mut lines, roles);
    lines.0
}

/// Adds the layout of the file where it differs from the defaults.
fn add_layout(lines: &mut Lines, layout: &Layout, columns: &[Column]) {
    let shown = |byte: u8| quoted(&char::from(byte).to_string());
    if layout.delimiter != b',' {
        lines.add(&format!("delimiter = {}", shown(layout.delimiter)), "");
    }
    if layout.has_decimal_comma {
        lines.add("decimal = \",\"", "");
    }
    if let Some(comment) = layout.comment {
        lines.add(&format!("comment = {}", shown(comment)), "");
    }
    if layout.skip_lines > 0 {
        lines.add(
            &format!("skip_lines = {}", layout.skip_lines),
            "lines before the names of columns",
        );
    }
    if layout.header.is_none() {
        let names: Vec<String> = columns.iter().map(|column| quoted(&column.name)).collect();
        lines.add(
            &format!("columns = [{}]", names.join(", ")),
            "TODO: names; the file has none that can be read",
        );
    }
}

/// Time, pose and force.
fn add_motion(lines: &mut Lines, roles: &Roles) {
    match roles.time {
        Some(time) => {
            let (field, why) = unit::time(time);
            lines.add(&field, &why);
        }
        None => lines.add(
            "# time = { column = \"…\", unit = \"s\" }",
            "TODO: no column looks like a time",
        ),
    }
    for (axis, column) in ["x", "y", "z"].into_iter().zip(roles.place) {
        if let Some(column) = column {
            let unit = Length::of(column);
            let name = quoted(&column.name);
            lines.add(
                &format!("{axis} = {{ column = {name}, unit = \"{}\" }}", unit.name),
                unit.why,
            );
        }
    }
    if let Some(turn) = roles.turn {
        let names = turn.map(|column| quoted(&column.name)).join(", ");
        lines.add(
            &format!("rotation = {{ columns = [{names}] }}"),
            "`upright`: their values where the indenter is upright",
        );
    }
    let Some(z) = roles.place[2] else {
        if roles.time.is_some() && roles.press.is_none() {
            return;
        }
        lines.add(
            "# z = { column = \"…\", unit = \"mm\" }",
            "TODO: no column looks like a height",
        );
        lines.add(
            "weight_n = 1.0",
            "TODO: given because there is no z: leave it out, or give the weight that lay on the gel",
        );
        return;
    };
    let (contact, is_down) = roles.contact(z);
    let contact_mm = contact * Length::of(z).mm;
    let points = if is_down { ", z_points = \"down\"" } else { "" };
    lines.add(
        &format!("contact = {{ z_mm = {contact_mm:.3}{points} }}"),
        "where the readings begin to rise: measure it",
    );
    if let Some(force) = roles.force {
        let unit = match force.unit.as_deref() {
            Some("mn") => "mN",
            Some("kgf") => "kgf",
            _ => "N",
        };
        let name = quoted(&force.name);
        lines.add(
            &format!("force = {{ column = {name}, unit = \"{unit}\" }}"),
            "into the gel; with `scale = -1.0` out of it",
        );
    }
}

fn add_readings(lines: &mut Lines, roles: &Roles) {
    let taxels = &roles.taxels;
    let (unit, why) = unit::pressure(taxels);
    let counts = if unit == "counts" {
        ", kpa_per_count = 1.0"
    } else {
        ""
    };
    lines.add(&format!("readings = {{ unit = \"{unit}\"{counts} }}"), &why);
    let has_own = roles.temperatures.len() == taxels.len();
    match roles.temperatures.first() {
        Some(shared) if !has_own => lines.add(
            &format!(
                "temperatures = {{ column = {}, unit = \"C\" }}",
                quoted(&shared.name)
            ),
            "one thermometer for all taxels",
        ),
        Some(_) => lines.add("temperatures = { unit = \"C\" }", "of the taxels' own columns"),
        None => {}
    }
    lines.add("taxels = [", "TODO: names as in the sensor's description");
    for (index, taxel) in taxels.iter().enumerate() {
        let [name, column] = [taxel.bare_name(), taxel.name.clone()].map(|name| quoted(&name));
        let own = roles.temperatures.get(index).filter(|_| has_own);
        let own = own.map_or(String::new(), |own| {
            format!(", temperature = {}", quoted(&own.name))
        });
        lines.add(&format!("    {{ name = {name}, column = {column}{own} }},"), "");
    }
    lines.add("]", "");
}

fn add_presses(lines: &mut Lines, roles: &Roles) {
    match (roles.press, roles.place[2], roles.time) {
        (Some(press), _, Some(_)) => {
            let name = quoted(&press.name);
            lines.add(
                &format!("presses = {{ split = \"column\", column = {name} }}"),
                "another number or text for each press",
            );
        }
        (None, Some(z), Some(_)) => {
            let first = z.numbers.iter().copied().find(|z| z.is_finite());
            let rest_mm = first.unwrap_or(0.0) * Length::of(z).mm;
            lines.add(
                &format!(
                    "presses = {{ split = \"return-to-rest\", rest_mm = {rest_mm:.3}, tolerance_mm = 0.02 }}"
                ),
                "the tip starts from there and returns",
            );
        }
        (None, None, Some(_)) => lines.add(
            "presses = { split = \"none\" }",
            "no column looks like a height: readings alone, as `twintac characterize` takes them",
        ),
        _ => lines.add("presses = { split = \"row\" }", "each row is a press of its own"),
    }
    if roles.place[2].is_some() && roles.time.is_some() {
        lines.add(
            "zero = { above_contact_mm = 0.2, window_s = 1.0 }",
            "readings are relative to those before each press",
        );
    }
}
