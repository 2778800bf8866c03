//! Hysteresis: the difference between unloading and loading.
//!
//! It is the largest difference between the readings during unloading and loading at the same
//! force, in % of the response at the largest force of the press (ISA-51.1; IEC 61298-2). Slow
//! presses without a hold are used.

use serde::Serialize;

use crate::phases::duration_s;
use crate::recorded::{Recorded, above};
use crate::statistics::{between, binned, mean};
use crate::{CharacterizeOptions, Finding};

/// Longest hold of a press that still counts as one without a hold, s.
const LONGEST_HOLD_S: f64 = 0.5;

/// Number of steps of force in which both curves are averaged.
const BINS: usize = 25;

/// A taxel's hysteresis.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Hysteresis {
    /// The taxel's name.
    pub taxel: String,
    /// Largest difference between unloading and loading at the same force, % of full scale; mean
    /// over presses. Positive if the reading is larger during unloading.
    pub percent: f64,
    /// Full scale: the response at the largest force, kPa; mean over presses.
    pub full_scale_kpa: f64,
    /// Number of presses it was found from.
    pub n_presses: usize,
    /// Loading curve of the first of these presses: force, N, and reading, kPa.
    pub loading: Vec<[f64; 2]>,
    /// Unloading curve of the same press, in order of rising force.
    pub unloading: Vec<[f64; 2]>,
}

pub(crate) fn hysteresis(
    recorded: &[Recorded<'_>],
    taxels: &[String],
    options: &CharacterizeOptions,
) -> Finding<Vec<Hysteresis>> {
    let found = taxels.iter().enumerate().filter_map(|(taxel, name)| {
        let is_suited = |press: &&Recorded<'_>| {
            press.is_slow(options)
                && press.hold_s() <= LONGEST_HOLD_S
                && duration_s(press.press, &press.phases.unloading) >= options.slow_s
        };
        let loops: Vec<Loop> = above(recorded, taxel)
            .filter(is_suited)
            .filter_map(|press| Loop::of(press, taxel))
            .collect();
        let of = |value: fn(&Loop) -> f64| mean(&loops.iter().map(value).collect::<Vec<_>>());
        Some(Hysteresis {
            taxel: name.clone(),
            percent: of(|found| found.percent)?,
            full_scale_kpa: of(|found| found.full_scale_kpa)?,
            n_presses: loops.len(),
            loading: loops[0].loading.clone(),
            unloading: loops[0].unloading.clone(),
        })
    });
    let why = format!(
        "no press above a taxel loads and unloads in {} s or longer each, with a hold of at most {LONGEST_HOLD_S} s",
        options.slow_s
    );
    Finding::of_list(found.collect(), &why)
}

struct Loop {
    percent: f64,
    full_scale_kpa: f64,
    loading: Vec<[f64; 2]>,
    unloading: Vec<[f64; 2]>,
}

impl Loop {
    fn of(press: &Recorded<'_>, taxel: usize) -> Option<Self> {
        let peak_n = press.peak_n();
        let loading = binned(&press.points(taxel, &press.up()), peak_n, BINS);
        let unloading = binned(&press.points(taxel, &press.down()), peak_n, BINS);
        let full_scale_kpa = loading.last()?[1];
        let differences = unloading
            .iter()
            .filter_map(|[force_n, kpa]| Some(kpa - between(&loading, *force_n)?));
        let largest_kpa = differences.max_by(|a, b| a.abs().total_cmp(&b.abs()))?;
        (full_scale_kpa > 0.0).then(|| Self {
            percent: 100.0 * largest_kpa / full_scale_kpa,
            full_scale_kpa,
            loading,
            unloading,
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::synthetic::{Shape, all, press};

    #[test]
    fn a_loop_of_known_width_is_found() {
        // Loading 7 F; unloading 7 F + 0.2 F (4 - F), widest at F = 2: 0.8 kPa of 28 kPa.
        let shape = Shape {
            peak_n: 4.0,
            loading_s: 20.0,
            reads: |force_n, phase, _| {
                7.0 * force_n
                    + if phase == 2 {
                        0.2 * force_n * (4.0 - force_n)
                    } else {
                        0.0
                    }
            },
            ..Shape::default()
        };
        let presses = [press(&shape), press(&shape)];
        let finding = hysteresis(
            &all(&presses),
            &["a".to_owned(), "b".to_owned()],
            &CharacterizeOptions::default(),
        );
        let found = &finding.found().unwrap()[0];
        assert_eq!(found.n_presses, 2);
        // The middle of the last bin is half a bin below full scale.
        assert!(
            (found.percent / (100.0 * 0.8 / 28.0) - 1.0).abs() < 0.03,
            "{}",
            found.percent
        );
    }

    #[test]
    fn a_straight_way_back_has_none() {
        let presses = [press(&Shape::default())];
        let finding = hysteresis(
            &all(&presses),
            &["a".to_owned(), "b".to_owned()],
            &CharacterizeOptions::default(),
        );
        assert!(finding.found().unwrap()[0].percent.abs() < 1e-6);
    }
}
