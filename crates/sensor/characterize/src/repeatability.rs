//! Repeatability: the spread of readings when the same press is repeated.
//!
//! It is the largest standard deviation, over forces, of readings at the same force, in repeated
//! slow loadings of the same location to the same depth, in % of the response at the largest force
//! that all of them reach. (IEC 61298-2 takes the same spread at each test point.)

use serde::Serialize;

use crate::recorded::{Recorded, above};
use crate::statistics::{between, binned, deviation, mean};
use crate::{CharacterizeOptions, Finding};

/// Number of steps of force in which readings are averaged.
const BINS: usize = 25;

/// Smallest number of presses that count as a repetition.
const FEWEST: usize = 3;

/// Largest distance between the deepest points of presses that count as the same, mm. Robots repeat
/// themselves only to about this, and readings are compared at the same force.
const SAME_MM: f64 = 0.1;

/// The repeatability of a taxel.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Repeatability {
    /// The taxel's name.
    pub taxel: String,
    /// Largest standard deviation at the same force, % of full scale.
    pub percent: f64,
    /// Full scale: mean response at the largest common force, kPa.
    pub full_scale_kpa: f64,
    /// Largest force that all presses reach, N.
    pub to_n: f64,
    /// Number of presses it was found from.
    pub n_presses: usize,
}

pub(crate) fn repeatability(
    recorded: &[Recorded<'_>],
    taxels: &[String],
    options: &CharacterizeOptions,
) -> Finding<Vec<Repeatability>> {
    let found = taxels.iter().enumerate().filter_map(|(taxel, name)| {
        let slow: Vec<&Recorded<'_>> = above(recorded, taxel)
            .filter(|press| press.is_slow(options))
            .collect();
        let groups = slow.iter().map(|first| {
            let same = slow.iter().copied().filter(|press| is_same(first, press));
            same.collect::<Vec<&Recorded<'_>>>()
        });
        of_group(groups.max_by_key(Vec::len)?, taxel, name)
    });
    let why = format!("no taxel is pressed slowly {FEWEST} times or more at one location and to one depth");
    Finding::of_list(found.collect(), &why)
}

fn is_same(first: &Recorded<'_>, other: &Recorded<'_>) -> bool {
    let deepest = |press: &Recorded<'_>| press.press.gel_from_indenter[press.phases.hold.start].position_mm;
    first.press.indenter == other.press.indenter && deepest(first).distance(deepest(other)) <= SAME_MM
}

fn of_group(group: Vec<&Recorded<'_>>, taxel: usize, name: &str) -> Option<Repeatability> {
    if group.len() < FEWEST {
        return None;
    }
    let to_n = group
        .iter()
        .map(|press| press.peak_n())
        .fold(f64::INFINITY, f64::min);
    let responses: Vec<Vec<[f64; 2]>> = group
        .iter()
        .map(|press| binned(&press.points(taxel, &press.up()), press.peak_n(), BINS))
        .collect();
    let at = |force_n: f64| -> Option<Vec<f64>> {
        responses
            .iter()
            .map(|response| between(response, force_n))
            .collect()
    };
    let forces_n = (1..BINS).map(|step| to_n * step as f64 / BINS as f64);
    let readings: Vec<Vec<f64>> = forces_n.filter_map(at).collect();
    let full_scale_kpa = mean(readings.last()?)?;
    let widest_kpa = readings
        .iter()
        .filter_map(|readings| deviation(readings))
        .fold(0.0, f64::max);
    Some(Repeatability {
        taxel: name.to_owned(),
        percent: 100.0 * widest_kpa / full_scale_kpa,
        full_scale_kpa,
        to_n,
        n_presses: group.len(),
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::synthetic::{Shape, all, press};

    #[test]
    fn the_spread_between_presses_is_found() {
        let slope = |reads: fn(f64, u32, f64) -> f64| {
            press(&Shape {
                loading_s: 20.0,
                reads,
                ..Shape::default()
            })
        };
        let presses = [
            slope(|force_n, _, _| 6.9 * force_n),
            slope(|force_n, _, _| 7.0 * force_n),
            slope(|force_n, _, _| 7.1 * force_n),
        ];
        let names = ["a".to_owned(), "b".to_owned()];
        let finding = repeatability(&all(&presses), &names, &CharacterizeOptions::default());
        let found = &finding.found().unwrap()[0];
        assert!((found.percent - 100.0 * 0.1 / 7.0).abs() < 0.02, "{found:?}");
        let finding = repeatability(&all(&presses[..2]), &names, &CharacterizeOptions::default());
        assert!(finding.why_not().is_some());
    }
}
