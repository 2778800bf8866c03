//! The result in plain words, at the top of the page.

use twintac_plot::page::{Paragraph, Span};

use super::percent;
use crate::data::{Headline, PAPER_ERROR_PERCENT, Provenance, ReferenceKind, ReportData};

/// The result, and what to compare it with.
pub(super) fn paragraphs(data: &ReportData) -> Vec<Paragraph> {
    let Some(headline) = &data.headline else {
        return Vec::new();
    };
    let (words, badge) = (Span::Words, |source: Provenance| Span::Badge(source.badge()));
    let paper = percent(PAPER_ERROR_PERCENT);
    vec![
        Paragraph(vec![
            words(result(headline, data.provenance)),
            badge(data.provenance),
        ]),
        Paragraph(vec![
            words(comparison(headline)),
            badge(data.provenance),
            words(format!("The paper reports {paper}")),
            badge(Provenance::Real),
            words("for its own sensor and protocol, so the two figures cannot be compared directly.".into()),
        ]),
    ]
}

fn result(headline: &Headline, provenance: Provenance) -> String {
    let presses = match headline.presses {
        1 => "1 press that it never saw".to_owned(),
        count => format!("{count} presses that it never saw"),
    };
    let source = match provenance {
        Provenance::Real => "real data",
        Provenance::Emulated => "emulated data, which says nothing about a physical sensor",
        Provenance::Simulated => "simulated data, which says nothing about a physical sensor",
    };
    if !headline.nearest_in_contact_percent.is_finite() {
        return format!("No error could be computed for the {presses} ({source}).");
    }
    let error = percent(headline.nearest_in_contact_percent);
    format!("The twin predicts the nearest taxel’s reading on {presses} with {error} error ({source}).")
}

fn comparison(headline: &Headline) -> String {
    let mut sentences = Vec::new();
    if headline.all_percent.is_finite() {
        sentences.push(format!(
            "Over all taxels and all frames the error is {}.",
            percent(headline.all_percent)
        ));
    }
    let known = |kind: ReferenceKind| {
        headline.references.iter().filter(move |reference| {
            reference.kind == kind && reference.nearest_in_contact_percent.is_finite()
        })
    };
    let baselines: Vec<String> = known(ReferenceKind::Baseline)
        .map(|reference| {
            format!(
                "{} {}",
                reference.name,
                percent(reference.nearest_in_contact_percent)
            )
        })
        .collect();
    if !baselines.is_empty() {
        sentences.push(format!(
            "Simpler predictors of the same readings: {}.",
            baselines.join(", ")
        ));
    }
    for floor in known(ReferenceKind::Floor) {
        sentences.push(format!(
            "The sensor repeats itself to within {}: the floor for any twin.",
            percent(floor.nearest_in_contact_percent)
        ));
    }
    sentences.join(" ")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_lead_says_who_how_many_and_how_well() {
        let headline = Headline {
            presses: 12,
            nearest_in_contact_percent: 1.3,
            ..Headline::default()
        };
        assert_eq!(
            result(&headline, Provenance::Real),
            "The twin predicts the nearest taxel’s reading on 12 presses that it never saw with 1.30\u{a0}% error (real data)."
        );
        assert!(result(&headline, Provenance::Emulated).contains("nothing about a physical sensor"));
        let unknown = Headline {
            nearest_in_contact_percent: f64::NAN,
            ..headline
        };
        assert!(result(&unknown, Provenance::Real).starts_with("No error could be computed"));
    }
}
