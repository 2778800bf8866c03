//! What is wanted of a design: goals and needs.

use crate::{Figure, Figures};

/// What is wanted of a design: goals and needs.
#[derive(Clone, Debug, PartialEq)]
pub struct Wishes {
    /// Figures to optimize. The first three are the axes and the colour of the plot.
    pub goals: Vec<Figure>,
    /// Figures that have to be at least this good.
    pub needs: Vec<(Figure, f64)>,
}

impl Default for Wishes {
    fn default() -> Self {
        Self {
            goals: vec![
                Figure::RangeN,
                Figure::SmallestForceN,
                Figure::LocalizationErrorMm,
            ],
            needs: Vec::new(),
        }
    }
}

impl Wishes {
    /// Whether a design meets all needs.
    pub(crate) fn are_met(&self, figures: &Figures) -> bool {
        self.needs.iter().all(|(figure, needed)| {
            figure.of(figures).is_some_and(|value| {
                if figure.is_better_larger() {
                    value >= *needed
                } else {
                    value <= *needed
                }
            })
        })
    }

    /// Indices of the designs on the Pareto front, in order: no other design is at least as good in
    /// every goal and better in one.
    pub(crate) fn front(&self, designs: &[&Figures]) -> Vec<usize> {
        let bad =
            |design: &Figures| -> Vec<f64> { self.goals.iter().map(|goal| goal.badness(design)).collect() };
        let all: Vec<Vec<f64>> = designs.iter().map(|design| bad(design)).collect();
        let beats = |a: &[f64], b: &[f64]| {
            a.iter().zip(b).all(|(a, b)| a <= b) && a.iter().zip(b).any(|(a, b)| a < b)
        };
        (0..all.len())
            .filter(|&index| !all.iter().any(|other| beats(other, &all[index])))
            .collect()
    }

    /// The best of these designs: its worst goal is the best, with each goal scaled from 0 (best of
    /// all) to 1 (worst). Of equal designs the first.
    pub(crate) fn best(&self, designs: &[&Figures]) -> Option<usize> {
        let ranges: Vec<[f64; 2]> = self
            .goals
            .iter()
            .map(|goal| {
                let there = designs
                    .iter()
                    .map(|design| goal.badness(design))
                    .filter(|bad| bad.is_finite());
                there.fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], bad| {
                    [low.min(bad), high.max(bad)]
                })
            })
            .collect();
        let worst = |design: &Figures| {
            let scaled = self.goals.iter().zip(&ranges).map(|(goal, [low, high])| {
                let bad = goal.badness(design);
                if bad.is_finite() {
                    (bad - low) / (high - low).max(f64::MIN_POSITIVE)
                } else {
                    f64::INFINITY
                }
            });
            scaled.fold(0.0, f64::max)
        };
        let in_order = designs
            .iter()
            .enumerate()
            .map(|(index, design)| (worst(design), index));
        in_order
            .min_by(|a, b| a.0.total_cmp(&b.0))
            .map(|(_, index)| index)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::RangeEnd;

    fn design(range_n: f64, smallest_force_n: f64, localization_error_mm: Option<f64>) -> Figures {
        Figures {
            sensitivity_kpa_per_n: 1.0,
            sensitivity_between_kpa_per_n: None,
            depth_mm: 1.0,
            range_n,
            range_end: RangeEnd::Depth,
            cross_talk_percent: None,
            localization_error_mm,
            hysteresis_percent: None,
            smallest_force_n,
        }
    }

    #[test]
    fn what_another_beats_is_not_on_the_front() {
        let designs = [
            design(10.0, 0.1, Some(0.1)),
            design(9.0, 0.2, Some(0.2)),  // dominated by the first
            design(20.0, 0.3, Some(0.1)), // larger range
            design(5.0, 0.05, None),      // smaller force, but no location
            design(10.0, 0.1, Some(0.1)), // same goals as the first
        ];
        let designs: Vec<&Figures> = designs.iter().collect();
        assert_eq!(Wishes::default().front(&designs), [0, 2, 3, 4]);
        let range_alone = Wishes {
            goals: vec![Figure::RangeN],
            ..Wishes::default()
        };
        assert_eq!(range_alone.front(&designs), [2]);
    }

    #[test]
    fn the_best_is_bad_in_nothing() {
        let designs = [
            design(30.0, 1.0, Some(1.0)),
            design(20.0, 0.4, Some(0.4)),
            design(10.0, 0.1, Some(0.1)),
        ];
        let designs: Vec<&Figures> = designs.iter().collect();
        assert_eq!(Wishes::default().best(&designs), Some(1));
        assert_eq!(Wishes::default().best(&[]), None);
        let alone = [&design(1.0, 1.0, None)];
        assert_eq!(Wishes::default().best(&alone), Some(0));
    }

    #[test]
    fn needs_are_limits_on_the_good_side() {
        let wishes = Wishes {
            needs: vec![(Figure::RangeN, 10.0), (Figure::LocalizationErrorMm, 0.5)],
            ..Wishes::default()
        };
        assert!(wishes.are_met(&design(10.0, 1.0, Some(0.5))));
        assert!(!wishes.are_met(&design(9.9, 1.0, Some(0.5))));
        assert!(!wishes.are_met(&design(10.0, 1.0, Some(0.6))));
        assert!(!wishes.are_met(&design(10.0, 1.0, None)));
    }
}
