//! Quality of the simulation.

use twintac_depth_table::SolveQuality;
use twintac_plot::page::{Block, Card, Fact};
use twintac_plot::short;
use twintac_recording::Provenance;

use super::parts::badge;
use crate::TwinReport;

pub(super) fn blocks(report: &TwinReport<'_>) -> Vec<Block> {
    let card = |value: String, name: &str| Card {
        fact: Fact::new(name, value),
        badge: badge(Provenance::Simulated),
    };
    let frames = || report.tables.iter().flat_map(|table| &table.frames);
    if frames().next().is_none() {
        return Vec::new();
    }
    let largest = |of: fn(&SolveQuality) -> f64| frames().map(|frame| of(&frame.quality)).fold(0.0, f64::max);
    let smallest_ratio = frames()
        .map(|frame| frame.quality.smallest_volume_ratio)
        .fold(f64::INFINITY, f64::min);
    let penetration = short(largest(|quality| quality.penetration_mm));
    let cards = vec![
        card(frames().count().to_string(), "frames computed"),
        card(
            short(largest(|quality| quality.residual)),
            "worst relative residual",
        ),
        card(format!("{penetration} mm"), "largest penetration"),
        card(short(smallest_ratio), "smallest volume ratio of an element"),
    ];
    let failures: Vec<String> = report
        .tables
        .iter()
        .filter_map(|table| table.failure.clone())
        .collect();
    let failures = if failures.is_empty() {
        Block::Text("No simulated press failed.".into())
    } else {
        Block::Warnings("Failed presses", failures)
    };
    vec![Block::Cards(cards), failures]
}
