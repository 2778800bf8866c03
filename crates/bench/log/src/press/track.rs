//! A quantity that is known at some times.

/// Increasing times, ns, with values, and the intervals in which the value is unknown.
#[derive(Clone, Debug)]
pub(super) struct Track<T> {
    points: Vec<(u64, T)>,
    /// Whether there is a gap before the point.
    is_broken: Vec<bool>,
}

/// Values that can be interpolated.
pub(super) trait Interpolate: Copy {
    /// The value at a fraction of the way, from 0 to 1.
    fn between(self, other: Self, fraction: f64) -> Self;
}

impl Interpolate for f64 {
    fn between(self, other: Self, fraction: f64) -> Self {
        self + fraction * (other - self)
    }
}

impl Interpolate for twintac_shape::Pose {
    fn between(self, other: Self, fraction: f64) -> Self {
        Self {
            position_mm: self.position_mm.lerp(other.position_mm, fraction),
            rotation: self.rotation.slerp(other.rotation, fraction).normalize(),
        }
    }
}

impl<T: Interpolate> Track<T> {
    /// Points in any order: time, value, and whether readings were lost before it. Of several
    /// points at one time the first one is kept.
    pub(super) fn new(mut points: Vec<(u64, T, bool)>, longest_ns: u64) -> Self {
        points.sort_by_key(|(time_ns, ..)| *time_ns);
        points.dedup_by_key(|(time_ns, ..)| *time_ns);
        let mut before_ns = None;
        let is_broken = points.iter().map(|(time_ns, _, is_after_loss)| {
            let is_long = before_ns.is_none_or(|before_ns| time_ns - before_ns > longest_ns);
            before_ns = Some(*time_ns);
            *is_after_loss || is_long
        });
        let is_broken = is_broken.collect();
        Self {
            points: points
                .into_iter()
                .map(|(time_ns, value, _)| (time_ns, value))
                .collect(),
            is_broken,
        }
    }

    pub(super) fn is_empty(&self) -> bool {
        self.points.is_empty()
    }

    /// Marks the value as unknown from one time to another, including both, except at the points
    /// themselves.
    pub(super) fn break_between(&mut self, from_ns: u64, to_ns: u64) {
        let first = self.points.partition_point(|(time_ns, _)| *time_ns < from_ns);
        let behind = self.points.partition_point(|(time_ns, _)| *time_ns <= to_ns);
        for is_broken in self.is_broken.iter_mut().take(behind + 1).skip(first) {
            *is_broken = true;
        }
    }

    /// The value at a time, if it is known or lies between two known values without a gap.
    pub(super) fn at(&self, time_ns: u64) -> Option<T> {
        let next = self.points.partition_point(|(at_ns, _)| *at_ns < time_ns);
        let (next_ns, next_value) = *self.points.get(next)?;
        if next_ns == time_ns {
            return Some(next_value);
        }
        let (before_ns, before) = *self.points.get(next.checked_sub(1)?)?;
        let fraction = (time_ns - before_ns) as f64 / (next_ns - before_ns) as f64;
        (!self.is_broken[next]).then(|| before.between(next_value, fraction))
    }

    /// The known value that is nearest to a time.
    pub(super) fn nearest(&self, time_ns: u64) -> Option<T> {
        let next = self.points.partition_point(|(at_ns, _)| *at_ns < time_ns);
        let around = self.points.get(next.saturating_sub(1)..)?.iter().take(2);
        let nearest = around.min_by_key(|(at_ns, _)| at_ns.abs_diff(time_ns))?;
        Some(nearest.1)
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    fn track() -> Track<f64> {
        let points = [
            (10, 1.0, false),
            (20, 2.0, false),
            (30, 3.0, true),
            (99, 4.0, false),
        ];
        Track::new(points.to_vec(), 50)
    }

    #[test]
    fn values_are_interpolated_but_not_across_gaps_nor_beyond_the_ends() {
        let track = track();
        let at: Vec<Option<f64>> = [9, 10, 15, 20, 25, 30, 60, 99, 100]
            .into_iter()
            .map(|time_ns| track.at(time_ns))
            .collect();
        let [one, half, two] = [Some(1.0), Some(1.5), Some(2.0)];
        let expected = [None, one, half, two, None, Some(3.0), None, Some(4.0), None];
        assert_eq!(at, expected);
    }

    #[test]
    fn a_gap_that_is_told_breaks_what_it_touches() {
        for (from_ns, to_ns, is_known) in [
            (12, 13, false),
            (20, 20, false),
            (21, 29, true),
            (1, 9, true),
            (1, 10, false),
        ] {
            let mut track = track();
            track.break_between(from_ns, to_ns);
            assert_eq!(track.at(15).is_some(), is_known, "{from_ns} to {to_ns}");
        }
    }

    proptest! {
        /// A value is known at points, and between two points that are near enough and have no gap
        /// between them or at their own times.
        #[test]
        fn a_value_is_known_just_where_nothing_is_missing(
            times_ns in prop::collection::btree_set(0..100_u64, 0..20),
            gaps_ns in prop::collection::vec((0..100_u64, 0..10_u64), 0..4),
            longest_ns in 0..40_u64,
        ) {
            let points = times_ns.iter().map(|time_ns| (*time_ns, *time_ns as f64, false));
            let mut track = Track::new(points.rev().collect(), longest_ns);
            for (from_ns, length_ns) in &gaps_ns {
                track.break_between(*from_ns, from_ns + length_ns);
            }
            for time_ns in 0..101 {
                let before = times_ns.range(..time_ns).next_back();
                let next = times_ns.range(time_ns..).next();
                let is_known = times_ns.contains(&time_ns)
                    || before.zip(next).is_some_and(|(before, next)| {
                        let is_gap = |(from_ns, length_ns): &(u64, u64)| {
                            from_ns <= next && from_ns + length_ns >= *before
                        };
                        next - before <= longest_ns && !gaps_ns.iter().any(is_gap)
                    });
                let found = track.at(time_ns);
                prop_assert_eq!(found.is_some(), is_known, "at {}", time_ns);
                prop_assert!(found.is_none_or(|found| (found - time_ns as f64).abs() < 1e-9));
            }
        }
    }

    #[test]
    fn the_nearest_is_found() {
        let track = track();
        let nearest: Vec<Option<f64>> = [0, 14, 16, 50, 90, 200]
            .into_iter()
            .map(|time_ns| track.nearest(time_ns))
            .collect();
        assert_eq!(nearest, [1.0, 1.0, 2.0, 3.0, 4.0, 4.0].map(Some));
        assert_eq!(Track::<f64>::new(Vec::new(), 1).nearest(5), None);
    }
}
