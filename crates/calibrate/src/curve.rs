//! Measured presses.

use glam::DQuat;
use twintac_shape::Shape;

use crate::CalibrateError;

/// Part of the depth's range by which a polygon through its turning points may be off.
const STRAIGHT: f64 = 0.005;

/// Part of a curve's duration that counts as soon after a turning point.
const SOON: f64 = 0.01;

/// What a signal measures.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Quantity {
    /// Force of the indenter on the gel along -z, N.
    Force,
    /// Reading of a taxel above its baseline, kPa: the pressure at its port times a gain that is its own. By index.
    Taxel(usize),
}

/// One quantity over a press.
#[derive(Clone, Debug, PartialEq)]
pub struct Signal {
    /// What was measured.
    pub quantity: Quantity,
    /// The numbers, in N or kPa; not a number where there is none that can be used. `[n_samples]`
    pub values: Vec<f64>,
}

/// One press, as it was measured.
#[derive(Clone, Debug, PartialEq)]
pub struct Curve {
    /// A name of its own.
    pub name: String,
    /// Shape of the indenter.
    pub shape: Shape,
    /// Place of the indenter's origin in the gel's plane, mm.
    pub x_mm: f64,
    /// Place of the indenter's origin in the gel's plane, mm.
    pub y_mm: f64,
    /// Tilt and spin of the indenter.
    pub rotation: DQuat,
    /// Time, s, increasing; `[n_samples]`. Of no matter to an elastic gel, but to the order of the samples.
    pub time_s: Vec<f64>,
    /// Depth below first touch, mm, as far as the bench knows; negative above the gel. `[n_samples]`
    pub depth_mm: Vec<f64>,
    /// What was measured meanwhile.
    pub signals: Vec<Signal>,
}

impl Curve {
    pub(crate) fn check(&self) -> Result<(), CalibrateError> {
        let refuse = |problem: String| {
            Err(CalibrateError::Curve {
                curve: self.name.clone(),
                problem,
            })
        };
        let n = self.time_s.len();
        if n < 2 {
            return refuse(format!("has {n} samples, expected 2 or more"));
        }
        let lengths = self.signals.iter().map(|signal| signal.values.len());
        if let Some(other) = lengths.chain([self.depth_mm.len()]).find(|length| *length != n) {
            return refuse(format!("has {n} times but {other} values beside them"));
        }
        if let Some(row) =
            (0..n).find(|&row| !(self.time_s[row].is_finite() && self.depth_mm[row].is_finite()))
        {
            return refuse(format!(
                "sample {} has a time or depth that is no number",
                row + 1
            ));
        }
        if let Some(row) = (1..n).find(|&row| self.time_s[row] <= self.time_s[row - 1]) {
            return refuse(format!(
                "the time of sample {} is {} s, expected more than the {} s before it",
                row + 1,
                self.time_s[row],
                self.time_s[row - 1]
            ));
        }
        if !self.depth_mm.iter().any(|depth_mm| *depth_mm > 0.0) {
            return refuse("never touches the gel: no depth is above 0 mm".into());
        }
        Ok(())
    }

    /// Indices of samples to simulate: all, or about as many as asked for: the turning points of the depth, and others spread evenly along
    /// depth and the logarithm of the time since the last turning point, as relaxation goes. Between them forces are straight in time.
    pub(crate) fn keyframes(&self, most: usize) -> Vec<usize> {
        let n = self.time_s.len();
        if n <= most {
            return (0..n).collect();
        }
        let [low, high] = self
            .depth_mm
            .iter()
            .fold([f64::MAX, f64::MIN], |[low, high], depth_mm| {
                [low.min(*depth_mm), high.max(*depth_mm)]
            });
        let range_mm = (high - low).max(f64::MIN_POSITIVE);
        let soon_s = SOON * (self.time_s[n - 1] - self.time_s[0]);
        let mut chosen = self.corners(STRAIGHT * range_mm);
        chosen.sort_unstable();
        let mut corners = chosen.iter().copied().peekable();
        let mut corner_s = self.time_s[0];
        let mut along = vec![0.0];
        for row in 1..n {
            let since_s = |row: usize| self.time_s[row] - corner_s + soon_s;
            let step = (since_s(row) / since_s(row - 1)).ln()
                + (self.depth_mm[row] - self.depth_mm[row - 1]).abs() / range_mm;
            along.push(along[row - 1] + step);
            while corners.next_if(|&corner| corner <= row).is_some() {
                corner_s = self.time_s[row];
            }
        }
        let total = along[n - 1];
        chosen.extend((0..most).map(|i| {
            let wanted = total * i as f64 / (most - 1) as f64;
            along.partition_point(|at| *at < wanted).min(n - 1)
        }));
        chosen.sort_unstable();
        chosen.dedup();
        chosen
    }

    /// Samples that a polygon through the depths needs to stay this close to them (Ramer, 1972; Douglas and Peucker, 1973).
    fn corners(&self, within_mm: f64) -> Vec<usize> {
        let n = self.time_s.len();
        let mut found = vec![0, n - 1];
        let mut pending = vec![(0, n - 1)];
        while let Some((from, to)) = pending.pop() {
            let line = |row: usize| {
                let part = (self.time_s[row] - self.time_s[from]) / (self.time_s[to] - self.time_s[from]);
                self.depth_mm[from] + part * (self.depth_mm[to] - self.depth_mm[from])
            };
            let off = |row: &usize| (self.depth_mm[*row] - line(*row)).abs();
            let worst = (from + 1..to).max_by(|a, b| off(a).total_cmp(&off(b)));
            if let Some(worst) = worst.filter(|worst| off(worst) > within_mm) {
                found.push(worst);
                pending.extend([(from, worst), (worst, to)]);
            }
        }
        found
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn frames_stand_at_turning_points_and_close_behind_them() {
        let time_s: Vec<f64> = (0..=2000).map(|i| 0.01 * f64::from(i)).collect();
        let curve = Curve {
            name: "press".into(),
            shape: Shape::Sphere { radius_mm: 1.0 },
            x_mm: 0.0,
            y_mm: 0.0,
            rotation: DQuat::IDENTITY,
            depth_mm: time_s.iter().map(|t| t.min(2.0).min(20.0 - t)).collect(),
            time_s,
            signals: Vec::new(),
        };
        let frames = curve.keyframes(60);
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
        assert_eq!(curve.keyframes(5000).len(), 2001);
    }
}
