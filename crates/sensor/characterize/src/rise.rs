//! Rise time, from fast presses.
//!
//! It is the time from 10 to 90 % of the largest reading of a loading (IEC 61298-2), given beside
//! that of the force. A reading that rises as fast as the force is limited by the press: its own
//! rise time is only known to be shorter.

use serde::Serialize;
use twintac_recording::Control;

use crate::phases::duration_s;
use crate::recorded::Recorded;
use crate::statistics::median;
use crate::{CharacterizeOptions, Finding};

/// By how many frames the rise of a reading has to exceed that of the force to count as slower.
const SLOWER_FRAMES: f64 = 1.0;

/// How fast readings follow the force; medians over fast presses.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct RiseTime {
    /// Time from 10 to 90 % of the largest reading, s.
    pub rise_s: f64,
    /// Time from 10 to 90 % of the largest force, s.
    pub force_rise_s: f64,
    /// Time at which the reading reaches half of its largest value, minus the same for the force,
    /// s. It includes the offset between clocks.
    pub delay_s: f64,
    /// Time between frames, s: the resolution of these times.
    pub frame_s: f64,
    /// Whether the reading rises as fast as the force, within a frame: then the sensor's own rise
    /// time is not visible.
    pub is_as_fast_as_force: bool,
    /// Number of presses it was found from.
    pub n_presses: usize,
    /// Name of the first of these presses.
    pub example: String,
}

pub(crate) fn rise_time(recorded: &[Recorded<'_>], options: &CharacterizeOptions) -> Finding<RiseTime> {
    let fast: Vec<(&Recorded<'_>, Rise)> = recorded
        .iter()
        .filter(|press| press.press.control == Control::Pose)
        .filter_map(|press| Some((press, Rise::of(press)?)))
        .filter(|(_, rise)| rise.force[1] - rise.force[0] <= options.fast_s)
        .collect();
    let of = |value: fn(&Rise) -> f64| median(&fast.iter().map(|(_, rise)| value(rise)).collect::<Vec<_>>());
    let found = || {
        let (rise_s, force_rise_s) = (
            of(|rise| rise.reading[1] - rise.reading[0])?,
            of(|rise| rise.force[1] - rise.force[0])?,
        );
        let frame_s = of(|rise| rise.frame_s)?;
        Some(RiseTime {
            rise_s,
            force_rise_s,
            delay_s: of(|rise| rise.reading[2] - rise.force[2])?,
            frame_s,
            is_as_fast_as_force: rise_s <= force_rise_s + SLOWER_FRAMES * frame_s,
            n_presses: fast.len(),
            example: fast[0].0.press.name.clone(),
        })
    };
    found().map_or_else(
        || {
            Finding::NotGiven(format!(
                "in no press above a taxel does the force rise from 10 to 90 % in {} s or less",
                options.fast_s
            ))
        },
        Finding::Found,
    )
}

/// Times at which the reading and the force pass 10, 90 and 50 % of their largest value, s.
struct Rise {
    reading: [f64; 3],
    force: [f64; 3],
    frame_s: f64,
}

impl Rise {
    fn of(press: &Recorded<'_>) -> Option<Self> {
        let taxel = press.taxel?;
        let frames = press.phases.rest.end..press.phases.hold.end;
        if press.hold_s() < 3.0 * duration_s(press.press, &press.phases.loading) {
            return None;
        }
        if frames.clone().any(|frame| !press.press.valid[frame][taxel]) {
            return None;
        }
        let course = |value: &dyn Fn(usize) -> f64| -> Vec<[f64; 2]> {
            frames
                .clone()
                .map(|frame| [press.press.time_s[frame], value(frame)])
                .collect()
        };
        let reading = course(&|frame| press.press.taxels_kpa[frame][taxel]);
        let force = course(&|frame| press.force_n(frame));
        Some(Self {
            reading: passes(&reading)?,
            force: passes(&force)?,
            frame_s: (reading[reading.len() - 1][0] - reading[0][0]) / (reading.len() - 1) as f64,
        })
    }
}

/// Times at which a curve first passes 10, 90 and 50 % of its largest value.
fn passes(course: &[[f64; 2]]) -> Option<[f64; 3]> {
    let most = course
        .iter()
        .map(|point| point[1])
        .fold(f64::NEG_INFINITY, f64::max);
    let at = |part: f64| {
        let level = part * most;
        let behind = course.iter().position(|point| point[1] >= level)?;
        let (left, right) = (course[behind.checked_sub(1)?], course[behind]);
        Some(left[0] + (right[0] - left[0]) * (level - left[1]) / (right[1] - left[1]))
    };
    Some([at(0.1)?, at(0.9)?, at(0.5)?])
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::synthetic::{Shape, all, press};

    #[test]
    fn a_ramp_takes_eight_tenths_of_its_length() {
        let presses = [press(&Shape {
            loading_s: 0.1,
            hold_s: 1.0,
            rate_hz: 1000.0,
            ..Shape::default()
        })];
        let finding = rise_time(&all(&presses), &CharacterizeOptions::default());
        let found = finding.found().unwrap();
        assert!(
            (found.rise_s - 0.08).abs() < 1e-6 && (found.force_rise_s - 0.08).abs() < 1e-6,
            "{found:?}"
        );
        assert!(found.delay_s.abs() < 1e-6 && found.is_as_fast_as_force);
    }

    #[test]
    fn a_first_order_lag_is_told_from_the_force() {
        // 14 (1 - exp(-t / 0.1 s)) kPa after a ramp of 10 ms: the rise time is ln 9 time constants.
        let presses = [press(&Shape {
            loading_s: 0.01,
            hold_s: 2.0,
            rate_hz: 1000.0,
            reads: |_, phase, into_s| {
                if phase == 1 {
                    14.0 * (1.0 - (-into_s / 0.1).exp())
                } else {
                    0.0
                }
            },
            ..Shape::default()
        })];
        let finding = rise_time(&all(&presses), &CharacterizeOptions::default());
        let found = finding.found().unwrap();
        assert!(
            (found.rise_s / (0.1 * 9.0_f64.ln()) - 1.0).abs() < 0.01,
            "{found:?}"
        );
        assert!(!found.is_as_fast_as_force);
    }
}
