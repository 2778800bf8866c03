//! Whether a fast gel tells contacts that it was not taught from those that it was.

use std::collections::BTreeMap;

use digitac::area_under_curve;
use serde::{Deserialize, Serialize};
use twintac_fast::{Body, FastGel, FastReader, GroupErrors, Lesson};
use twintac_shape::{ShapeError, Surfaces};
use twintac_teach::Strange;
use twintac_work::WorkError;

use crate::presses::{PressKind, Solved};

/// How well contacts unlike all that was taught are told from presses like lessons.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Told {
    /// Part of the moments of presses like lessons whose novelty is above 1, %; `None` without any.
    pub familiar_flagged_percent: Option<f64>,
    /// Each kind of strange contact.
    pub kinds: BTreeMap<String, ToldKind>,
    /// How often any of them has a higher novelty than a familiar one, %: the area under the
    /// receiver operating characteristic. `None` without any.
    pub auroc_percent: Option<f64>,
}

/// How well one kind is told; `None` where no moment is of it.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct ToldKind {
    /// Part of the moments whose novelty is above 1, %.
    pub flagged_percent: Option<f64>,
    /// How often such a contact has a higher novelty than a familiar one, %.
    pub auroc_percent: Option<f64>,
    /// Errors there.
    pub errors: Option<GroupErrors>,
}

/// Presses unlike all that is taught, kind by kind; so many of each.
pub(super) fn strange_presses(
    solved: &Solved<'_>,
    n_of_kind: u64,
) -> Result<Vec<(Strange, Vec<Lesson>)>, WorkError> {
    let of_kind = |kind: Strange| Ok((kind, solved.presses(PressKind::Strange(kind), n_of_kind)?));
    Strange::ALL.into_iter().map(of_kind).collect()
}

impl Told {
    /// Judges on presses that were not taught.
    ///
    /// # Errors
    /// A shape that can't be.
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

/// Of all moments.
fn novelties(reader: &mut FastReader, presses: &[Lesson]) -> Result<Vec<f64>, ShapeError> {
    let mut all = Vec::new();
    for press in presses {
        let body = Body::new(&press.shape, &Surfaces::new())?;
        let frames = press.frames.iter();
        all.extend(frames.map(|frame| f64::from(reader.novelty(&[(&body, frame.gel_from_indenter)]))));
    }
    Ok(all)
}

fn flagged(novelties: &[f64]) -> Option<f64> {
    let n = novelties.iter().filter(|novelty| **novelty > 1.0).count();
    (!novelties.is_empty()).then(|| 100.0 * n as f64 / novelties.len() as f64)
}
