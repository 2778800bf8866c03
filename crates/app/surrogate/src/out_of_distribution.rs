//! Evaluation of the OOD score: does the surrogate detect contacts that it was not trained for?

use std::collections::BTreeMap;

use digitac::area_under_curve;
use serde::{Deserialize, Serialize};
use twintac_fast::{Body, FastGel, FastReader, FemPress, GroupErrors};
use twintac_fem_presses::OodKind;
use twintac_shape::{ShapeError, Surfaces};
use twintac_work::WorkError;

use crate::presses::{PressKind, Solved};

/// How well out-of-distribution (OOD) contacts are detected, against held-out presses like those of
/// training.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct OodEvaluation {
    /// Fraction of the frames of held-out presses whose OOD score is above 1, %: false positives.
    /// `None` without such frames.
    #[serde(alias = "familiar_flagged_percent")]
    pub in_distribution_flagged_percent: Option<f64>,
    /// Each kind of OOD contact.
    pub kinds: BTreeMap<String, OodKindEvaluation>,
    /// Area under the receiver operating characteristic (AUROC) of all kinds together, %: the
    /// probability that an OOD frame has a higher score than a held-out one. `None` without OOD
    /// frames.
    pub auroc_percent: Option<f64>,
}

/// How well one kind is detected. A field is `None` if no frame is of that kind.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct OodKindEvaluation {
    /// Fraction of the frames whose OOD score is above 1, %.
    pub flagged_percent: Option<f64>,
    /// AUROC against held-out presses, %.
    pub auroc_percent: Option<f64>,
    /// Errors of pressures and force on these frames.
    pub errors: Option<GroupErrors>,
}

/// Out-of-distribution presses, `n_of_kind` of each kind.
pub(super) fn ood_presses(
    solved: &Solved<'_>,
    n_of_kind: u64,
) -> Result<Vec<(OodKind, Vec<FemPress>)>, WorkError> {
    let of_kind = |kind: OodKind| {
        Ok((
            kind,
            solved.presses(PressKind::OutOfDistribution(kind), n_of_kind)?,
        ))
    };
    OodKind::ALL.into_iter().map(of_kind).collect()
}

impl OodEvaluation {
    /// Evaluates the OOD score on held-out and on OOD presses.
    ///
    /// # Errors
    /// An impossible shape.
    pub(super) fn of(
        gel: &FastGel,
        held_out: &[FemPress],
        ood: &[(OodKind, Vec<FemPress>)],
    ) -> Result<Self, ShapeError> {
        let mut reader = gel.reader();
        let known = ood_scores(&mut reader, held_out)?;
        let auroc_percent = |ood: &[f64]| area_under_curve(&known, ood).map(|area| 100.0 * area);
        let (mut kinds, mut all) = (BTreeMap::new(), Vec::new());
        for (kind, presses) in ood {
            let ood_scores = ood_scores(&mut reader, presses)?;
            let evaluation = OodKindEvaluation {
                flagged_percent: flagged(&ood_scores),
                auroc_percent: auroc_percent(&ood_scores),
                errors: gel.evaluate(presses, &Surfaces::new())?.overall,
            };
            kinds.insert(kind.name().to_owned(), evaluation);
            all.extend(ood_scores);
        }
        Ok(Self {
            in_distribution_flagged_percent: flagged(&known),
            kinds,
            auroc_percent: auroc_percent(&all),
        })
    }
}

/// The OOD scores of all frames.
fn ood_scores(reader: &mut FastReader, presses: &[FemPress]) -> Result<Vec<f64>, ShapeError> {
    let mut all = Vec::new();
    for press in presses {
        let body = Body::new(&press.shape, &Surfaces::new())?;
        let frames = press.frames.iter();
        all.extend(frames.map(|frame| f64::from(reader.ood_score(&[(&body, frame.gel_from_indenter)]))));
    }
    Ok(all)
}

fn flagged(ood_scores: &[f64]) -> Option<f64> {
    let n = ood_scores.iter().filter(|ood_score| **ood_score > 1.0).count();
    (!ood_scores.is_empty()).then(|| 100.0 * n as f64 / ood_scores.len() as f64)
}
