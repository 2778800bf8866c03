//! The phases of a press: rest, loading, hold, unloading, rest.

use std::ops::Range;

use twintac_recording::{Control, Press};

use crate::statistics::{deviation, mean};

/// Limits of the number of frames before contact from which the noise of the force is computed. The
/// number is a twentieth of all frames within these limits.
const FRAMES: [usize; 2] = [4, 20];

/// Number of standard deviations of the unloaded force above which a contact begins.
const CONTACT_SIGMAS: f64 = 5.0;

/// Fraction of the largest force that a contact exceeds at least.
const CONTACT_PART: f64 = 0.005;

/// Largest difference of a hold from the deepest point or the largest force, as a fraction of the
/// whole.
const HOLD_PART: f64 = 0.01;

/// The phases of a press, as ranges of frames.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct Phases {
    /// Nothing touches. Of a robot's approach only the first half, because taxels feel a light
    /// touch before the force sensor shows it.
    pub(crate) rest: Range<usize>,
    /// From contact to the hold.
    pub(crate) loading: Range<usize>,
    /// At full depth, or under the full weight.
    pub(crate) hold: Range<usize>,
    /// From the hold to the loss of contact.
    pub(crate) unloading: Range<usize>,
    /// Nothing touches any more. Of a robot's retreat only the last half.
    pub(crate) rest_after: Range<usize>,
}

impl Phases {
    /// `None` for a press without a known force, or without contact.
    pub(crate) fn of(press: &Press) -> Option<Self> {
        let force_n = press.force_n.as_ref()?;
        let n = force_n.len();
        let most_n = force_n.iter().copied().fold(f64::NEG_INFINITY, f64::max);
        let is_weight = press.control == Control::Force;
        let threshold_n = if is_weight {
            CONTACT_PART * most_n
        } else {
            let early = &force_n[..(n / 20).clamp(FRAMES[0], FRAMES[1]).min(n)];
            let (zero_n, noise_n) = (mean(early)?, deviation(early)?);
            (zero_n + CONTACT_SIGMAS * noise_n).max(CONTACT_PART * most_n)
        };
        if most_n <= threshold_n || most_n <= 0.0 {
            return None;
        }
        let peak = (0..n).max_by(|&a, &b| force_n[a].total_cmp(&force_n[b]))?;
        let is_off = |frame: &usize| force_n[*frame] <= threshold_n;
        let contact = (0..peak).rev().find(is_off).map_or(0, |frame| frame + 1);
        let lost = (peak..n).find(is_off).unwrap_or(n);
        // The controlled quantity: the depth of a robot, the force of a weight.
        let lead = |frame: usize| {
            if is_weight {
                force_n[frame]
            } else {
                -press.gel_from_indenter[frame].position_mm.z
            }
        };
        let most = (contact..lost).map(lead).fold(f64::NEG_INFINITY, f64::max);
        let least = if is_weight { 0.0 } else { lead(contact) };
        let is_held = |frame: &usize| lead(*frame) >= most - HOLD_PART * (most - least);
        let hold_from = (contact..lost).find(is_held)?;
        let hold_to = (contact..lost).rev().find(is_held)? + 1;
        let [half, half_after] = if is_weight {
            [contact, lost]
        } else {
            [contact / 2, lost + (n - lost) / 2]
        };
        Some(Self {
            rest: 0..half,
            loading: contact..hold_from,
            hold: hold_from..hold_to,
            unloading: hold_to..lost,
            rest_after: half_after..n,
        })
    }
}

/// Duration of a phase, s: from its first frame to the frame after its last one, if the press has
/// that frame.
pub(crate) fn duration_s(press: &Press, phase: &Range<usize>) -> f64 {
    let behind = phase.end.min(press.time_s.len() - 1);
    if phase.is_empty() {
        0.0
    } else {
        press.time_s[behind] - press.time_s[phase.start]
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::synthetic::{Shape, press};

    #[test]
    fn a_trapezoid_is_cut_at_its_corners() {
        let press = press(&Shape {
            loading_s: 2.0,
            hold_s: 1.0,
            ..Shape::default()
        });
        let phases = Phases::of(&press).unwrap();
        let at_s = |frame: usize| press.time_s[frame];
        assert!(
            (at_s(phases.loading.start) - 1.0).abs() < 0.06,
            "{}",
            at_s(phases.loading.start)
        );
        assert!((at_s(phases.hold.start) - 3.0).abs() < 0.05);
        assert!((at_s(phases.hold.end) - 4.0).abs() < 0.05);
        assert!((at_s(phases.unloading.end) - 6.0).abs() < 0.06);
        assert!(at_s(phases.rest.end) < 0.55 && at_s(phases.rest_after.start) > 6.4);
        assert!((duration_s(&press, &phases.hold) - 1.0).abs() < 0.06);
    }

    #[test]
    fn a_press_that_never_touches_has_no_phases() {
        let press = press(&Shape {
            peak_n: 0.0,
            ..Shape::default()
        });
        assert_eq!(Phases::of(&press), None);
    }
}
