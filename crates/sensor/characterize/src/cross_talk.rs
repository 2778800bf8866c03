//! Cross-talk: the readings of the other taxels while one taxel is pressed.
//!
//! It is the ratio of each taxel's reading to that of the pressed taxel, at the same force and the
//! same time, in slow loadings. In a gel most of it is no fault, because a load spreads. Pressure
//! maps between taxels rely on it.

use serde::Serialize;

use crate::recorded::{Recorded, above};
use crate::statistics::{between, binned, mean};
use crate::{CharacterizeOptions, Finding};

/// Number of steps of force in which readings are averaged.
const BINS: usize = 25;

/// Readings of all taxels while each one is pressed.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct CrossTalk {
    /// The force of the comparison, N: the largest that all slow presses above taxels reach.
    pub force_n: f64,
    /// Names of the pressed taxels: the rows.
    pub pressed: Vec<String>,
    /// Names of the taxels: the columns.
    pub taxels: Vec<String>,
    /// Reading divided by that of the pressed taxel, %, indexed by row, then column. Mean over the
    /// presses in which both have a reading; `None` if there is no such press.
    pub percent: Vec<Vec<Option<f64>>>,
    /// The largest of these without the pressed taxels themselves, %.
    pub largest_percent: f64,
}

pub(crate) fn cross_talk(
    recorded: &[Recorded<'_>],
    taxels: &[String],
    options: &CharacterizeOptions,
) -> Finding<CrossTalk> {
    let slow = |taxel: usize| above(recorded, taxel).filter(|press| press.is_slow(options));
    let peaks_n = (0..taxels.len()).flat_map(slow).map(Recorded::peak_n);
    let force_n = peaks_n.fold(f64::INFINITY, f64::min) * (1.0 - 1.0 / BINS as f64);
    let (mut pressed, mut percent) = (Vec::new(), Vec::new());
    for (taxel, name) in taxels.iter().enumerate() {
        let rows: Vec<Vec<Option<f64>>> = slow(taxel)
            .filter_map(|press| row(press, taxel, taxels.len(), force_n))
            .collect();
        if rows.is_empty() {
            continue;
        }
        let column = |other: usize| mean(&rows.iter().filter_map(|row| row[other]).collect::<Vec<f64>>());
        pressed.push(name.clone());
        percent.push((0..taxels.len()).map(column).collect::<Vec<_>>());
    }
    let others = percent.iter().zip(&pressed).flat_map(|(row, name)| {
        row.iter()
            .zip(taxels)
            .filter(move |(_, other)| *other != name)
            .filter_map(|(percent, _)| *percent)
    });
    let Some(largest_percent) = others.reduce(f64::max) else {
        let why = "slow presses above a taxel are required, and readings of another taxel at the same time";
        return Finding::NotGiven(why.to_owned());
    };
    Finding::Found(CrossTalk {
        force_n,
        pressed,
        taxels: taxels.to_vec(),
        percent,
        largest_percent,
    })
}

/// Each taxel's reading divided by that of the pressed one, %. `None` if the pressed one has no
/// reading.
fn row(press: &Recorded<'_>, taxel: usize, n_taxels: usize, force_n: f64) -> Option<Vec<Option<f64>>> {
    let reading_kpa = |other: usize| {
        let response = binned(&press.points(other, &press.up()), press.peak_n(), BINS);
        between(&response, force_n)
    };
    let pressed_kpa = reading_kpa(taxel)?;
    let percent = |other: usize| Some(100.0 * reading_kpa(other)? / pressed_kpa);
    Some((0..n_taxels).map(percent).collect())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::synthetic::{Shape, all, press};

    #[test]
    fn the_neighbour_reads_its_quarter() {
        let presses = [press(&Shape::default())];
        let finding = cross_talk(
            &all(&presses),
            &["a".to_owned(), "b".to_owned()],
            &CharacterizeOptions::default(),
        );
        let found = finding.found().unwrap();
        assert_eq!(found.pressed, ["a"]);
        let percent = found.percent[0].iter().map(|percent| percent.unwrap());
        assert!(
            percent
                .zip([100.0, 25.0])
                .all(|(found, known)| (found - known).abs() < 1e-9)
        );
        assert!((found.largest_percent - 25.0).abs() < 1e-9);
    }

    #[test]
    fn a_taxel_that_does_not_read_has_none_and_takes_none_from_the_others() {
        let mut silent = press(&Shape::default());
        silent.valid.iter_mut().for_each(|valid| valid[1] = false);
        let names = ["a".to_owned(), "b".to_owned()];
        let talk = |presses: &[twintac_recording::Press]| {
            cross_talk(&all(presses), &names, &CharacterizeOptions::default())
        };
        let both = talk(&[press(&Shape::default()), silent.clone()]);
        assert!(
            (both.found().unwrap().largest_percent - 25.0).abs() < 1e-9,
            "{both:?}"
        );
        assert!(talk(&[silent]).why_not().unwrap().contains("at the same time"));
    }
}
