//! Evaluation of the OOD score: does the surrogate detect contacts that it was not trained for?

use std::collections::BTreeMap;

use digitac::area_under_curve;
use serde::{Deserialize, Serialize};
use twintac_fast::{Body, FastGel, FastReader, GroupErrors, Lesson};
use twintac_shape::{ShapeError, Surfaces};
use twintac_teach::Strange;
use twintac_work::WorkError;

use crate::presses::{PressKind, Solved};

/// How well out-of-distribution (OOD) contacts are detected, against held-out presses like those of
/// training.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Told {
    /// Fraction of the frames of held-out presses whose OOD score is above 1, %: false positives.
    /// `None` without such frames.
    pub familiar_flagged_percent: Option<f64>,
    /// Each kind of OOD contact.
    pub kinds: BTreeMap<String, ToldKind>,
    /// Area under the receiver operating characteristic (AUROC) of all kinds together, %: the
    /// probability that an OOD frame has a higher score than a held-out one. `None` without OOD
    /// frames.
    pub auroc_percent: Option<f64>,
}

/// How well one kind is detected. A field is `None` if no frame is of that kind.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct ToldKind {
    /// Fraction of the frames whose OOD score is above 1, %.
    pub flagged_percent: Option<f64>,
    /// AUROC against held-out presses, %.
    pub auroc_percent: Option<f64>,
    /// Errors of pressures and force on these frames.
    pub errors: Option<GroupErrors>,
}

/// Out-of-distribution presses, `n_of_kind` of each kind.
pub(super) fn strange_presses(
    solved: &Solved<'_>,
    n_of_kind: u64,
) -> Result<Vec<(Strange, Vec<Lesson>)>, WorkError> {
    let of_kind = |kind: Strange| Ok((kind, solved.presses(PressKind::Strange(kind), n_of_kind)?));
    Strange::ALL.into_iter().map(of_kind).collect()
}

impl Told {
    /// Evaluates the OOD score on held-out and on OOD presses.
    ///
    /// # Errors
    /// An impossible shape.
    pub(super) fn of(
        gel: &FastGel,
        familiar: &[Lesson],
        strange: &[(Strange, Vec<Lesson>)],
    ) -> Result<Self, ShapeError> {
        let mut reader = gel.reader();
        let known = novelties(&mut reader, familiar)?;
        let auroc_percent = |strange: &[f64]| area_under_curve(&known, strange).map(|area| 100.0 * area);
        let (mut kinds, mut all) = (BTreeMap::new(), Vec::new());
        for (kind, presses) in strange {
            let novelties = novelties(&mut reader, presses)?;
            let told = ToldKind {
                flagged_percent: flagged(&novelties),
                auroc_percent: auroc_percent(&novelties),
                errors: gel.judge(presses, &Surfaces::new())?.overall,
            };
            kinds.insert(kind.name().to_owned(), told);
            all.extend(novelties);
        }
        Ok(Self {
            familiar_flagged_percent: flagged(&known),
            kinds,
            auroc_percent: auroc_percent(&all),
        })
    }
}

/// The OOD scores of all frames.
fn novelties(reader: &mut FastReader, presses: &[Lesson]) -> Result<Vec<f64>, ShapeError> {
    let mut all = Vec::new();
    for press in presses {
        let body = Body::new(&press.shape, &Surfaces::new())?;
        let frames = press.frames.iter();
        all.extend(frames.map(|frame| f64::from(reader.ood_score(&[(&body, frame.gel_from_indenter)]))));
    }
    Ok(all)
}

fn flagged(novelties: &[f64]) -> Option<f64> {
    let n = novelties.iter().filter(|ood_score| **ood_score > 1.0).count();
    (!novelties.is_empty()).then(|| 100.0 * n as f64 / novelties.len() as f64)
}
