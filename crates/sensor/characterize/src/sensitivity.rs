//! Sensitivity and linearity, from slow loadings.
//!
//! Sensitivity is the slope of the least-squares line through the response to loading over the
//! linear range. The linear range is the longest range from zero force on in which no point
//! deviates from the range's own line by more than a given percentage of the response at the end of
//! the range. This is independent linearity (IEC 61298-2; ISA-51.1) with the least-squares line as
//! the line.

use serde::Serialize;

use crate::recorded::{Recorded, above};
use crate::statistics::{binned, deviation, line, mean};
use crate::{CharacterizeOptions, Finding};

/// Number of steps of force in which readings are averaged.
const BINS: usize = 100;

/// Smallest number of steps for a line.
const FEWEST_BINS: usize = 5;

/// A taxel's response to force.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Sensitivity {
    /// The taxel's name.
    pub taxel: String,
    /// Slope of the line over the linear range, kPa/N.
    pub sensitivity_kpa_per_n: f64,
    /// Value of the line at zero force, kPa.
    pub offset_kpa: f64,
    /// End of the linear range, N.
    pub linear_to_n: f64,
    /// Whether the response is still linear at the largest force in the data, so that the linear
    /// range may be longer.
    pub is_linear_to_end: bool,
    /// Largest deviation from the line in the linear range, % of the response at its end.
    pub linearity_percent: f64,
    /// Largest force in the data, N.
    pub data_to_n: f64,
    /// Number of slow presses it was found from.
    pub n_presses: usize,
    /// The response: force, N, and reading, kPa, averaged in equal steps of force.
    pub response: Vec<[f64; 2]>,
}

/// The mean over the taxels.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct MeanSensitivity {
    /// Mean of the taxels' sensitivities, kPa/N.
    pub mean_kpa_per_n: f64,
    /// Standard deviation between taxels, kPa/N.
    pub deviation_kpa_per_n: Option<f64>,
    /// The smallest end of the taxels' linear ranges, N.
    pub linear_to_n: f64,
    /// Number of taxels with a sensitivity.
    pub n_taxels: usize,
}

pub(crate) fn sensitivity(
    recorded: &[Recorded<'_>],
    taxels: &[String],
    options: &CharacterizeOptions,
) -> Finding<Vec<Sensitivity>> {
    let found = taxels
        .iter()
        .enumerate()
        .filter_map(|(taxel, name)| of_taxel(recorded, taxel, name, options));
    let why = format!(
        "no press to a depth is within {} mm of a taxel and takes {} s or longer to load",
        options.above_mm, options.slow_s
    );
    Finding::of_list(found.collect(), &why)
}

pub(crate) fn overall(taxels: &Finding<Vec<Sensitivity>>) -> Finding<MeanSensitivity> {
    let taxels = match taxels {
        Finding::Found(taxels) => taxels,
        Finding::NotGiven(why) => return Finding::NotGiven(why.clone()),
    };
    let slopes: Vec<f64> = taxels.iter().map(|taxel| taxel.sensitivity_kpa_per_n).collect();
    mean(&slopes).map_or_else(
        || Finding::NotGiven("no taxel has a sensitivity".to_owned()),
        |mean_kpa_per_n| {
            Finding::Found(MeanSensitivity {
                mean_kpa_per_n,
                deviation_kpa_per_n: deviation(&slopes),
                linear_to_n: taxels
                    .iter()
                    .map(|taxel| taxel.linear_to_n)
                    .fold(f64::INFINITY, f64::min),
                n_taxels: taxels.len(),
            })
        },
    )
}

fn of_taxel(
    recorded: &[Recorded<'_>],
    taxel: usize,
    name: &str,
    options: &CharacterizeOptions,
) -> Option<Sensitivity> {
    let slow: Vec<&Recorded<'_>> = above(recorded, taxel)
        .filter(|press| press.is_slow(options))
        .collect();
    let points: Vec<[f64; 2]> = slow
        .iter()
        .flat_map(|press| press.points(taxel, &press.up()))
        .collect();
    let data_to_n = points.iter().map(|point| point[0]).fold(0.0, f64::max);
    let response = binned(&points, data_to_n, BINS);
    let range = (FEWEST_BINS..=response.len())
        .rev()
        .find_map(|n| fit(&response[..n]).filter(|fit| fit.linearity_percent <= options.linear_percent))?;
    Some(Sensitivity {
        taxel: name.to_owned(),
        sensitivity_kpa_per_n: range.slope,
        offset_kpa: range.offset,
        linear_to_n: response[range.n - 1][0],
        is_linear_to_end: range.n == response.len(),
        linearity_percent: range.linearity_percent,
        data_to_n,
        n_presses: slow.len(),
        response,
    })
}

struct Fit {
    n: usize,
    slope: f64,
    offset: f64,
    linearity_percent: f64,
}

fn fit(points: &[[f64; 2]]) -> Option<Fit> {
    let [slope, offset] = line(points)?;
    let farthest = points
        .iter()
        .map(|[x, y]| (y - slope * x - offset).abs())
        .fold(0.0, f64::max);
    let span = slope * points[points.len() - 1][0];
    (span > 0.0).then(|| Fit {
        n: points.len(),
        slope,
        offset,
        linearity_percent: 100.0 * farthest / span,
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::synthetic::{Shape, all, press};

    fn found(reads: fn(f64, u32, f64) -> f64) -> Sensitivity {
        let presses = [press(&Shape {
            peak_n: 4.0,
            loading_s: 10.0,
            reads,
            ..Shape::default()
        })];
        let names = ["a".to_owned(), "b".to_owned()];
        sensitivity(&all(&presses), &names, &CharacterizeOptions::default())
            .found()
            .unwrap()[0]
            .clone()
    }

    #[test]
    fn a_line_is_linear_to_the_end_of_the_data() {
        let found = found(|force_n, _, _| 7.24 * force_n);
        assert!((found.sensitivity_kpa_per_n - 7.24).abs() < 1e-9);
        assert!(found.is_linear_to_end && found.linearity_percent < 1e-6);
        assert!((found.data_to_n - 4.0).abs() < 0.05);
    }

    #[test]
    fn a_parabola_is_linear_as_far_as_its_curvature_says() {
        // y = x - x²/10. Over [0, L] the least-squares line of a x² deviates by a L²/6 at the ends,
        // and its span is L - a L². So 5 % is reached where a L / 6 = 0.05 (1 - a L), at a L = 0.3
        // / 1.3.
        let found = found(|force_n, _, _| force_n - force_n * force_n / 10.0);
        let expected = 10.0 * 0.3 / 1.3;
        assert!(
            (found.linear_to_n / expected - 1.0).abs() < 0.05,
            "{} {expected}",
            found.linear_to_n
        );
        assert!(!found.is_linear_to_end);
        let slope = 1.0 - 0.1 * found.linear_to_n;
        assert!(
            (found.sensitivity_kpa_per_n / slope - 1.0).abs() < 0.02,
            "{found:?}"
        );
    }

    #[test]
    fn fast_presses_do_not_count() {
        let presses = [press(&Shape {
            loading_s: 0.5,
            ..Shape::default()
        })];
        let names = ["a".to_owned(), "b".to_owned()];
        assert!(
            sensitivity(&all(&presses), &names, &CharacterizeOptions::default())
                .why_not()
                .unwrap()
                .contains("1 s")
        );
    }
}
