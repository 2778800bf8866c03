//! Whether a fast gel tells contacts that it was not taught from those that it was.

use std::collections::BTreeMap;

use serde::{Deserialize, Serialize};
use twintac_fast::{Body, FastGel, FastReader, Lesson};
use twintac_shape::{Pose, Shape, ShapeError, Surfaces};
use twintac_teach::{Strange, TeachError, Teacher};

/// Strange presses of each kind.
const N_OF_KIND: u64 = 40;

/// How well contacts unlike all that was taught are told from presses like lessons.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Told {
    /// Part of the moments of presses like lessons whose novelty is above 1, %.
    pub familiar_flagged_percent: f64,
    /// The same of each kind of strange contact.
    pub flagged_percent: BTreeMap<String, f64>,
    /// How often a strange contact has a higher novelty than a familiar one, %: the area under the receiver operating characteristic.
    pub auroc_percent: BTreeMap<String, f64>,
    /// The same for all kinds together.
    pub overall_auroc_percent: f64,
}

impl Told {
    /// Judges on presses that were not taught.
    ///
    /// # Errors
    /// A shape that can't be.
    pub(super) fn of(gel: &FastGel, teacher: &Teacher, familiar: &[Lesson], seed: u64) -> Result<Self, TeachError> {
        let mut reader = gel.reader();
        let mut known = Vec::new();
        for press in familiar {
            let poses = press.frames.iter().map(|frame| frame.gel_from_indenter);
            known.extend(novelties(&mut reader, &press.shape, poses)?);
        }
        known.sort_by(f32::total_cmp);
        let (mut flagged_percent, mut auroc_percent) = (BTreeMap::new(), BTreeMap::new());
        let mut all = Vec::new();
        for kind in Strange::ALL {
            let mut strange = Vec::new();
            for number in 0..N_OF_KIND {
                let (shape, poses) = teacher.strange(kind, seed, number)?;
                strange.extend(novelties(&mut reader, &shape, poses.into_iter())?);
            }
            flagged_percent.insert(kind.name().to_owned(), flagged(&strange));
            auroc_percent.insert(kind.name().to_owned(), auroc(&known, &strange));
            all.extend(strange);
        }
        Ok(Self {
            familiar_flagged_percent: flagged(&known),
            flagged_percent,
            auroc_percent,
            overall_auroc_percent: auroc(&known, &all),
        })
    }
}

/// Of the moments at which the shape touches.
fn novelties(
    reader: &mut FastReader,
    shape: &Shape,
    poses: impl Iterator<Item = Pose>,
) -> Result<Vec<f32>, ShapeError> {
    let body = Body::new(shape, &Surfaces::new())?;
    let novelties = poses.map(|pose| reader.novelty(&[(&body, pose)]));
    Ok(novelties.filter(|novelty| *novelty > 0.0).collect())
}

fn flagged(novelties: &[f32]) -> f64 {
    let n = novelties.iter().filter(|novelty| **novelty > 1.0).count();
    100.0 * n as f64 / novelties.len().max(1) as f64
}

/// `known` in increasing order.
fn auroc(known: &[f32], strange: &[f32]) -> f64 {
    let below = |novelty: &f32| {
        let less = known.partition_point(|known| known < novelty);
        let not_more = known.partition_point(|known| known <= novelty);
        0.5 * (less + not_more) as f64 / known.len().max(1) as f64
    };
    100.0 * strange.iter().map(below).sum::<f64>() / strange.len().max(1) as f64
}
