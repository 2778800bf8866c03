//! Errors of estimated locations and depths, where the recording says the true ones.

use serde::Serialize;

use super::frames::{LocatedFrame, LocatedPress};

/// A frame counts if its largest reading exceeds this fraction of the largest reading of all
/// presses.
const FELT: f64 = 0.03;

/// Errors of contact estimation. A frame counts if the tip is in the gel and its largest reading
/// exceeds 3 % of the largest of all presses of the recording. Errors of depth are in % of the
/// deepest of the same press.
#[derive(Clone, Debug, Serialize)]
pub struct LocationErrors {
    /// Number of presses with a frame that counts.
    pub presses: usize,
    /// Number of presses without such a frame.
    pub presses_not_felt: usize,
    /// Number of frames that count.
    pub frames: usize,
    /// Number of these frames in which no contact was found.
    pub frames_missed: usize,
    /// Error of the location, mm, over the frames.
    pub place_mm: Quantiles,
    /// The same in the deepest frame of each press, the last of equal ones.
    pub place_at_peak_mm: Quantiles,
    /// Error of the depth, % of the press's largest, over the frames.
    pub depth_percent: Quantiles,
    /// The same in the deepest frame of each press.
    pub depth_at_peak_percent: Quantiles,
    /// Percentage of the frames whose location error is within two stated standard deviations along
    /// each estimated axis; `None` if no contact was found.
    pub place_within_two_deviations_percent: Option<f64>,
    /// Percentage of the frames whose depth error is within two stated standard deviations.
    pub depth_within_two_deviations_percent: Option<f64>,
    /// The presses with frames that count.
    pub of_presses: Vec<PressErrors>,
}

/// Errors of one press.
#[derive(Clone, Debug, Serialize)]
pub struct PressErrors {
    /// The press's name.
    pub name: String,
    /// True location along x and y, mm.
    pub place_mm: [f64; 2],
    /// Largest true depth, mm.
    pub deepest_mm: f64,
    /// Largest reading of its frames that count, kPa.
    pub largest_kpa: f64,
    /// Median error of the location, mm; `None` if no contact was found.
    pub place_error_mm: Option<f64>,
    /// Median error of the depth, % of the deepest.
    pub depth_error_percent: Option<f64>,
    /// Errors of the location along x and of the depth in the deepest frame, mm, estimated minus
    /// true. `None` if no contact was found.
    pub at_peak_mm: Option<[f64; 2]>,
}

/// Median and 90th percentile of errors; `None` without errors.
#[derive(Clone, Copy, Debug, Serialize)]
pub struct Quantiles {
    /// Median.
    pub median: Option<f64>,
    /// 90th percentile.
    pub of_90_percent: Option<f64>,
}

impl Quantiles {
    fn of(mut errors: Vec<f64>) -> Self {
        errors.sort_by(f64::total_cmp);
        let at = |part: f64| {
            let last = errors.len().saturating_sub(1) as f64;
            errors.get((part * last).round() as usize).copied()
        };
        Self {
            median: at(0.5),
            of_90_percent: at(0.9),
        }
    }
}

/// Errors of a frame.
struct FrameError {
    x_mm: f64,
    place_mm: f64,
    depth_mm: f64,
    is_place_within: bool,
    is_depth_within: bool,
}

impl FrameError {
    fn of(frame: &LocatedFrame) -> Option<Self> {
        let (place_mm, deviation_mm) = (frame.place_mm?, frame.place_deviation_mm?);
        let way_mm = [0, 1].map(|axis| place_mm[axis] - frame.true_place_mm[axis]);
        let depth_mm = frame.depth_mm? - frame.true_depth_mm?;
        // An axis that is not estimated has no deviation.
        let is_within =
            |axis: usize| deviation_mm[axis] == 0.0 || way_mm[axis].abs() <= 2.0 * deviation_mm[axis];
        Some(Self {
            x_mm: way_mm[0],
            place_mm: way_mm[0].hypot(way_mm[1]),
            depth_mm,
            is_place_within: is_within(0) && is_within(1),
            is_depth_within: depth_mm.abs() <= 2.0 * frame.depth_deviation_mm?,
        })
    }
}

