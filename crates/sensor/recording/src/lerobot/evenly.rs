//! Frames at a whole rate. A LeRobot data set has a whole number of frames per second, and frame
//! `i` of an episode is at the time `i` divided by this rate.

use std::borrow::Cow;

use twintac_shape::Pose;

use crate::{Press, Recording};

/// Largest deviation from even spacing, s; LeRobot accepts no more.
const EVEN_S: f64 = 1e-4;

/// Between neighbours that are farther apart than this many frames, frames are missing.
const GAP: f64 = 2.5;

/// A recording with evenly spaced frames.
pub(super) struct Even<'a> {
    pub(super) recording: Cow<'a, Recording>,
    /// Frames per second.
    pub(super) fps: u64,
    /// The rate that it was resampled from, Hz: from the median time between frames. `None` if its
    /// frames were evenly spaced already.
    pub(super) from_hz: Option<f64>,
}

/// The recording at the whole rate nearest to its own, at least one frame per second.
pub(super) fn evenly(recording: &Recording) -> Even<'_> {
    let times_s = || recording.presses.iter().map(|press| &press.time_s);
    let mut steps_s: Vec<f64> = times_s()
        .flat_map(|time_s| time_s.windows(2).map(|pair| pair[1] - pair[0]))
        .collect();
    steps_s.sort_unstable_by(f64::total_cmp);
    let rate_hz = steps_s.get(steps_s.len() / 2).map_or(1.0, |step_s| 1.0 / step_s);
    let fps = rate_hz.round().max(1.0);
    let is_even = |time_s: &Vec<f64>| {
        let mut frames = time_s.iter().enumerate();
        frames.all(|(frame, at_s)| (at_s - time_s[0] - frame as f64 / fps).abs() <= EVEN_S)
    };
    let is_resampled = !times_s().all(is_even);
    Even {
        fps: fps as u64,
        from_hz: is_resampled.then_some(rate_hz),
        recording: if is_resampled {
            Cow::Owned(Recording {
                sensor: recording.sensor.clone(),
                provenance: recording.provenance,
                taxels: recording.taxels.clone(),
                presses: recording
                    .presses
                    .iter()
                    .map(|press| resampled(press, fps))
                    .collect(),
            })
        } else {
            Cow::Borrowed(recording)
        },
    }
}

/// A press at `fps` frames per second: interpolated linearly, rotations along the shortest arc. A
/// reading is valid if both frames beside it are, and if no frame is missing between these.
fn resampled(press: &Press, fps: f64) -> Press {
    let time_s = &press.time_s;
    let (first_s, last_s) = (time_s[0], time_s[time_s.len() - 1]);
    let n_frames = ((last_s - first_s) * fps + 1e-6) as usize + 1;
    let mut even = Press {
        time_s: Vec::with_capacity(n_frames),
        gel_from_indenter: Vec::with_capacity(n_frames),
        force_n: press.force_n.as_ref().map(|_| Vec::with_capacity(n_frames)),
        taxels_kpa: Vec::with_capacity(n_frames),
        taxels_raw: Vec::with_capacity(n_frames),
        temperature_c: press.temperature_c.as_ref().map(|_| Vec::with_capacity(n_frames)),
        valid: Vec::with_capacity(n_frames),
        name: press.name.clone(),
        mounting: press.mounting.clone(),
        indenter: press.indenter.clone(),
        control: press.control,
    };
    for frame in 0..n_frames {
        let at_s = (first_s + frame as f64 / fps).min(last_s);
        let between = Between::at(time_s, at_s, fps);
        even.time_s.push(first_s + frame as f64 / fps);
        even.gel_from_indenter
            .push(between.pose(&press.gel_from_indenter));
        if let (Some(even), Some(force_n)) = (&mut even.force_n, &press.force_n) {
            even.push(between.number(force_n));
        }
        even.taxels_kpa.push(between.row(&press.taxels_kpa));
        even.taxels_raw.push(between.row(&press.taxels_raw));
        if let (Some(even), Some(rows)) = (&mut even.temperature_c, &press.temperature_c) {
            even.push(between.row(rows));
        }
        even.valid.push(between.valid(&press.valid));
    }
    even
}

/// A time between two frames.
struct Between {
    before: usize,
    after: usize,
    /// The fraction of the way from one to the other.
    part: f64,
    has_gap: bool,
}

impl Between {
    fn at(time_s: &[f64], at_s: f64, fps: f64) -> Self {
        let after = time_s
            .partition_point(|&time_s| time_s < at_s)
            .min(time_s.len() - 1);
        let before = if time_s[after] > at_s {
            after.saturating_sub(1)
        } else {
            after
        };
        // A frame at almost the same time is taken as it is, whatever its neighbours are.
        let is_there = |frame: &usize| (time_s[*frame] - at_s).abs() <= EVEN_S;
        let (before, after) = match [before, after].into_iter().find(is_there) {
            Some(frame) => (frame, frame),
            None => (before, after),
        };
        let step_s = time_s[after] - time_s[before];
        Self {
            before,
            after,
            part: if step_s > 0.0 {
                (at_s - time_s[before]) / step_s
            } else {
                0.0
            },
            has_gap: step_s * fps > GAP,
        }
    }

    fn mix(&self, before: f64, after: f64) -> f64 {
        // Equal numbers stay the same, bit for bit.
        before + self.part * (after - before)
    }

    fn number(&self, numbers: &[f64]) -> f64 {
        self.mix(numbers[self.before], numbers[self.after])
    }

    fn row(&self, rows: &[Vec<f64>]) -> Vec<f64> {
        let pairs = rows[self.before].iter().zip(&rows[self.after]);
        pairs.map(|(&before, &after)| self.mix(before, after)).collect()
    }

    fn valid(&self, rows: &[Vec<bool>]) -> Vec<bool> {
        let pairs = rows[self.before].iter().zip(&rows[self.after]);
        pairs
            .map(|(before, after)| *before && *after && !self.has_gap)
            .collect()
    }

    fn pose(&self, poses: &[Pose]) -> Pose {
        let [before, after] = [self.before, self.after].map(|frame| &poses[frame]);
        Pose {
            position_mm: before.position_mm.lerp(after.position_mm, self.part),
            rotation: before.rotation.slerp(after.rotation, self.part).normalize(),
        }
    }
}
