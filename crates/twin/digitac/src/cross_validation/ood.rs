//! Detection of held-out contacts of another kind as out of distribution.

use std::collections::BTreeMap;

use serde::{Deserialize, Serialize};

use crate::certainty::{TrainingSet, area_under_curve};
use crate::{Contact, Fold, HeldOut, PairedPress, Places};

/// How well the OOD score separates contacts of another kind from those of the kinds in the
/// training set.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct OodDetection {
    /// AUROC of the OOD score, %: the probability that a frame of the other kind has the larger
    /// score.
    pub area_percent: f64,
    /// Number of frames of the other kind: in contact, and deeper than all training presses with
    /// this indenter, or farther than one spacing from the training region, or with an indenter
    /// that is not in the training set.
    pub n_unlike: usize,
    /// Number of frames of the kinds in the training set: those of validation presses in contact,
    /// where they are not deeper than the training presses. Validation presses do not belong to the
    /// training set here.
    pub n_like: usize,
}

/// Compares the held-out presses of a division with its validation presses. `None` for divisions
/// whose held-out presses are of the kinds in the training set.
pub(super) fn ood_detection(
    fold: &Fold,
    test: &[usize],
    presses: &[PairedPress],
    places: &Places,
    contacts: &[Contact],
) -> Option<OodDetection> {
    if !matches!(fold.by, HeldOut::Depth | HeldOut::Indenter | HeldOut::Region) {
        return None;
    }
    let training_set = TrainingSet::by(presses, places, contacts, &fold.split.train);
    let mut deepest_mm: BTreeMap<&str, f64> = BTreeMap::new();
    for &press in &fold.split.train {
        let deepest = deepest_mm.entry(&presses[press].indenter).or_insert(0.0);
        *deepest = presses[press]
            .features
            .depth_mm
            .iter()
            .copied()
            .fold(*deepest, f64::max);
    }
    let place = |press: usize| contacts[places.of_press[press]].place_mm;
    let is_beyond = |press: usize| {
        (0..2).any(|axis| {
            let along = || fold.split.train.iter().map(|&press| place(press)[axis]);
            let low = along().fold(f64::INFINITY, f64::min) - training_set.spacing_mm();
            let high = along().fold(f64::NEG_INFINITY, f64::max) + training_set.spacing_mm();
            !(low..=high).contains(&place(press)[axis])
        })
    };
    let scores = |chosen: &[usize], counts: &dyn Fn(usize, f64) -> bool| -> Vec<f64> {
        let of_press = |&press: &usize| {
            let contact = &contacts[places.of_press[press]];
            let depths = presses[press].features.depth_mm.iter().copied();
            let counted = depths.filter(move |depth_mm| *depth_mm > 0.0 && counts(press, *depth_mm));
            let score = |depth_mm| training_set.ood_score(contact.place_mm, &contact.underside, depth_mm);
            counted.map(score).collect::<Vec<f64>>()
        };
        chosen.iter().flat_map(of_press).collect()
    };
    let trained_on_mm = |press: usize| deepest_mm.get(&presses[press].indenter[..]).copied();
    let is_deeper =
        |press: usize, depth_mm: f64| trained_on_mm(press).is_some_and(|deepest_mm| depth_mm > deepest_mm);
    let unlike = scores(test, &|press, depth_mm| match fold.by {
        HeldOut::Depth => is_deeper(press, depth_mm),
        HeldOut::Region => is_beyond(press),
        _ => true,
    });
    let like = scores(&fold.split.validation, &|press, depth_mm| {
        !is_deeper(press, depth_mm)
    });
    Some(OodDetection {
        area_percent: 100.0 * area_under_curve(&like, &unlike)?,
        n_unlike: unlike.len(),
        n_like: like.len(),
    })
}
