//! The response of the gel while a press goes in and while it goes back.
//!
//! Without friction both are the same. With friction the indenter drags the gel along, first
//! inwards and then outwards. On the way back the response at the same depth is smaller, and the
//! loop between both is the work that friction takes. A location is computed once, in and back from
//! one turning point. A press that turns at another depth comes back on the same loop, scaled to
//! its turning point. This is exact if the contact grows in a self-similar way, as that of a ball
//! or a cone on a deep gel (Spence, J. Elasticity 5, 1975, p. 297), and accurate if the press turns
//! close to the computed point. A press that turns inwards again goes back along the same curve.

use twintac_depth_table::{MonotoneCubic, PressFrame};
use twintac_simulate::{Gel, Keyframe, PressPlace};

use crate::LabError;

/// A value as a function of the progress of a press: its depth, or its force.
pub(crate) struct Ways {
    inwards: MonotoneCubic,
    /// Difference of the way back to the way in. `None` without friction.
    backwards: Option<MonotoneCubic>,
    turn: f64,
}

impl Ways {
    /// `inwards` are values at increasing progress. `back` begins at the turning point, with the
    /// last value of `inwards`. Points of `back` that do not lie before the last kept one are left
    /// out. `None` if `inwards` gives no curve.
    pub(crate) fn new(inwards: Vec<[f64; 2]>, back: &[[f64; 2]]) -> Option<Self> {
        let turn = inwards.last()?[0];
        let [far, values] = columns(inwards);
        let inwards = MonotoneCubic::new(far, values)?;
        let mut kept: Vec<[f64; 2]> = Vec::new();
        for [far, value] in back {
            if kept.last().is_none_or(|before| *far < before[0]) {
                kept.push([*far, value - inwards.at(*far)]);
            }
        }
        kept.reverse();
        let [far, differences] = columns(kept);
        Some(Self {
            backwards: MonotoneCubic::new(far, differences),
            inwards,
            turn,
        })
    }

    /// The value at a progress on the way in.
    pub(crate) fn inwards(&self, far: f64) -> f64 {
        self.inwards.at(far)
    }

    /// The value at a progress `far`, after the press turned at `turn`. `share` is the ratio of the
    /// force at this turn to the force at the computed turn.
    pub(crate) fn back(&self, far: f64, turn: f64, share: f64) -> f64 {
        let differs = self.backwards.as_ref().filter(|_| far < turn);
        self.inwards.at(far) + differs.map_or(0.0, |backwards| share * backwards.at(far / turn * self.turn))
    }

    /// The progress at which the computed press turned.
    pub(crate) fn turn(&self) -> f64 {
        self.turn
    }
}

fn columns(points: Vec<[f64; 2]>) -> [Vec<f64>; 2] {
    let (far, values) = points.into_iter().map(|[far, value]| (far, value)).unzip();
    [far, values]
}

/// Presses to the depths of the frames again and comes back. Returns the frames of the way back,
/// from its turning point on.
pub(crate) fn way_back(
    gel: &Gel,
    place: &PressPlace,
    inwards: &[PressFrame],
    press: &str,
) -> Result<Vec<PressFrame>, LabError> {
    let turn = inwards.len().saturating_sub(1);
    let keyframes: Vec<Keyframe> = inwards[..turn]
        .iter()
        .chain(inwards.iter().rev())
        .map(|frame| Keyframe {
            time_s: 0.0,
            depth_mm: frame.depth_mm,
        })
        .collect();
    let place = PressPlace {
        enough_force_n: None,
        ..place.clone()
    };
    let history = gel
        .press(&place, &keyframes)
        .map_err(|source| LabError::Simulate {
            press: press.to_owned(),
            source,
        })?;
    match history.failure {
        Some(why) => Err(LabError::NotConverged {
            press: press.to_owned(),
            why: format!("during unloading {why}"),
        }),
        None => Ok(history.frames[turn..].to_vec()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A self-similar loop: `x^1.5` inwards, and a smaller value on the way back. The fraction
    /// depends on how far the press has gone back.
    fn ways(turn: f64) -> Ways {
        let far = |i: i32| turn * f64::from(i) / 40.0;
        let inwards = (0..=40).map(|i| [far(i), far(i).powf(1.5)]).collect();
        let back: Vec<[f64; 2]> = (0..=40).rev().map(|i| [far(i), back(far(i), turn)]).collect();
        Ways::new(inwards, &back).unwrap()
    }

    fn back(far: f64, turn: f64) -> f64 {
        far.powf(1.5) * (1.0 - 0.2 * (1.0 - far / turn))
    }

    #[test]
    fn a_press_that_turns_earlier_comes_back_on_a_smaller_loop() {
        let (ways, turn) = (ways(3.0), 2.2);
        let share = (turn / 3.0_f64).powf(1.5);
        for far in [0.1, 0.7, 1.5, 2.1, 2.2] {
            let found = ways.back(far, turn, share);
            assert!(
                (found - back(far, turn)).abs() < 2e-3,
                "{far}: {found} {}",
                back(far, turn)
            );
        }
        assert_eq!(ways.back(turn, turn, share), ways.inwards(turn));
    }

    #[test]
    fn without_a_way_back_both_are_the_same() {
        let ways = Ways::new(vec![[0.0, 0.0], [1.0, 2.0], [2.0, 5.0]], &[]).unwrap();
        for far in [0.0, 0.4, 1.9] {
            assert_eq!(ways.back(far, 2.0, 1.0), ways.inwards(far));
        }
    }
}
