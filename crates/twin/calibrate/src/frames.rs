//! Which frames of a press are simulated, and the interpolation of the samples between them.

use crate::Curve;

/// Largest deviation of the depth from the polygon through its turning points, as a fraction of the
/// range of depth.
const STRAIGHT: f64 = 0.005;

/// Added to the time since a turning point, as a fraction of the curve's duration, before its
/// logarithm is taken.
const SOON: f64 = 0.01;

/// Number of frames that a sample is interpolated from.
const ORDER: usize = 4;

/// Which samples of a press are simulated, and how the others are interpolated from them.
pub(crate) struct Frames {
    /// Indices of the samples.
    pub(crate) rows: Vec<usize>,
    /// For each sample, the frames that it is interpolated from and their weights. The
    /// interpolation is a cubic through these frames, which are all on the same side of each
    /// turning point of the depth.
    pub(crate) parts: Vec<Vec<(usize, f64)>>,
}

impl Frames {
    /// All samples, or about `most` of them: the turning points of the depth, and others spread
    /// evenly along depth and the logarithm of the time since the last turning point, because
    /// materials relax on a logarithmic scale of time.
    pub(crate) fn new(curve: &Curve, most: usize) -> Self {
        let n = curve.time_s.len();
        if n <= most {
            return Self {
                rows: (0..n).collect(),
                parts: (0..n).map(|row| vec![(row, 1.0)]).collect(),
            };
        }
        let [low, high] = curve
            .depth_mm
            .iter()
            .fold([f64::MAX, f64::MIN], |[low, high], depth_mm| {
                [low.min(*depth_mm), high.max(*depth_mm)]
            });
        let range_mm = (high - low).max(f64::MIN_POSITIVE);
        let corners = corners(curve, STRAIGHT * range_mm);
        let along = lengths(curve, &corners, range_mm);
        let total = along[n - 1];
        let mut rows = corners.clone();
        rows.extend((0..most).map(|i| {
            let wanted = total * i as f64 / (most - 1) as f64;
            along.partition_point(|at| *at < wanted).min(n - 1)
        }));
        rows.sort_unstable();
        rows.dedup();
        let parts = (0..n).map(|row| parts(curve, &rows, &corners, row)).collect();
        Self { rows, parts }
    }

    /// The value of a sample, interpolated from the values of the frames.
    pub(crate) fn sample(&self, row: usize, of_frame: impl Fn(usize) -> f64) -> f64 {
        self.parts[row]
            .iter()
            .map(|&(frame, part)| part * of_frame(frame))
            .sum()
    }
}

/// Lengths along which frames are spread, up to each sample; `[n_samples]`.
fn lengths(curve: &Curve, corners: &[usize], range_mm: f64) -> Vec<f64> {
    let Curve { time_s, depth_mm, .. } = curve;
    let n = time_s.len();
    let soon_s = SOON * (time_s[n - 1] - time_s[0]);
    let mut corners = corners.iter().copied().peekable();
    let mut corner_s = time_s[0];
    let mut along = vec![0.0];
    for row in 1..n {
        let since_s = |row: usize| time_s[row] - corner_s + soon_s;
        let step =
            (since_s(row) / since_s(row - 1)).ln() + (depth_mm[row] - depth_mm[row - 1]).abs() / range_mm;
        along.push(along[row - 1] + step);
        while corners.next_if(|&corner| corner <= row).is_some() {
            corner_s = time_s[row];
        }
    }
    along
}

/// The samples that a polygon needs as corners to stay this close to the depths (Ramer, 1972;
/// Douglas and Peucker, 1973), in order.
fn corners(curve: &Curve, within_mm: f64) -> Vec<usize> {
    let Curve { time_s, depth_mm, .. } = curve;
    let last = time_s.len() - 1;
    let mut found = vec![0, last];
    let mut pending = vec![(0, last)];
    while let Some((from, to)) = pending.pop() {
        let line = |row: usize| {
            let part = (time_s[row] - time_s[from]) / (time_s[to] - time_s[from]);
            depth_mm[from] + part * (depth_mm[to] - depth_mm[from])
        };
        let off = |row: &usize| (depth_mm[*row] - line(*row)).abs();
        let worst = (from + 1..to).max_by(|a, b| off(a).total_cmp(&off(b)));
        if let Some(worst) = worst.filter(|worst| off(worst) > within_mm) {
            found.push(worst);
            pending.extend([(from, worst), (worst, to)]);
        }
    }
    found.sort_unstable();
    found
}

/// Weights of Lagrange's polynomial through the frames around a sample.
fn parts(curve: &Curve, rows: &[usize], corners: &[usize], row: usize) -> Vec<(usize, f64)> {
    let frame_at = |row: usize| rows.partition_point(|&other| other < row);
    let end = corners.partition_point(|&corner| corner < row).max(1);
    let [first, last] = [corners[end - 1], corners[end]].map(frame_at);
    let count = ORDER.min(last - first + 1);
    let start = frame_at(row)
        .saturating_sub(ORDER / 2)
        .clamp(first, last + 1 - count);
    let stencil = start..start + count;
    let time_s = |frame: usize| curve.time_s[rows[frame]];
    let part = |frame: usize| -> f64 {
        let others = stencil.clone().filter(|&other| other != frame);
        let quotient = |other| (curve.time_s[row] - time_s(other)) / (time_s(frame) - time_s(other));
        others.map(quotient).product()
    };
    stencil.clone().map(|frame| (frame, part(frame))).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::DQuat;
    use twintac_shape::Shape;

    /// Moved in during 2 s, held for 16 s, moved out.
    fn press() -> Curve {
        let time_s: Vec<f64> = (0..=2000).map(|i| 0.01 * f64::from(i)).collect();
        Curve {
            friction: 0.0,
            name: "press".into(),
            shape: Shape::Sphere { radius_mm: 1.0 },
            x_mm: 0.0,
            y_mm: 0.0,
            rotation: DQuat::IDENTITY,
            depth_mm: time_s.iter().map(|t| t.min(2.0).min(20.0 - t)).collect(),
            time_s,
            signals: Vec::new(),
        }
    }

    #[test]
    fn frames_stand_at_turning_points_and_close_behind_them() {
        let frames = Frames::new(&press(), 60).rows;
        assert!((55..=64).contains(&frames.len()), "{}", frames.len());
        for corner in [0, 200, 1800, 2000] {
            assert!(frames.contains(&corner), "{corner} is not in {frames:?}");
        }
        let gap = |from: usize| {
            frames
                .windows(2)
                .find(|pair| pair[0] >= from)
                .map_or(0, |pair| pair[1] - pair[0])
        };
        assert!(gap(200) <= 10 && gap(1000) > 50, "{frames:?}");
        assert_eq!(Frames::new(&press(), 5000).rows.len(), 2001);
    }

    #[test]
    fn samples_between_frames_follow_a_relaxing_force() {
        let curve = press();
        let force = |row: usize| {
            let depth = curve.depth_mm[row];
            depth * depth * (1.0 + 0.3 * (-curve.time_s[row]).exp())
        };
        let frames = Frames::new(&curve, 60);
        for row in 0..curve.time_s.len() {
            let found = frames.sample(row, |frame| force(frames.rows[frame]));
            assert!(
                (found - force(row)).abs() < 2e-4 * 4.0,
                "{row}: {found} for {}",
                force(row)
            );
        }
    }
}
