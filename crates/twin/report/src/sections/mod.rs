//! The sections of the page, in the order in which they are read.

mod evidence;
mod figures;
mod scores;
mod summary;

use twintac_plot::Scene;
use twintac_plot::fixed;
use twintac_plot::page::{Badge, Block, Cell, Figure, Page, Section};

use crate::data::ReportData;

/// The whole page; parts without data are left out.
#[must_use]
pub fn page(data: &ReportData) -> Page {
    Page {
        kind: "TwinTac report".into(),
        title: if data.title.is_empty() {
            "TwinTac report".into()
        } else {
            data.title.clone()
        },
        badge: data.provenance.badge(),
        lead: summary::paragraphs(data),
        warnings: data.warnings.clone(),
        sections: vec![
            scores::result(data),
            figures::presses(data),
            figures::peaks(data),
            figures::places(data),
            scores::where_it_errs(data),
            scores::recordings(data),
            scores::variants(data),
            evidence::training(data),
            evidence::bench(data),
            evidence::alignment(data),
            evidence::simulation(data),
            evidence::sensor(data),
            evidence::making_of(data),
        ],
        is_sheet: false,
    }
}

fn section(id: &'static str, title: &'static str, blocks: Vec<Block>) -> Section {
    Section { id, title, blocks }
}

fn figure(scene: Scene, badge: impl Into<Option<Badge>>, caption: impl Into<String>) -> Figure {
    Figure {
        scene,
        badge: badge.into(),
        caption: caption.into(),
        table: None,
    }
}

fn words(text: impl Into<String>) -> Cell {
    Cell::Words(text.into())
}

fn percent_cell(value: f64) -> Cell {
    Cell::Number(percent(value))
}

fn head<const N: usize>(names: [&str; N]) -> Vec<String> {
    names.map(str::to_owned).to_vec()
}

/// An error in %, kept on one line, with three significant digits or so.
fn percent(value: f64) -> String {
    if !value.is_finite() {
        return "–".into();
    }
    let decimals = if value.abs() < 9.995 { 2 } else { 1 };
    format!("{}\u{a0}%", fixed(value, decimals))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn percentages_keep_their_digits() {
        assert_eq!(percent(1.274), "1.27\u{a0}%");
        assert_eq!(percent(12.34), "12.3\u{a0}%");
        assert_eq!(percent(f64::NAN), "–");
    }
}
