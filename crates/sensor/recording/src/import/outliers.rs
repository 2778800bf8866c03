//! Marks outliers among static readings.

use super::description::Outliers;
use crate::Press;

/// Smallest number of neighbours for a decision.
const FEWEST_NEIGHBOURS: usize = 3;

/// Marks readings as not valid that differ from the median of the readings within `within_mm` by
/// more than `jump` times the taxel's largest reading. The largest reading is the 99.9th
/// percentile, so that an outlier does not hide itself. Returns the number of marked readings.
pub(crate) fn mark(presses: &mut [Press], outliers: Outliers) -> usize {
    let places: Vec<_> = presses
        .iter()
        .map(|press| press.gel_from_indenter[0].position_mm.truncate())
        .collect();
    let taxels = presses.first().map_or(0, |press| press.taxels_kpa[0].len());
    let mut marked = Vec::new();
    for taxel in 0..taxels {
        let kpa: Vec<Option<f64>> = presses
            .iter()
            .map(|p| p.valid[0][taxel].then_some(p.taxels_kpa[0][taxel]))
            .collect();
        let mut sizes: Vec<f64> = kpa.iter().flatten().map(|kpa| kpa.abs()).collect();
        sizes.sort_unstable_by(f64::total_cmp);
        let Some(&largest_kpa) = sizes.get((sizes.len().saturating_sub(1)) * 999 / 1000) else {
            continue;
        };
        for (index, reading) in kpa.iter().enumerate() {
            let Some(reading) = reading else { continue };
            let near = |&(other, _): &(usize, &Option<f64>)| {
                other != index && places[other].distance(places[index]) <= outliers.within_mm
            };
            let mut neighbours: Vec<f64> = kpa
                .iter()
                .enumerate()
                .filter(near)
                .filter_map(|(_, kpa)| *kpa)
                .collect();
            neighbours.sort_unstable_by(f64::total_cmp);
            let enough = neighbours.len() >= FEWEST_NEIGHBOURS;
            if enough && (reading - neighbours[neighbours.len() / 2]).abs() > outliers.jump * largest_kpa {
                marked.push((index, taxel));
            }
        }
    }
    for &(index, taxel) in &marked {
        presses[index].valid[0][taxel] = false;
    }
    marked.len()
}
