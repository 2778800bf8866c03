//! What looks like a wrong unit, height or clock in an import description, although numbers like
//! these can occur. The summary of the import says it.

use super::description::{Description, Split};
use super::median::median;
use super::plausible::AIR_KPA;
use super::track::Track;
use crate::Press;

/// What readings of the air are multiplied by if `Pa`, `hPa`, `kPa`, `bar` or `psi` was taken for
/// another of them.
const PARTS: [f64; 8] = [1e-3, 1e-2, 0.1, 0.145, 6.895, 10.0, 1e2, 1e3];

/// Untouched absolute readings of all taxels are this near to their mean, as a fraction of it.
const ALIKE: f64 = 0.05;

/// Usual times between frames of presses, s.
const USUAL_STEP_S: [f64; 2] = [2e-5, 2.0];

/// A press begins where this fraction of its largest force is reached. With force ∝ depthⁿ, that is
/// at a fraction of `BEGUN^(1/n)` of the depth: 0.46 for n = 3.
const BEGUN: f64 = 0.1;

/// Fraction of a press's depth at which the force has begun in any press.
const LATEST: f64 = 0.6;

/// Differences of height below this are usual, mm.
const USUAL_MM: f64 = 1.0;

/// Presses that are compared have at least this fraction of the largest force.
const STRONG: f64 = 0.2;

/// Warnings about the units of readings and times.
pub(super) fn units(track: &Track, description: &Description) -> Vec<String> {
    let times = step_of_time(track, description);
    times
        .into_iter()
        .chain(unit_of_readings(track, description))
        .collect()
}

/// Frames that follow each other much slower or faster than those of a press.
fn step_of_time(track: &Track, description: &Description) -> Option<String> {
    if matches!(description.presses, Split::Row) || description.time.is_none() {
        return None;
    }
    let step_s = median(track.time_s.windows(2).map(|pair| pair[1] - pair[0]).collect())?;
    let is_usual = (USUAL_STEP_S[0]..=USUAL_STEP_S[1]).contains(&step_s);
    (!is_usual).then(|| {
        format!(
            "its rows follow each other after {step_s:.3e} s, which is {:.3e} Hz: is the unit of `time` right?",
            1.0 / step_s
        )
    })
}

/// Readings that would be the pressure of the air in another unit.
fn unit_of_readings(track: &Track, description: &Description) -> Option<String> {
    // Only readings from which a zero is subtracted are absolute.
    description.zero?;
    let taxels = 0..description.taxels.len();
    let medians: Option<Vec<f64>> = taxels.map(|taxel| track.median_kpa(taxel, description)).collect();
    let medians = medians.filter(|medians| medians.len() > 1)?;
    let mean_kpa = medians.iter().sum::<f64>() / medians.len() as f64;
    if medians.iter().any(|kpa| (kpa / mean_kpa - 1.0).abs() > ALIKE) {
        return None;
    }
    let is_air = |part: &&f64| AIR_KPA.contains(&(mean_kpa / *part));
    let part = PARTS.iter().find(is_air)?;
    Some(format!(
        "its untouched readings are all near {mean_kpa:.4} kPa, {part} times the pressure of the air: is the unit of `readings` right?"
    ))
}

/// Warnings about the height at which presses touch the gel, and about the sign of the force.
pub(super) fn presses(presses: &[Press], description: &Description) -> Vec<String> {
    if description.force.is_none() || description.z.is_none() {
        return Vec::new();
    }
    let forces: Vec<Forces> = presses
        .iter()
        .filter_map(|press| Forces::of(press, description))
        .collect();
    let strongest_n = forces.iter().map(|press| press.most_n.abs()).fold(0.0, f64::max);
    let strong: Vec<&Forces> = forces
        .iter()
        .filter(|press| press.most_n.abs() >= STRONG * strongest_n)
        .collect();
    let of = |value: fn(&Forces) -> f64| median(strong.iter().map(|press| value(press)).collect());
    let (Some(most_n), Some(begins_mm), Some(deepest_mm)) = (
        of(|press| press.most_n),
        of(|press| press.begins_mm),
        of(|press| press.deepest_mm),
    ) else {
        return Vec::new();
    };
    if most_n < 0.0 {
        return vec![format!(
            "its force is {most_n:.3} N where the indenter is deepest, but the gel is pressed with positive forces: give `force` the other sign of `scale`"
        )];
    }
    if begins_mm < -USUAL_MM {
        return vec![format!(
            "its force begins {:.2} mm above the gel: `contact.z_mm` is too low by about as much",
            -begins_mm
        )];
    }
    if begins_mm > USUAL_MM && begins_mm > LATEST * deepest_mm {
        return vec![format!(
            "its force begins {begins_mm:.2} mm below the surface of the gel, in presses that are {deepest_mm:.2} mm deep: is `contact.z_mm` right?"
        )];
    }
    Vec::new()
}

/// The force of a press, without that of its first frame.
struct Forces {
    /// At the deepest frame, N.
    most_n: f64,
    deepest_mm: f64,
    /// Depth at which the force begins on the way down, mm; negative above the gel.
    begins_mm: f64,
}

impl Forces {
    fn of(press: &Press, description: &Description) -> Option<Self> {
        let force_n = press.force_n.as_ref()?;
        let depth_mm = |frame: usize| description.gel_top_mm - press.gel_from_indenter[frame].position_mm.z;
        let deepest = (0..force_n.len()).max_by(|&a, &b| depth_mm(a).total_cmp(&depth_mm(b)))?;
        let rest_n = force_n[0];
        let most_n = force_n[deepest] - rest_n;
        // The last frame of the way down before which the force is still small.
        let begins = (0..=deepest)
            .rev()
            .take_while(|&frame| (force_n[frame] - rest_n) / most_n > BEGUN);
        Some(Self {
            most_n,
            deepest_mm: depth_mm(deepest),
            begins_mm: depth_mm(begins.last()?),
        })
    }
}
