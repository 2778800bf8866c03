//! Functions that several sections share.

use digitac::{Evaluation, PressEvaluation};
use twintac_plot::page::{Badge, Block, Cell, Figure};
use twintac_plot::{Bar, Bars, Ink, Panel, Panels, Scene, Series, fixed};
use twintac_recording::Provenance;
use twintac_sensor::Sensor;

/// Names of the error measures; the first is the headline.
pub(super) const NEAREST: &str = "nearest taxel in contact";
pub(super) const ALL: &str = "all taxels, all frames";

pub(super) fn badge(provenance: Provenance) -> Badge {
    Badge(provenance.to_string())
}

pub(super) fn figure(
    scene: Scene,
    provenance: impl Into<Option<Provenance>>,
    caption: impl Into<String>,
) -> Figure {
    Figure {
        scene,
        badge: provenance.into().map(badge),
        caption: caption.into(),
        table: None,
    }
}

/// Pictures under a text that explains them; empty without pictures.
pub(super) fn explained(text: &str, pictures: Vec<Figure>) -> Vec<Block> {
    if pictures.is_empty() {
        return Vec::new();
    }
    vec![Block::Text(text.into()), Block::Figures(pictures)]
}

pub(super) fn words(text: impl Into<String>) -> Cell {
    Cell::Words(text.into())
}

pub(super) fn percent_cell(value: impl Into<Option<f64>>) -> Cell {
    Cell::Number(percent(value))
}

pub(super) fn head<const N: usize>(names: [&str; N]) -> Vec<String> {
    names.map(str::to_owned).to_vec()
}

/// An error in %, kept on one line, with about three significant digits; "none" if there is none.
pub(super) fn percent(value: impl Into<Option<f64>>) -> String {
    let Some(value) = value.into() else {
        return "none".into();
    };
    if !value.is_finite() {
        return "–".into();
    }
    let decimals = if value.abs() < 9.995 { 2 } else { 1 };
    format!("{}\u{a0}%", fixed(value, decimals))
}

pub(super) fn bar(name: impl Into<String>, value: impl Into<Option<f64>>, ink: Ink) -> Bar {
    let value = value.into();
    Bar {
        name: name.into(),
        value: value.unwrap_or(f64::NAN),
        uncertainty: None,
        text: percent(value),
        ink,
    }
}

/// Bars of errors.
pub(super) fn errors(title: &str, bars: impl IntoIterator<Item = Bar>) -> Scene {
    Bars {
        title: title.into(),
        x_label: "mean absolute error, % of the largest reading".into(),
        bars: bars.into_iter().collect(),
    }
    .scene()
}

pub(super) fn line(name: &str, points: Vec<[f64; 2]>, ink: Ink, width_px: f64) -> Series {
    Series {
        name: name.into(),
        points,
        ink,
        width_px,
        dashed: false,
    }
}

/// Lines in one panel.
pub(super) fn chart(title: &str, [x_label, y_label]: [&str; 2], series: Vec<Series>) -> Panels {
    let panel = Panel {
        y_label: y_label.into(),
        series,
        ..Panel::default()
    };
    Panels {
        title: title.into(),
        x_label: x_label.into(),
        panels: vec![panel],
        panel_height_px: 200.0,
        logarithmic: false,
    }
}

pub(super) fn taxels_mm(sensor: &Sensor) -> Vec<[f64; 2]> {
    let place = |taxel: &twintac_sensor::Taxel| [taxel.position_mm.x, taxel.position_mm.y];
    sensor.taxels.iter().map(place).collect()
}

/// Presses with contact and their errors, nearest taxel in contact, %, from the smallest error to
/// the largest.
pub(super) fn ranked(evaluation: &Evaluation) -> Vec<(&PressEvaluation, f64)> {
    let presses = evaluation.presses.iter();
    let touched = presses.filter_map(|press| Some((press, press.errors.nearest_in_contact.percent?)));
    let mut touched: Vec<_> = touched.collect();
    touched.sort_by(|a, b| a.1.total_cmp(&b.1));
    touched
}

/// The best press, the median and the worst.
pub(super) fn three(evaluation: &Evaluation) -> Vec<(&'static str, (&PressEvaluation, f64))> {
    let ranked = ranked(evaluation);
    match ranked.len() {
        0 => Vec::new(),
        n => vec![
            ("Best", ranked[0]),
            ("Median", ranked[n / 2]),
            ("Worst", ranked[n - 1]),
        ],
    }
}

/// The largest reading of some presses, kPa.
pub(super) fn largest_kpa<'a>(presses: impl IntoIterator<Item = &'a PressEvaluation>) -> f64 {
    let readings = presses
        .into_iter()
        .flat_map(|press| press.measured_kpa.iter().flatten());
    readings.fold(0.0, |largest: f64, reading| largest.max(*reading))
}

/// Usable readings, measured and predicted, kPa, with their taxels.
pub(super) fn usable(evaluation: &Evaluation) -> impl Iterator<Item = (usize, [f64; 2])> {
    evaluation.presses.iter().flat_map(|press| {
        let frames = press
            .measured_kpa
            .iter()
            .zip(&press.predicted_kpa)
            .zip(&press.valid);
        frames.flat_map(|((measured, predicted), valid)| {
            let taxels = (0..measured.len()).filter(|&taxel| valid[taxel]);
            taxels.map(|taxel| (taxel, [measured[taxel], predicted[taxel]]))
        })
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn percentages_keep_their_digits() {
        assert_eq!(percent(1.274), "1.27\u{a0}%");
        assert_eq!(percent(12.34), "12.3\u{a0}%");
        assert_eq!(percent(f64::NAN), "–");
        assert_eq!(percent(None), "none");
    }
}
