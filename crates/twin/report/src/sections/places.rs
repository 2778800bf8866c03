//! Errors over the gel, for presses that are one frame each.

use digitac::PressEvaluation;
use twintac_plot::Places;
use twintac_plot::page::Block;

use super::parts::{figure, ranked, taxels_mm};
use crate::TwinReport;

pub(super) fn blocks(report: &TwinReport<'_>) -> Vec<Block> {
    let is_static = report
        .evaluation
        .presses
        .iter()
        .all(|press| press.time_s.len() == 1);
    let touched = ranked(report.evaluation);
    if !is_static || touched.is_empty() {
        return Vec::new();
    }
    let nearest: Vec<f64> = touched.iter().map(|(_, percent)| *percent).collect();
    let all = |(press, _): &(&PressEvaluation, f64)| press.errors.all.percent.unwrap_or(f64::NAN);
    let all: Vec<f64> = touched.iter().map(all).collect();
    let picture = |(title, values): (&str, Vec<f64>)| {
        let places = Places {
            title: title.into(),
            unit: "%".into(),
            places_mm: touched.iter().map(|(press, _)| press.place_mm).collect(),
            values,
            marks_mm: taxels_mm(report.sensor),
        };
        let caption = "Absolute error of each held-out press where it was made, % of the largest reading. \
                       Dots with a white rim are taxels; the scale ends at the 99th percentile.";
        figure(places.scene(), report.provenance, caption)
    };
    let pictures = [("Error, nearest taxel", nearest), ("Error, all taxels", all)];
    vec![Block::Figures(pictures.map(picture).to_vec())]
}
