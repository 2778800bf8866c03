//! The result in plain words, at the top of the page.

use twintac_plot::page::{Paragraph, Span};
use twintac_recording::Provenance;

use super::parts::{badge, percent};
use crate::{PAPER_ERROR_PERCENT, TwinReport};

/// The result, and what to compare it with.
pub(super) fn paragraphs(report: &TwinReport<'_>) -> Vec<Paragraph> {
    let (words, badge) = (Span::Words, |source| Span::Badge(badge(source)));
    let paper = percent(PAPER_ERROR_PERCENT);
    vec![
        Paragraph(vec![words(result(report)), badge(report.provenance)]),
        Paragraph(vec![
            words(comparison(report)),
            badge(report.provenance),
            words(format!("The paper reports {paper}")),
            badge(Provenance::Real),
            words("for its own sensor and protocol, so the two figures cannot be compared directly.".into()),
        ]),
    ]
}

fn result(report: &TwinReport<'_>) -> String {
    let presses = match report.evaluation.presses.len() {
        1 => "1 held-out press".to_owned(),
        count => format!("{count} held-out presses"),
    };
    let source = match report.provenance {
        Provenance::Real => "real data",
        Provenance::Emulated => "emulated data, which says nothing about a physical sensor",
        Provenance::Simulated => "simulated data, which says nothing about a physical sensor",
    };
    let Some(error) = report.evaluation.twin.overall.nearest_in_contact.percent else {
        return format!("No error could be computed for the {presses} ({source}).");
    };
    let error = percent(error);
    format!("The twin predicts the nearest taxel’s reading on {presses} with {error} error ({source}).")
}

fn comparison(report: &TwinReport<'_>) -> String {
    let evaluation = report.evaluation;
    let mut text = format!(
        "Over all taxels and all frames the error is {}. Simpler predictors of the same readings: zero {}",
        percent(evaluation.twin.overall.all.percent),
        percent(evaluation.zero.overall.nearest_in_contact.percent)
    );
    if let Some(polynomial) = &evaluation.polynomial {
        text += &format!(
            ", static polynomial {}",
            percent(polynomial.overall.nearest_in_contact.percent)
        );
    }
    if let Some(kernel) = &evaluation.kernel {
        text += &format!(
            ", parametric baseline {}",
            percent(kernel.overall.nearest_in_contact.percent)
        );
    }
    text += ".";
    if let Some(sure) = report.certainty {
        text += &format!(
            " Of the readings in contact, {} lie within the twin's 90 % intervals.",
            percent(sure.covered_in_contact_percent)
        );
    }
    if let Some(repeatability) = report.repeatability {
        text += &format!(
            " Two presses with the same location, depth and speed differ by {}.",
            percent(repeatability.errors.nearest_in_contact.percent)
        );
    }
    text
}

/// What the reader must know before trusting a number.
pub(super) fn warnings(report: &TwinReport<'_>) -> Vec<String> {
    let mut warnings = Vec::new();
    if report.provenance == Provenance::Emulated {
        warnings.push("The sensor behind these numbers is emulated: they say how well the method works, not how well a sensor does.".into());
    }
    for taxel in &report.sensor.taxels {
        if let Some(why) = &taxel.doubtful {
            warnings.push(format!(
                "Taxel {} is left out of headline figures: {why}.",
                taxel.name
            ));
        }
    }
    let n_frames = report.evaluation.twin.n_frames_not_simulated;
    if n_frames > 0 {
        warnings.push(format!(
            "{n_frames} frames are deeper than the simulation reached; the last simulated pressures are used for them."
        ));
    }
    warnings.extend(report.bench.doubts.iter().cloned());
    warnings
}
