//! Sections of errors: the headline, where the twin errs, recordings and variants.

use twintac_plot::page::{Block, Card, Cell, Fact, Row, Section, Table};
use twintac_plot::{Bar, Bars, Density, Ink, Scene, fixed, short};

use super::{figure, head, percent, percent_cell, section, words};
use crate::data::{
    Agreement, FileError, Headline, PAPER_ERROR_PERCENT, Provenance, ReferenceKind, ReportData, TaxelError,
    Variant,
};

const NEAREST: &str = "nearest taxel in contact";
const ALL: &str = "all taxels, all frames";

/// The headline with what it is compared to, and predictions against measurements.
pub(super) fn result(data: &ReportData) -> Section {
    let (mut blocks, mut pictures) = (Vec::new(), Vec::new());
    if let Some(headline) = &data.headline {
        blocks.push(Block::Cards(cards(headline, data.provenance)));
        blocks.push(Block::Text(headline.definition.as_str().into()));
        let caption = "Shorter is better. Grey: simpler predictors. Green: the sensor's own repeatability. \
                       Blue: the figure that the paper reports for another sensor and protocol (real).";
        let mut comparison = figure(comparison(headline), data.provenance.badge(), caption);
        comparison.table = Some(references(headline, data.provenance));
        pictures.push(comparison);
    }
    if let Some(agreement) = &data.agreement {
        let caption = "Every held-out reading. On the dashed line the twin equals the sensor; the shade counts \
                       readings logarithmically.";
        pictures.push(figure(density(agreement), data.provenance.badge(), caption));
    }
    blocks.push(Block::Figures(pictures));
    section("result", "Result", blocks)
}

fn cards(headline: &Headline, source: Provenance) -> Vec<Card> {
    let card = |value: String, name: &str, source: Provenance| Card {
        fact: Fact::new(name, value),
        badge: source.badge(),
    };
    vec![
        card(percent(headline.nearest_in_contact_percent), NEAREST, source),
        card(percent(headline.all_percent), ALL, source),
        card(headline.presses.to_string(), "held-out presses", source),
        card(
            percent(PAPER_ERROR_PERCENT),
            "the paper, its own sensor",
            Provenance::Real,
        ),
    ]
}

/// The twin's error beside those of its references, as bars.
fn comparison(headline: &Headline) -> Scene {
    let own = bar("this twin", headline.nearest_in_contact_percent, Ink::Twin);
    let others = headline.references.iter().map(|reference| {
        let ink = match reference.kind {
            ReferenceKind::Baseline => Ink::Sensor,
            ReferenceKind::Floor => Ink::Series(2),
        };
        bar(&reference.name, reference.nearest_in_contact_percent, ink)
    });
    let paper = bar("paper (its own sensor)", PAPER_ERROR_PERCENT, Ink::Series(0));
    let bars = std::iter::once(own).chain(others).chain([paper]);
    errors(&format!("Error, {NEAREST}"), bars)
}

fn density(agreement: &Agreement) -> Scene {
    let pairs = agreement.measured_kpa.iter().zip(&agreement.predicted_kpa);
    Density {
        title: "Twin against sensor".into(),
        x_label: "sensor, kPa".into(),
        y_label: "twin, kPa".into(),
        points: pairs
            .map(|(&measured, &predicted)| [measured, predicted])
            .collect(),
    }
    .scene()
}

/// The twin's errors and those of its references in numbers.
fn references(headline: &Headline, source: Provenance) -> Table {
    let row = |name: &str, nearest: f64, all: f64, source: Provenance| -> Row {
        let source = Cell::Badge(source.badge());
        vec![words(name), percent_cell(nearest), percent_cell(all), source].into()
    };
    let own = Row {
        is_chosen: true,
        ..row(
            "this twin",
            headline.nearest_in_contact_percent,
            headline.all_percent,
            source,
        )
    };
    let others = headline.references.iter().map(|reference| {
        let all = reference.all_percent.unwrap_or(f64::NAN);
        row(&reference.name, reference.nearest_in_contact_percent, all, source)
    });
    // The paper does not say which frames and taxels its mean is over.
    let paper = row("paper", PAPER_ERROR_PERCENT, f64::NAN, Provenance::Real);
    Table {
        caption: "The same in numbers".into(),
        head: head(["", "nearest", "all", "source"]),
        rows: std::iter::once(own).chain(others).chain([paper]).collect(),
    }
}

