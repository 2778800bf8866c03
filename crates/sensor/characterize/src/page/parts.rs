//! Parts that both pages use.

use twintac_plot::page::{Badge, Block, Cell, Figure, Row, Table};
use twintac_recording::{Provenance, Recording};
use twintac_sensor::Sensor;

use super::plots::Plot;
use crate::Characterization;
use crate::recorded::Recorded;

/// Plots side by side. All figures of a page have one provenance.
pub(super) fn figures(plots: Vec<Option<Plot>>, provenance: Provenance) -> Block {
    let figure = |(scene, caption)| Figure {
        scene,
        badge: Some(badge(provenance)),
        caption,
        table: None,
    };
    Block::Figures(plots.into_iter().flatten().map(figure).collect())
}

pub(super) fn badge(provenance: Provenance) -> Badge {
    Badge(provenance.to_string())
}

pub(super) fn table<const N: usize>(
    caption: impl Into<String>,
    head: [&str; N],
    rows: Vec<Vec<Cell>>,
) -> Block {
    Block::Table(Table {
        caption: caption.into(),
        head: head.map(str::to_owned).to_vec(),
        rows: rows.into_iter().map(Row::from).collect(),
    })
}

/// Warnings at the top of a page.
pub(super) fn warnings(found: &Characterization) -> Vec<String> {
    let mut warnings = Vec::new();
    if found.provenance != Provenance::Real {
        warnings.push(format!(
            "All figures are {}: they say how the analysis works, and nothing about a physical sensor.",
            found.provenance
        ));
    }
    if found.n_leaps > 0 {
        warnings.push(format!(
            "{} intervals of five seconds are left out of the noise, zero and temperature of their taxel: its readings jump there, as if something touched it.",
            found.n_leaps
        ));
    }
    let n_left_out = found.n_presses - found.n_used;
    if n_left_out > 0 {
        warnings.push(format!(
            "{n_left_out} of {} presses are left out: their force is not known, or they do not touch.",
            found.n_presses
        ));
    }
    if let Some(range) = found.range.found().filter(|range| range.n_invalid > 0) {
        warnings.push(format!(
            "{} readings under load are not valid (at an end of the barometers’ range, or missing) and left out.",
            range.n_invalid
        ));
    }
    warnings
}

pub(super) fn recorded<'a>(
    found: &Characterization,
    recording: &'a Recording,
    sensor: &Sensor,
) -> Vec<Recorded<'a>> {
    Recorded::all(recording, sensor, &found.options)
}
