//! Sections of errors: the headline, where the twin errs, recordings and variants.

use super::elements::{Cell, Section, cards, figure, figures, paragraph, percent, table};
use crate::color::Ink;
use crate::data::{Headline, PAPER_ERROR_PERCENT, Provenance, ReferenceKind, ReportData};
use crate::plot::{Bar, Bars, Density};

const NEAREST: &str = "nearest taxel in contact";
const ALL: &str = "all taxels, all frames";
const ERROR_AXIS: &str = "mean absolute error, % of the largest reading";

/// The headline with what it is compared to, and predictions against measurements.
pub(super) fn result(data: &ReportData) -> Option<Section> {
    let mut body = String::new();
    let mut pictures = Vec::new();
    if let Some(headline) = &data.headline {
        let source = data.provenance;
        body += &cards(&[
            (percent(headline.nearest_in_contact_percent), NEAREST, source),
            (percent(headline.all_percent), ALL, source),
            (headline.presses.to_string(), "held-out presses", source),
            (
                percent(PAPER_ERROR_PERCENT),
                "the paper, its own sensor",
                Provenance::Real,
            ),
        ]);
        body += &paragraph(&headline.definition);
        let mut bars = vec![bar("this twin", headline.nearest_in_contact_percent, Ink::Twin)];
        for reference in &headline.references {
            let ink = match reference.kind {
                ReferenceKind::Baseline => Ink::Sensor,
                ReferenceKind::Floor => Ink::Series(2),
            };
            bars.push(bar(&reference.name, reference.nearest_in_contact_percent, ink));
        }
        bars.push(bar("paper (its own sensor)", PAPER_ERROR_PERCENT, Ink::Series(0)));
        let chart = Bars {
            title: format!("Error, {NEAREST}"),
            x_label: ERROR_AXIS.into(),
            bars,
        };
        let caption = "Shorter is better. Grey: simpler predictors. Green: the sensor's own repeatability. \
                       Blue: the figure that the paper reports for another sensor and protocol (real).";
        let comparison = figure(&chart.scene(), source, caption) + &references(headline, source);
        pictures.push(format!("<div>{comparison}</div>\n"));
    }
    if let Some(agreement) = &data.agreement {
        let pairs = agreement.measured_kpa.iter().zip(&agreement.predicted_kpa);
        let chart = Density {
            title: "Twin against sensor".into(),
            x_label: "sensor, kPa".into(),
            y_label: "twin, kPa".into(),
            points: pairs
                .map(|(&measured, &predicted)| [measured, predicted])
                .collect(),
        };
        let caption = "Every held-out reading. On the dashed line the twin equals the sensor; the shade counts \
                       readings logarithmically.";
        pictures.push(figure(&chart.scene(), data.provenance, caption));
    }
    body += &figures(&pictures);
    Section::new("result", "Result", body)
}

/// The twin's errors and those of its references in numbers.
fn references(headline: &Headline, source: Provenance) -> String {
    let row = |name: &str, nearest: f64, all: f64, source: Provenance| {
        vec![
            Cell::words(name),
            Cell::percent(nearest),
            Cell::percent(all),
            Cell::Source(source),
        ]
    };
    let own = row(
        "this twin",
        headline.nearest_in_contact_percent,
        headline.all_percent,
        source,
    );
    let others = headline.references.iter().map(|reference| {
        let all = reference.all_percent.unwrap_or(f64::NAN);
        (
            false,
            row(&reference.name, reference.nearest_in_contact_percent, all, source),
        )
    });
    // The paper does not say which frames and taxels its mean is over.
    let paper = row("paper", PAPER_ERROR_PERCENT, f64::NAN, Provenance::Real);
    let rows: Vec<_> = std::iter::once((true, own))
        .chain(others)
        .chain([(false, paper)])
        .collect();
    table("The same in numbers", &["", "nearest", "all", "source"], &rows)
}

