//! Errors of each recording, and of each twin that was compared.

use twintac_plot::page::{Block, Cell, Row, Table};
use twintac_plot::{Ink, fixed};

use super::parts::{ALL, NEAREST, badge, bar, errors, figure, head, largest_kpa, percent_cell, words};
use crate::{TrainedVariant, TwinReport};

pub(super) fn recordings(report: &TwinReport<'_>) -> Vec<Block> {
    let count = |count: usize| Cell::Number(count.to_string());
    let rows = report.evaluation.twin.by_file.iter().map(|(file, found)| -> Row {
        let presses = || {
            report
                .evaluation
                .presses
                .iter()
                .filter(|press| press.mounting == *file)
        };
        vec![
            words(file),
            words("held-out presses"),
            count(presses().count()),
            count(presses().map(|press| press.time_s.len()).sum()),
            Cell::Number(fixed(largest_kpa(presses()), 1)),
            percent_cell(found.nearest_in_contact.percent),
            percent_cell(found.all.percent),
            Cell::Badge(badge(report.provenance)),
        ]
        .into()
    });
    let table = Table {
        caption: "Errors of each recording".into(),
        head: head([
            "recording",
            "used for",
            "presses",
            "frames",
            "largest reading, kPa",
            NEAREST,
            ALL,
            "source",
        ]),
        rows: rows.collect(),
    };
    vec![Block::Table(table)]
}

/// Variants, the chosen one emphasised.
pub(super) fn variants(report: &TwinReport<'_>) -> Vec<Block> {
    if report.variants.is_empty() {
        return Vec::new();
    }
    let bars = report.variants.iter().map(|trained| {
        let ink = if trained.is_chosen { Ink::Twin } else { Ink::Sensor };
        let error_percent = trained.test.overall.nearest_in_contact.percent;
        bar(trained.variant.name(), error_percent, ink)
    });
    let caption = "Held-out error, nearest taxel in contact. The twin of this report is coloured.";
    let picture = figure(errors("Error by variant", bars), report.provenance, caption);
    let row = |trained: &TrainedVariant<'_>| Row {
        cells: vec![
            words(trained.variant.name()),
            percent_cell(trained.validation.overall.nearest_in_contact.percent),
            percent_cell(trained.test.overall.nearest_in_contact.percent),
            percent_cell(trained.test.overall.all.percent),
            words(if trained.is_chosen { "✓ chosen" } else { "" }),
            Cell::Badge(badge(report.provenance)),
        ],
        is_chosen: trained.is_chosen,
    };
    let table = Table {
        caption: "Compared twins".into(),
        head: head(["variant", "validation", NEAREST, ALL, "", "source"]),
        rows: report.variants.iter().map(row).collect(),
    };
    vec![Block::Figures(vec![picture]), Block::Table(table)]
}
