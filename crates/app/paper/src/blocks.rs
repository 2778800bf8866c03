//! Parts of the page of the paper's experiments.

use twintac_plot::page::{Badge, Cell, Figure, Table};
use twintac_plot::{Scene, fixed};
use twintac_recording::Provenance;

pub(super) fn badge(provenance: Provenance) -> Badge {
    Badge(provenance.to_string())
}

pub(super) fn percent(value: f64) -> String {
    format!("{} %", fixed(value, 2))
}

pub(super) fn words(text: impl Into<String>) -> Cell {
    Cell::Words(text.into())
}

pub(super) fn figure(scene: Scene, provenance: Provenance, caption: &str, table: Option<Table>) -> Figure {
    Figure {
        scene,
        badge: Some(badge(provenance)),
        caption: caption.into(),
        table,
    }
}