/// Errors by taxel and by depth.
pub(super) fn where_it_errs(data: &ReportData) -> Section {
    let source = data.provenance.badge();
    let mut pictures = Vec::new();
    if !data.taxels.is_empty() {
        let known = data
            .taxels
            .iter()
            .filter(|taxel| taxel.nearest_in_contact_percent.is_finite());
        let bars = known.map(|taxel| bar(&taxel.name, taxel.nearest_in_contact_percent, Ink::Twin));
        let caption = "Frames in contact in which the taxel reads the most.";
        pictures.push(figure(errors("Error by taxel", bars), source.clone(), caption));
    }
    if !data.depths.is_empty() {
        let bars = data.depths.iter().map(|depth| {
            let name = format!("{}–{} mm", short(depth.from_mm), short(depth.to_mm));
            bar(&name, depth.nearest_in_contact_percent, Ink::Twin)
        });
        let frames: usize = data.depths.iter().map(|depth| depth.frames).sum();
        let caption = format!("Nearest taxel in contact, by the indenter's depth; {frames} frames.");
        pictures.push(figure(errors("Error by depth", bars), source.clone(), caption));
    }
    let row = |taxel: &TaxelError| -> Row {
        vec![
            words(&taxel.name),
            percent_cell(taxel.nearest_in_contact_percent),
            percent_cell(taxel.all_percent),
            percent_cell(taxel.bias_percent),
            words(&taxel.note),
            Cell::Badge(source.clone()),
        ]
        .into()
    };
    let table = Table {
        caption: "Errors of each taxel".into(),
        head: head(["taxel", NEAREST, ALL, "bias, twin − sensor", "note", "source"]),
        rows: data.taxels.iter().map(row).collect(),
    };
    let blocks = vec![Block::Figures(pictures), Block::Table(table)];
    section("taxels", "Where it errs", blocks)
}

/// Errors of each recording.
pub(super) fn recordings(data: &ReportData) -> Section {
    let count = |count: usize| Cell::Number(count.to_string());
    let row = |file: &FileError| -> Row {
        vec![
            words(&file.name),
            words(&file.role),
            count(file.presses),
            count(file.frames),
            Cell::Number(fixed(file.largest_kpa, 1)),
            percent_cell(file.nearest_in_contact_percent),
            percent_cell(file.all_percent),
            Cell::Badge(file.provenance.unwrap_or(data.provenance).badge()),
        ]
        .into()
    };
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
        rows: data.files.iter().map(row).collect(),
    };
    section("recordings", "Recordings", vec![Block::Table(table)])
}

/// Variants, the chosen one emphasised.
pub(super) fn variants(data: &ReportData) -> Section {
    if data.variants.is_empty() {
        return Section::default();
    }
    let bars = data.variants.iter().map(|variant| {
        let ink = if variant.chosen { Ink::Twin } else { Ink::Sensor };
        bar(&variant.name, variant.nearest_in_contact_percent, ink)
    });
    let caption = "Held-out error, nearest taxel in contact. The coloured one is the twin of this report.";
    let picture = figure(errors("Error by variant", bars), data.provenance.badge(), caption);
    let row = |variant: &Variant| Row {
        cells: vec![
            words(&variant.name),
            percent_cell(variant.validation_percent),
            percent_cell(variant.nearest_in_contact_percent),
            percent_cell(variant.all_percent),
            words(if variant.chosen { "✓ chosen" } else { "" }),
            Cell::Badge(data.provenance.badge()),
        ],
        is_chosen: variant.chosen,
    };
    let table = Table {
        caption: "Twins that were compared".into(),
        head: head(["variant", "validation", NEAREST, ALL, "", "source"]),
        rows: data.variants.iter().map(row).collect(),
    };
    let blocks = vec![Block::Figures(vec![picture]), Block::Table(table)];
    section("variants", "Variants", blocks)
}

fn errors(title: &str, bars: impl Iterator<Item = Bar>) -> Scene {
    Bars {
        title: title.into(),
        x_label: "mean absolute error, % of the largest reading".into(),
        bars: bars.collect(),
    }
    .scene()
}

fn bar(name: &str, value: f64, ink: Ink) -> Bar {
    Bar {
        name: name.into(),
        value,
        uncertainty: None,
        text: percent(value),
        ink,
    }
}
