//! The contact height of a new recording.
//!
//! Contact heights differ from one installation of an indenter to the next by some hundredths of a
//! millimetre. This changes readings by some percent, and no model can predict it. For a file that
//! the test setup was not fitted to, the contact height is therefore fitted to its first presses,
//! with the trained twin unchanged. Only the physical part of the twin is used, because a
//! perceptron may compensate a wrong height. The presses are selected by a rule that is fixed
//! beforehand and uses poses only: the first three whose largest predicted reading is at least half
//! of the largest of the file. These presses are not scored.

use std::collections::BTreeSet;

use serde::{Deserialize, Serialize};
use twintac_depth_table::DepthTable;
use twintac_recording::{Control, Press, Recording};

use crate::bench_fit::{BenchEstimate, Estimate, Places, curves, features_along};
use crate::features::Sample;
use crate::numerics::minimize;
use crate::{DigitacError, Features, Twin};

/// Number of presses to which a file's contact height is fitted.
const N_PRESSES: usize = 3;
/// Smallest ratio of their largest predicted reading to that of the file.
const FELT: f64 = 0.5;
/// A press is worth a warning if its own contact height differs from that of the file by more than
/// this, mm.
const SUSPICIOUS_MM: f64 = 0.08;
/// Tolerance of heights, mm.
const TOLERANCE_MM: f64 = 2e-3;

/// The contact height of one file.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Recalibration {
    /// The file.
    pub file: String,
    /// True minus recorded depth of the tip, mm. Its uncertainty is the disagreement of the
    /// presses.
    pub contact_offset_mm: Estimate,
    /// The presses that it was fitted to, by number. They must not be scored.
    pub used: Vec<usize>,
    /// Warnings about presses whose own height differs much from that of the file.
    pub doubts: Vec<String>,
}

/// Fits the contact height of a file to three of its presses by least absolute deviations from the
/// twin, within `limit_mm` of the median of the test setup. Excluded taxels, in `left_out`, do not
/// count. `None` if the file has no presses of prescribed pose, too few presses, or none with a
/// predicted reading.
pub fn recalibrate(
    recording: &Recording,
    (places, tables): (&Places, &[DepthTable]),
    bench: &BenchEstimate,
    twin: &Twin,
    file: &str,
    limit_mm: f64,
    left_out: &BTreeSet<usize>,
) -> Result<Option<Recalibration>, DigitacError> {
    let curves = curves(places, tables, recording.taxels.len())?;
    let along = |index: usize, bench: &BenchEstimate| {
        let (press, place) = (&recording.presses[index], places.of_press[index]);
        let touch_z_mm = places.requests[place].gel_from_indenter_at_touch.position_mm.z;
        features_along(&curves[place], press, touch_z_mm, bench)
    };
    let is_of_file = |press: &Press| press.mounting == file && press.control == Control::Pose;
    let of_file: Vec<usize> = (0..recording.presses.len())
        .filter(|&index| is_of_file(&recording.presses[index]))
        .collect();
    if of_file.len() <= N_PRESSES {
        return Ok(None);
    }
    let used = felt(&of_file, &|index| along(index, bench), twin, left_out, N_PRESSES)?;
    if used.is_empty() {
        return Ok(None);
    }
    let physical = &twin.physics().gains;
    let deviation_kpa = |presses: &[usize], offset_mm: f64| -> Result<f64, DigitacError> {
        let mut bench = bench.clone();
        let height = Estimate {
            value: offset_mm,
            uncertainty: 0.0,
        };
        bench.contact_offset_mm.insert(file.to_owned(), height);
        let mut sum = 0.0;
        for &index in presses {
            let (press, features) = (&recording.presses[index], along(index, &bench)?);
            let sample = Sample {
                readings_kpa: &press.taxels_kpa,
                valid: &press.valid,
            };
            let predicted = physical.readings_kpa(&[&features]).swap_remove(0);
            sum += sample.deviation_kpa(&predicted, left_out);
        }
        Ok(sum)
    };
    let center = bench.contact_offset_elsewhere_mm;
    let fit = |presses: &[usize]| -> Result<f64, DigitacError> {
        let mut failure = None;
        let value = |offset_mm: f64| {
            deviation_kpa(presses, offset_mm).unwrap_or_else(|error| {
                failure = Some(error);
                f64::INFINITY
            })
        };
        let (offset_mm, _) = minimize(center - limit_mm, center + limit_mm, TOLERANCE_MM, value);
        failure.map_or(Ok(offset_mm), Err)
    };
    let value = fit(&used)?;
    let own: Vec<f64> = used
        .iter()
        .map(|&press| fit(&[press]))
        .collect::<Result<_, _>>()?;
    let spread =
        own.iter().map(|o| (o - value).powi(2)).sum::<f64>() / (own.len() * (own.len() - 1)).max(1) as f64;
    let doubts = used
        .iter()
        .zip(&own)
        .filter(|(_, own)| (*own - value).abs() > SUSPICIOUS_MM)
        .map(|(&press, own)| {
            let name = &recording.presses[press].name;
            format!(
                "press {name} touches {:.2} mm deeper than recorded, the others {value:.2} mm",
                own
            )
        })
        .collect();
    let contact_offset_mm = Estimate {
        value,
        uncertainty: spread.sqrt(),
    };
    Ok(Some(Recalibration {
        file: file.to_owned(),
        contact_offset_mm,
        used,
        doubts,
    }))
}

/// The first presses whose largest predicted reading is at least half of the largest; only poses
/// decide.
fn felt(
    presses: &[usize],
    along: &dyn Fn(usize) -> Result<Features, DigitacError>,
    twin: &Twin,
    left_out: &BTreeSet<usize>,
    count: usize,
) -> Result<Vec<usize>, DigitacError> {
    let felt_kpa = presses
        .iter()
        .map(|&index| {
            let predicted = twin.predict(&[&along(index)?]).swap_remove(0);
            let kept = predicted.iter().flat_map(|row| {
                let taxels = row.iter().enumerate();
                taxels.filter(|(taxel, _)| !left_out.contains(taxel))
            });
            Ok(kept.map(|(_, reading)| *reading).fold(0.0, f64::max))
        })
        .collect::<Result<Vec<f64>, DigitacError>>()?;
    let most_kpa = felt_kpa.iter().copied().fold(0.0, f64::max);
    let enough = presses
        .iter()
        .zip(&felt_kpa)
        .filter(|(_, felt)| **felt > 0.0 && **felt >= FELT * most_kpa);
    Ok(enough.map(|(&index, _)| index).take(count).collect())
}
