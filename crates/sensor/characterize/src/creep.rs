//! Creep, from long holds.
//!
//! Creep is the change of the output under a constant load (ISA-37.1). A robot holds a depth, not a
//! load, and the force relaxes with the gel. Creep is therefore computed as the change of the ratio
//! of reading to force. The changes of reading and force are given as well.

use serde::Serialize;

use crate::recorded::Recorded;
use crate::statistics::mean;
use crate::{CharacterizeOptions, Finding};

/// The time window at the beginning of a hold, s after the hold began.
pub(crate) const BEGINS_S: [f64; 2] = [0.5, 1.5];

/// Length of the window at the end of a hold, s.
const ENDS_S: f64 = 1.0;

/// Change of a taxel's reading during a hold.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Creep {
    /// The press's name.
    pub press: String,
    /// The taxel's name.
    pub taxel: String,
    /// Middle of the first and of the last window, s after the hold began.
    pub between_s: [f64; 2],
    /// Creep: change of the ratio of reading to force, %.
    pub percent: f64,
    /// Change of the reading, %.
    pub reading_percent: f64,
    /// Change of the force, %.
    pub force_percent: f64,
}

pub(crate) fn creep(
    recorded: &[Recorded<'_>],
    taxels: &[String],
    options: &CharacterizeOptions,
) -> Finding<Vec<Creep>> {
    let long = recorded.iter().filter(|press| press.hold_s() >= options.long_s);
    let found = long.filter_map(|press| of_press(press, taxels));
    let why = format!(
        "no press above a taxel is held for {} s or longer",
        options.long_s
    );
    Finding::of_list(found.collect(), &why)
}

fn of_press(press: &Recorded<'_>, taxels: &[String]) -> Option<Creep> {
    let taxel = press.taxel?;
    let (hold, time_s) = (&press.phases.hold, &press.press.time_s);
    let (from_s, to_s) = (time_s[hold.start], time_s[hold.end - 1]);
    let window = |from_s: f64, to_s: f64| {
        let at = |edge_s: f64| hold.start + time_s[hold.clone()].partition_point(|time_s| *time_s < edge_s);
        let points = press.points(taxel, &(at(from_s)..at(to_s)));
        let force_n = mean(&points.iter().map(|point| point[0]).collect::<Vec<_>>())?;
        Some([
            force_n,
            mean(&points.iter().map(|point| point[1]).collect::<Vec<_>>())?,
        ])
    };
    let [force_n, reading_kpa] = window(from_s + BEGINS_S[0], from_s + BEGINS_S[1])?;
    let [last_n, last_kpa] = window(to_s - ENDS_S, to_s)?;
    let percent = |first: f64, last: f64| 100.0 * (last / first - 1.0);
    Some(Creep {
        press: press.press.name.clone(),
        taxel: taxels[taxel].clone(),
        between_s: [0.5 * (BEGINS_S[0] + BEGINS_S[1]), to_s - from_s - 0.5 * ENDS_S],
        percent: percent(reading_kpa / force_n, last_kpa / last_n),
        reading_percent: percent(reading_kpa, last_kpa),
        force_percent: percent(force_n, last_n),
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::synthetic::{Shape, all, press};

    #[test]
    fn a_slow_rise_under_a_constant_load_is_creep() {
        // 14 kPa + 0.014 kPa/s from the start of the hold: from 1 s to 19.5 s, 0.259 kPa of 14.014
        // kPa.
        let presses = [press(&Shape {
            hold_s: 20.0,
            reads: |force_n, phase, into_s| 7.0 * force_n + if phase == 1 { 0.014 * into_s } else { 0.0 },
            ..Shape::default()
        })];
        let finding = creep(
            &all(&presses),
            &["a".to_owned(), "b".to_owned()],
            &CharacterizeOptions::default(),
        );
        let found = &finding.found().unwrap()[0];
        let expected = 100.0 * 0.014 * (found.between_s[1] - 1.0) / 14.014;
        assert!((found.percent - expected).abs() < 0.01, "{found:?} {expected}");
        assert!(found.force_percent.abs() < 0.02);
    }

    #[test]
    fn short_holds_do_not_count() {
        let presses = [press(&Shape {
            hold_s: 5.0,
            ..Shape::default()
        })];
        let finding = creep(
            &all(&presses),
            &["a".to_owned(), "b".to_owned()],
            &CharacterizeOptions::default(),
        );
        assert!(finding.why_not().unwrap().contains("10 s"));
    }
}
