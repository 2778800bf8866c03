//! The calibration of the test setup.

use digitac::Estimate;
use twintac_plot::page::{Block, Cell, Row, Table};
use twintac_plot::{Bar, Bars, Ink, fixed, short};

use super::parts::{badge, figure, head, words};
use crate::TwinReport;

pub(super) fn blocks(report: &TwinReport<'_>) -> Vec<Block> {
    let bench = report.bench;
    let row = |name: String, estimate: &Estimate, unit: &str| -> Row {
        let (value, half) = (short(estimate.value), short(estimate.uncertainty));
        let value = Cell::Number(format!("{value} ± {half} {unit}"));
        vec![words(name), value, Cell::Badge(badge(report.provenance))].into()
    };
    let radius = bench.tip_radius_mm.iter();
    let stiffness = bench.stiffness.iter();
    let offsets = bench.contact_offset_mm.iter();
    let rows = radius
        .map(|radius| row("tip radius".into(), radius, "mm"))
        .chain(stiffness.map(|part| row("stiffness over the described one".into(), part, "")))
        .chain(offsets.map(|(file, offset)| row(format!("contact height, {file}"), offset, "mm")));
    let table = Table {
        caption: "Fitted quantities".into(),
        head: head(["quantity", "value", "source"]),
        rows: rows.collect(),
    };
    let gains = bench.gains.iter().map(|gains| {
        let taxels = report.evaluation.taxels.iter().zip(&gains.gain);
        let bars = taxels.map(|(taxel, gain)| Bar {
            name: taxel.clone(),
            value: *gain,
            uncertainty: None,
            text: fixed(*gain, 2),
            ink: Ink::Series(0),
        });
        let chart = Bars {
            title: "Gain of each taxel".into(),
            x_label: "measured over simulated pressure".into(),
            bars: bars.collect(),
        };
        figure(chart.scene(), report.provenance, "One gain for each taxel.")
    });
    vec![Block::Figures(gains.collect()), Block::Table(table)]
}