/// Errors by taxel and by depth.
pub(super) fn where_it_errs(data: &ReportData) -> Option<Section> {
    let source = data.provenance;
    let mut pictures = Vec::new();
    if !data.taxels.is_empty() {
        let bars = data
            .taxels
            .iter()
            .filter(|taxel| taxel.nearest_in_contact_percent.is_finite())
            .map(|taxel| bar(&taxel.name, taxel.nearest_in_contact_percent, Ink::Twin));
        let chart = Bars {
            title: "Error by taxel".into(),
            x_label: ERROR_AXIS.into(),
            bars: bars.collect(),
        };
        let caption = "Frames in contact in which the taxel reads the most.";
        pictures.push(figure(&chart.scene(), source, caption));
    }
    if !data.depths.is_empty() {
        let bars = data.depths.iter().map(|depth| {
            let name = format!(
                "{}–{} mm",
                crate::axis::short(depth.from_mm),
                crate::axis::short(depth.to_mm)
            );
            bar(&name, depth.nearest_in_contact_percent, Ink::Twin)
        });
        let chart = Bars {
            title: "Error by depth".into(),
            x_label: ERROR_AXIS.into(),
            bars: bars.collect(),
        };
        let frames: usize = data.depths.iter().map(|depth| depth.frames).sum();
        let caption = format!("Nearest taxel in contact, by the indenter's depth; {frames} frames.");
        pictures.push(figure(&chart.scene(), source, &caption));
    }
    let rows: Vec<_> = data
        .taxels
        .iter()
        .map(|taxel| {
            let cells = vec![
                Cell::words(&taxel.name),
                Cell::percent(taxel.nearest_in_contact_percent),
                Cell::percent(taxel.all_percent),
                Cell::percent(taxel.bias_percent),
                Cell::words(&taxel.note),
                Cell::Source(source),
            ];
            (false, cells)
        })
        .collect();
    let head = ["taxel", NEAREST, ALL, "bias, twin − sensor", "note", "source"];
    let body = figures(&pictures) + &table("Errors of each taxel", &head, &rows);
    Section::new("taxels", "Where it errs", body)
}

/// Errors of each recording.
pub(super) fn recordings(data: &ReportData) -> Option<Section> {
    let rows: Vec<_> = data
        .files
        .iter()
        .map(|file| {
            let cells = vec![
                Cell::words(&file.name),
                Cell::words(&file.role),
                Cell::count(file.presses),
                Cell::count(file.frames),
                Cell::number(file.largest_kpa, 1),
                Cell::percent(file.nearest_in_contact_percent),
                Cell::percent(file.all_percent),
                Cell::Source(file.provenance.unwrap_or(data.provenance)),
            ];
            (false, cells)
        })
        .collect();
    let head = [
        "recording",
        "used for",
        "presses",
        "frames",
        "largest reading, kPa",
        NEAREST,
        ALL,
        "source",
    ];
    Section::new(
        "recordings",
        "Recordings",
        table("Errors of each recording", &head, &rows),
    )
}

/// Variants, the chosen one emphasised.
pub(super) fn variants(data: &ReportData) -> Option<Section> {
    let mut body = String::new();
    if !data.variants.is_empty() {
        let bars = data.variants.iter().map(|variant| {
            let ink = if variant.chosen { Ink::Twin } else { Ink::Sensor };
            bar(&variant.name, variant.nearest_in_contact_percent, ink)
        });
        let chart = Bars {
            title: "Error by variant".into(),
            x_label: ERROR_AXIS.into(),
            bars: bars.collect(),
        };
        let caption =
            "Held-out error, nearest taxel in contact. The coloured one is the twin of this report.";
        body += &figures(&[figure(&chart.scene(), data.provenance, caption)]);
    }
    let rows: Vec<_> = data
        .variants
        .iter()
        .map(|variant| {
            let cells = vec![
                Cell::words(&variant.name),
                Cell::percent(variant.validation_percent),
                Cell::percent(variant.nearest_in_contact_percent),
                Cell::percent(variant.all_percent),
                Cell::words(if variant.chosen { "✓ chosen" } else { "" }),
                Cell::Source(data.provenance),
            ];
            (variant.chosen, cells)
        })
        .collect();
    let head = ["variant", "validation", NEAREST, ALL, "", "source"];
    body += &table("Twins that were compared", &head, &rows);
    Section::new("variants", "Variants", body)
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
