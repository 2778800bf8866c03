//! Numbers, strings and identifiers of KiCad's files.

use glam::DVec2;
use sha2::{Digest as _, Sha256};

/// The name of the project's own libraries.
pub(super) const LIBRARY: &str = "twintac";
/// The program that wrote the files.
pub(super) const GENERATOR: &str = "twintac";
/// Position of the sensor's origin on KiCad's sheet, mm.
const ORIGIN_MM: DVec2 = DVec2::new(148.5, 105.0);

/// A number with at most four decimals.
pub(super) fn mm(value: f64) -> String {
    let text = format!("{value:.4}");
    let text = text.trim_end_matches('0').trim_end_matches('.');
    if text == "-0" {
        "0".to_owned()
    } else {
        text.to_owned()
    }
}

/// Two numbers.
pub(super) fn pair(point: DVec2) -> String {
    format!("{} {}", mm(point.x), mm(point.y))
}

/// A point of the board on KiCad's sheet, whose y points down.
pub(super) fn on_sheet(point: DVec2) -> DVec2 {
    ORIGIN_MM + DVec2::new(point.x, -point.y)
}

/// A string in quotes.
pub(super) fn quoted(text: &str) -> String {
    format!("\"{}\"", text.replace('\\', "\\\\").replace('"', "\\\""))
}

/// An identifier: a hash of a name, in the form of a UUID of version 8.
pub(super) fn id(name: &str) -> String {
    let digest = Sha256::digest(format!("twintac-board {name}").as_bytes());
    let hex: String = digest[..16].iter().map(|byte| format!("{byte:02x}")).collect();
    format!(
        "\"{}-{}-8{}-8{}-{}\"",
        &hex[..8],
        &hex[8..12],
        &hex[13..16],
        &hex[17..20],
        &hex[20..32]
    )
}

/// The effects of a text: its height, and whether it is mirrored for the back.
pub(super) fn effects(height_mm: f64, is_mirrored: bool) -> String {
    let thickness = mm(0.15 * height_mm);
    let justify = if is_mirrored { " (justify mirror)" } else { "" };
    let height = mm(height_mm);
    format!("(effects (font (size {height} {height}) (thickness {thickness})){justify})")
}
