//! The chart of force error over real-time factor.

use twintac_plot::{Anchor, Ink, PALETTE, SMALL, Scene, text_width};

use super::row::Row;

/// Height of the picture, px. Its width follows from the legend's.
const HEIGHT: f64 = 400.0;
/// The plot's frame: left, top, right, bottom, px.
const BOX: [f64; 4] = [56.0, 40.0, 470.0, 350.0];
/// Range of the real-time factor, as powers of ten.
const DECADES: [i32; 2] = [-4, 1];
/// Range of the error, %, as powers of ten.
const ERROR_DECADES: [i32; 2] = [-1, 2];

/// The chart of all runs that gave figures: the largest force error over the depths, over the
/// real-time factor.
pub(super) fn scene(rows: &[Row]) -> Scene {
    let [left, top, right, bottom] = BOX;
    let entries = legend(rows);
    let widths = entries.iter().map(|entry| text_width(entry, SMALL));
    let width = right + 28.0 + widths.fold(0.0, f64::max);
    let mut scene = Scene::new("force error against real-time factor", width, HEIGHT);
    scene.heading("Ball pressed 2 mm into a bonded block: force error against rate");
    let x = |rtf: f64| left + (right - left) * part(rtf, DECADES);
    let y = |percent: f64| bottom - (bottom - top) * part(percent, ERROR_DECADES);
    for decade in DECADES[0]..=DECADES[1] {
        let value = 10f64.powi(decade);
        scene.line([[x(value), top], [x(value), bottom]], Ink::Grid, 1.0);
        scene.small(
            [x(value), bottom + 16.0],
            format!("{value}"),
            Ink::Muted,
            Anchor::Middle,
        );
    }
    for decade in ERROR_DECADES[0]..=ERROR_DECADES[1] {
        let value = 10f64.powi(decade);
        scene.line([[left, y(value)], [right, y(value)]], Ink::Grid, 1.0);
        scene.small(
            [left - 6.0, y(value) + 4.0],
            format!("{value}"),
            Ink::Muted,
            Anchor::End,
        );
    }
    scene.line([[x(1.0), top], [x(1.0), bottom]], Ink::Muted, 1.0);
    scene.small([x(1.0) + 4.0, top + 12.0], "real time", Ink::Muted, Anchor::Start);
    let below = "real-time factor (simulated seconds per wall second)";
    scene.small(
        [(left + right) / 2.0, bottom + 36.0],
        below,
        Ink::Muted,
        Anchor::Middle,
    );
    scene.upwards(
        [16.0, (top + bottom) / 2.0],
        "largest force error at 0.5, 1 and 2 mm (%)",
    );

    for (number, entry) in entries.iter().enumerate() {
        let at = [right + 18.0, top + 10.0 + 18.0 * number as f64];
        scene.dot([at[0], at[1] - 4.0], 4.0, ink(number), 1.0);
        scene.small([at[0] + 10.0, at[1]], entry, Ink::Text, Anchor::Start);
    }
    for row in rows {
        let (Some(figures), Some(percent)) = (&row.figures, row.worst_percent()) else {
            continue;
        };
        let number = entries.iter().position(|entry| *entry == name(row));
        let ink = ink(number.unwrap_or(0));
        let at = [x(figures.rtf), y(percent)];
        // A press that was cut was evaluated at fewer depths.
        if row.is_cut() {
            scene.ring(at, 4.0, ink, None);
        } else {
            scene.dot(at, 4.0, ink, 0.9);
        }
    }
    let at = [right + 18.0, top + 22.0 + 18.0 * entries.len() as f64];
    scene.ring([at[0], at[1] - 4.0], 4.0, Ink::Muted, None);
    scene.small(
        [at[0] + 10.0, at[1]],
        "ring: cut before 2 mm",
        Ink::Muted,
        Anchor::Start,
    );
    scene
}

/// Engines with their settings, in the order of their rows.
fn legend(rows: &[Row]) -> Vec<String> {
    let mut entries = Vec::new();
    let drawn = |row: &&Row| row.figures.is_some() && row.worst_percent().is_some();
    for entry in rows.iter().filter(drawn).map(name) {
        if !entries.contains(&entry) {
            entries.push(entry);
        }
    }
    entries
}

fn name(row: &Row) -> String {
    format!("{}, {}", row.engine, row.setting)
}

/// The colour of a setting. The first one is this project's; the others have a palette of six, and
/// the last is grey.
fn ink(number: usize) -> Ink {
    match number {
        0 => Ink::Text,
        _ if number > PALETTE.len() => Ink::Muted,
        _ => Ink::Series(number - 1),
    }
}

/// Relative position of a value between powers of ten, 0 to 1. Values outside are put on the edge.
fn part(value: f64, decades: [i32; 2]) -> f64 {
    let [low, high] = decades.map(f64::from);
    ((value.log10() - low) / (high - low)).clamp(0.0, 1.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn decades_are_equally_wide() {
        assert!((part(1e-4, DECADES)).abs() < 1e-12);
        assert!((part(1e-3, DECADES) - 0.2).abs() < 1e-12);
        assert!((part(100.0, DECADES) - 1.0).abs() < 1e-12);
    }
}
