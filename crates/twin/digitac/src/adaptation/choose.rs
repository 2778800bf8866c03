//! The few presses that a twin is adapted with.
//!
//! Poses and the twin that is there choose; what was measured does not. A contact height shows in presses of its own file only, and a gain in
//! presses near its own taxel: so presses are spread over files first, and over taxels then.

use std::collections::BTreeMap;

use rand::Rng;
use twintac_recording::Recording;

use crate::seed;

/// A press is felt at least this much of what the most felt one of its file is, as the twin says.
const FELT: f64 = 0.5;

/// Presses among `candidates` to adapt a twin with, `n_presses` at most, in the order in which they were chosen. `predicted_kpa` is what the
/// twin would read along each press of the recording; `[n_presses][n_frames][n_taxels]`.
///
/// Each is one of the file that has the fewest so far, at the taxel that has the fewest so far; chance decides among equals. Presses that the
/// twin would feel less than half as much as the most of their file come last.
#[must_use]
pub fn choose_presses(
    recording: &Recording,
    candidates: &[usize],
    predicted_kpa: &[Vec<Vec<f64>>],
    n_presses: usize,
    seed_number: u64,
) -> Vec<usize> {
    let mut random = seed::stream(seed_number, "adaptation");
    let mut most_kpa: BTreeMap<&str, f64> = BTreeMap::new();
    let mut left: Vec<Candidate<'_>> = Vec::new();
    for &press in candidates {
        let file = &recording.presses[press].mounting[..];
        let (taxel, felt_kpa) = nearest(&predicted_kpa[press]);
        let most = most_kpa.entry(file).or_insert(0.0);
        *most = most.max(felt_kpa);
        left.push(Candidate {
            press,
            file,
            taxel,
            felt_kpa,
            chance: random.random(),
        });
    }
    let mut of_file: BTreeMap<&str, usize> = BTreeMap::new();
    let mut of_taxel: BTreeMap<usize, usize> = BTreeMap::new();
    let mut chosen = Vec::new();
    while chosen.len() < n_presses {
        let rank = |candidate: &Candidate<'_>| {
            (
                candidate.felt_kpa < FELT * most_kpa[candidate.file],
                of_file.get(candidate.file).copied().unwrap_or(0),
                of_taxel.get(&candidate.taxel).copied().unwrap_or(0),
                candidate.chance,
            )
        };
        let ranked = left.iter().enumerate();
        let Some((index, _)) = ranked.min_by_key(|(_, candidate)| rank(candidate)) else {
            break;
        };
        let next = left.swap_remove(index);
        *of_file.entry(next.file).or_insert(0) += 1;
        *of_taxel.entry(next.taxel).or_insert(0) += 1;
        chosen.push(next.press);
    }
    chosen
}

struct Candidate<'a> {
    press: usize,
    file: &'a str,
    /// The taxel that would read the most.
    taxel: usize,
    felt_kpa: f64,
    chance: u64,
}

/// The taxel with the largest reading of a press, and that reading.
fn nearest(readings_kpa: &[Vec<f64>]) -> (usize, f64) {
    let readings = readings_kpa.iter().flat_map(|row| row.iter().copied().enumerate());
    readings.fold((0, 0.0), |most, reading| {
        if reading.1 > most.1 { reading } else { most }
    })
}

#[cfg(test)]
mod tests {
    use std::collections::BTreeSet;

    use super::*;
    use crate::synthetic::Truth;

    #[test]
    fn presses_are_spread_over_files_then_taxels_and_the_seed_decides() {
        let recording = Truth::new().recording(21);
        let predicted_kpa: Vec<Vec<Vec<f64>>> = recording
            .presses
            .iter()
            .map(|press| press.taxels_kpa.clone())
            .collect();
        let all: Vec<usize> = (0..recording.presses.len()).collect();
        let choose = |n_presses, seed| choose_presses(&recording, &all, &predicted_kpa, n_presses, seed);
        let chosen = choose(4, 1);
        let files: BTreeSet<&str> = chosen
            .iter()
            .map(|&press| &recording.presses[press].mounting[..])
            .collect();
        assert_eq!((chosen.len(), files.len()), (4, 2));
        let taxels: BTreeSet<usize> = chosen.iter().map(|&press| nearest(&predicted_kpa[press]).0).collect();
        assert!(taxels.len() >= 3, "{taxels:?}");
        assert_eq!(chosen, choose(4, 1));
        assert_ne!(chosen, choose(4, 2));
        assert_eq!(choose(1000, 1).len(), all.len());
    }
}