impl LocationErrors {
    /// The errors on presses that the twin was trained on (`trained_on`), or on the others.
    pub(super) fn of(presses: &[LocatedPress], trained_on: bool) -> Option<Self> {
        let frames = presses.iter().flat_map(|press| &press.frames);
        let largest_kpa = frames.map(|frame| frame.largest_kpa).fold(0.0, f64::max);
        let counts = |frame: &&LocatedFrame| {
            frame.largest_kpa > FELT * largest_kpa
                && frame.true_depth_mm.is_some_and(|depth_mm| depth_mm > 0.0)
        };
        let own: Vec<&LocatedPress> = presses
            .iter()
            .filter(|press| press.trained_on == trained_on)
            .collect();
        let places = |errors: &[(f64, FrameError)]| {
            Quantiles::of(errors.iter().map(|(_, error)| error.place_mm).collect())
        };
        let depths = |errors: &[(f64, FrameError)]| {
            Quantiles::of(errors.iter().map(|(percent, _)| *percent).collect())
        };
        let mut of_presses = Vec::new();
        let (mut n_felt, mut n_frames, mut all, mut at_peak) = (0, 0, Vec::new(), Vec::new());
        for press in &own {
            let depth_mm = |frame: &LocatedFrame| frame.true_depth_mm.unwrap_or(f64::NEG_INFINITY);
            let felt: Vec<&LocatedFrame> = press.frames.iter().filter(counts).collect();
            let Some(peak) = felt.iter().max_by(|a, b| depth_mm(a).total_cmp(&depth_mm(b))) else {
                continue;
            };
            n_felt += 1;
            n_frames += felt.len();
            let percent = 100.0 / depth_mm(peak);
            let found = |frame: &LocatedFrame| {
                FrameError::of(frame).map(|error| (percent * error.depth_mm.abs(), error))
            };
            let of_frames: Vec<(f64, FrameError)> = felt.iter().copied().filter_map(found).collect();
            of_presses.push(PressErrors {
                name: press.name.clone(),
                place_mm: peak.true_place_mm,
                deepest_mm: depth_mm(peak),
                largest_kpa: felt.iter().map(|frame| frame.largest_kpa).fold(0.0, f64::max),
                place_error_mm: places(&of_frames).median,
                depth_error_percent: depths(&of_frames).median,
                at_peak_mm: FrameError::of(peak).map(|error| [error.x_mm, error.depth_mm]),
            });
            at_peak.extend(found(peak));
            all.extend(of_frames);
        }
        let share = |is_within: &dyn Fn(&FrameError) -> bool| {
            let n_within = all.iter().filter(|(_, error)| is_within(error)).count();
            (!all.is_empty()).then(|| 100.0 * n_within as f64 / all.len() as f64)
        };
        (n_felt > 0).then(|| Self {
            presses: n_felt,
            presses_not_felt: own.len() - n_felt,
            frames: n_frames,
            frames_missed: n_frames - all.len(),
            place_mm: places(&all),
            place_at_peak_mm: places(&at_peak),
            depth_percent: depths(&all),
            depth_at_peak_percent: depths(&at_peak),
            place_within_two_deviations_percent: share(&|error| error.is_place_within),
            depth_within_two_deviations_percent: share(&|error| error.is_depth_within),
            of_presses,
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A frame at x = 3 mm, with these errors along x and in depth.
    fn frame(true_depth_mm: f64, largest_kpa: f64, off_mm: Option<[f64; 2]>) -> LocatedFrame {
        LocatedFrame {
            time_s: 0.0,
            indenter: None,
            place_mm: off_mm.map(|[x, _]| [3.0 + x, 0.0]),
            place_deviation_mm: off_mm.map(|_| [0.1, 0.0]),
            depth_mm: off_mm.map(|[_, depth]| true_depth_mm + depth),
            depth_deviation_mm: off_mm.map(|_| 0.1),
            force_n: None,
            misfit: None,
            true_place_mm: [3.0, 0.0],
            true_depth_mm: Some(true_depth_mm),
            largest_kpa,
        }
    }

    #[test]
    fn frames_count_that_are_felt_in_the_gel() {
        let press = |trained_on: bool, frames: Vec<LocatedFrame>| LocatedPress {
            name: String::new(),
            mounting: String::new(),
            trained_on,
            frames,
        };
        let frames = vec![
            frame(-0.5, 50.0, Some([9.0, 9.0])),
            frame(0.1, 2.0, Some([9.0, 9.0])),
            frame(1.0, 50.0, Some([-0.15, 0.1])),
            frame(1.5, 60.0, None),
            frame(2.0, 60.0, Some([0.3, -0.3])),
        ];
        let presses = [
            press(false, frames),
            press(true, vec![frame(1.0, 100.0, Some([0.0, 0.0]))]),
        ];
        let errors = LocationErrors::of(&presses, false).unwrap();
        assert_eq!([errors.presses, errors.frames, errors.frames_missed], [1, 3, 1]);
        let near = |found: Option<f64>, expected: f64| {
            assert!((found.unwrap() - expected).abs() < 1e-9, "{errors:?}");
        };
        near(errors.place_mm.of_90_percent, 0.3);
        near(errors.place_at_peak_mm.median, 0.3);
        near(errors.depth_percent.of_90_percent, 15.0);
        near(errors.place_within_two_deviations_percent, 50.0);
        near(errors.depth_within_two_deviations_percent, 50.0);
        let [x_mm, depth_mm] = errors.of_presses[0].at_peak_mm.unwrap();
        assert!((x_mm - 0.3).abs() < 1e-9 && (depth_mm + 0.3).abs() < 1e-9);
        let trained_on = LocationErrors::of(&presses, true).unwrap();
        assert!(trained_on.place_mm.median.unwrap().abs() < 1e-12);
        assert!(LocationErrors::of(&presses[..1], true).is_none());
        // A frame that counts without a contact found: there are no errors.
        let missed = [press(false, vec![frame(1.0, 50.0, None)])];
        let errors = LocationErrors::of(&missed, false).unwrap();
        assert_eq!([errors.frames, errors.frames_missed], [1, 1]);
        let none = [errors.place_mm.median, errors.place_within_two_deviations_percent];
        assert_eq!(none, [None; 2]);
    }
}
