//! The headline with its comparisons, and predictions against measurements.

use digitac::Errors;
use twintac_plot::page::{Block, Card, Cell, Fact, Row, Table};
use twintac_plot::{Density, Ink, Scene};
use twintac_recording::Provenance;

use super::parts::{ALL, NEAREST, badge, bar, errors, figure, head, percent, percent_cell, usable, words};
use crate::{PAPER_ERROR_PERCENT, TwinReport};

/// Largest number of readings in the scatter plot.
const MOST_READINGS: usize = 20_000;

pub(super) fn blocks(report: &TwinReport<'_>) -> Vec<Block> {
    let repeated = match report.repeatability {
        Some(_) => " Green: the sensor's own repeatability.",
        None => "",
    };
    let caption = format!(
        "Shorter is better. Grey: simpler predictors.{repeated} Blue: the figure that the paper reports for \
         another sensor and protocol (real)."
    );
    let mut bars = figure(comparison(report), report.provenance, &caption);
    bars.table = Some(table(report));
    let caption = "Every held-out reading. On the dashed line the twin equals the sensor; the shade shows \
                   the number of readings, on a logarithmic scale.";
    let agreement = figure(density(report), report.provenance, caption);
    vec![
        Block::Cards(cards(report)),
        Block::Text(report.evaluation.twin.definition.as_str().into()),
        Block::Figures(vec![bars, agreement]),
    ]
}

fn cards(report: &TwinReport<'_>) -> Vec<Card> {
    let card = |value: String, name: &str, source: Provenance| Card {
        fact: Fact::new(name, value),
        badge: badge(source),
    };
    let (own, source) = (&report.evaluation.twin.overall, report.provenance);
    let presses = report.evaluation.presses.len().to_string();
    let paper = percent(PAPER_ERROR_PERCENT);
    let mut cards = vec![
        card(percent(own.nearest_in_contact.percent), NEAREST, source),
        card(percent(own.all.percent), ALL, source),
        card(presses, "held-out presses", source),
        card(paper, "the paper, its own sensor", Provenance::Real),
    ];
    if let Some(sure) = report.certainty {
        let covered = percent(sure.covered_percent);
        cards.insert(2, card(covered, "readings within their 90 % interval", source));
        let width = percent(sure.mean_width_in_contact_percent);
        cards.insert(3, card(width, "mean width of these intervals in contact", source));
    }
    cards
}

/// The errors of the twin and those that it is compared with, by the same measure and on the same
/// presses.
fn compared<'a>(report: &TwinReport<'a>) -> Vec<(&'static str, &'a Errors, Ink)> {
    let evaluation = report.evaluation;
    let polynomial = evaluation.polynomial.as_ref();
    let polynomial = polynomial.map(|score| ("static polynomial", &score.overall, Ink::Sensor));
    let kernel = evaluation.kernel.as_ref();
    let kernel = kernel.map(|score| ("parametric baseline", &score.overall, Ink::Sensor));
    let repeats = report
        .repeatability
        .map(|found| ("repeated press", &found.errors, Ink::Series(2)));
    [
        Some(("this twin", &evaluation.twin.overall, Ink::Twin)),
        Some(("zero", &evaluation.zero.overall, Ink::Sensor)),
        polynomial,
        kernel,
        repeats,
    ]
    .into_iter()
    .flatten()
    .collect()
}

fn comparison(report: &TwinReport<'_>) -> Scene {
    let bars = compared(report)
        .into_iter()
        .map(|(name, found, ink)| bar(name, found.nearest_in_contact.percent, ink));
    let paper = bar("paper (its own sensor)", PAPER_ERROR_PERCENT, Ink::Series(0));
    errors(&format!("Error, {NEAREST}"), bars.chain([paper]))
}

fn table(report: &TwinReport<'_>) -> Table {
    let row = |name: &str, nearest: Option<f64>, all: Option<f64>, source: Provenance| -> Row {
        let source = Cell::Badge(badge(source));
        vec![words(name), percent_cell(nearest), percent_cell(all), source].into()
    };
    let mut rows: Vec<Row> = compared(report)
        .into_iter()
        .map(|(name, found, _)| {
            let (nearest, all) = (found.nearest_in_contact.percent, found.all.percent);
            row(name, nearest, all, report.provenance)
        })
        .collect();
    rows[0].is_chosen = true;
    // The paper does not say which frames and taxels its mean is over.
    rows.push(row(
        "paper",
        Some(PAPER_ERROR_PERCENT),
        Some(f64::NAN),
        Provenance::Real,
    ));
    Table {
        caption: "The same in numbers".into(),
        head: head(["", "nearest", "all", "source"]),
        rows,
    }
}

/// Usable readings, measured and predicted, thinned evenly.
fn density(report: &TwinReport<'_>) -> Scene {
    let points: Vec<[f64; 2]> = usable(report.evaluation).map(|(_, pair)| pair).collect();
    let step = points.len().div_ceil(MOST_READINGS).max(1);
    Density {
        title: "Twin against sensor".into(),
        x_label: "sensor, kPa".into(),
        y_label: "twin, kPa".into(),
        points: points.into_iter().step_by(step).collect(),
    }
    .scene()
}
