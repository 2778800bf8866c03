//! The sections of the page, in the order in which they are read.

mod alignment;
mod bench;
mod comparison;
mod making;
mod maps;
mod parts;
mod places;
mod presses;
mod replay;
mod result;
mod sensor;
mod simulation;
mod summary;
mod taxels;
mod training;

use twintac_plot::page::{Block, Page, Section};

use parts::badge;

use crate::TwinReport;

pub use alignment::warp_plot;
pub use maps::pressure_maps;

/// The whole page; parts without data are left out.
#[must_use]
pub fn page(report: &TwinReport<'_>) -> Page {
    Page {
        kind: "TwinTac report".into(),
        title: format!("Digital twin of {}", report.sensor.name),
        badge: badge(report.provenance),
        lead: summary::paragraphs(report),
        warnings: summary::warnings(report),
        sections: vec![
            section("result", "Result", result::blocks(report)),
            section("replay", "Move through the presses", replay::blocks(report)),
            section("presses", "Presses over time", presses::blocks(report)),
            section("maps", "Pressure maps", maps::blocks(report)),
            section("places", "Errors over the gel", places::blocks(report)),
            section("taxels", "Errors by taxel and depth", taxels::blocks(report)),
            section("recordings", "Recordings", comparison::recordings(report)),
            section("variants", "Variants", comparison::variants(report)),
            section("training", "Training", training::blocks(report)),
            section("bench", "Setup calibration", bench::blocks(report)),
            section("alignment", "Alignment", alignment::blocks(report)),
            section("simulation", "The simulation", simulation::blocks(report)),
            section("sensor", "The sensor", sensor::blocks(report)),
            section("making-of", "How it was made", making::blocks(report)),
        ],
        is_sheet: false,
    }
}

fn section(id: &'static str, title: &'static str, blocks: Vec<Block>) -> Section {
    Section { id, title, blocks }
}
