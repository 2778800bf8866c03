//! The computed moments of a press.

use twintac_simulate::Keyframe;

/// Moments computed in a hold, as fractions of its duration. Most of them are early, because most
/// of the relaxation happens early.
const HOLD_FRACTIONS: [f64; 4] = [0.05, 0.2, 0.5, 1.0];

/// The first of them comes at most this long after the start of the hold, s. In long holds further
/// moments are added before it, each three times as early.
const FIRST_IN_HOLD_S: f64 = 0.2;

/// The moments to compute: whenever the depth has changed by a step, and some during a hold. While
/// the indenter is well above the gel, only the first gap is kept.
pub(crate) fn keyframes(schedule: &[(f64, f64)], deeper_mm: f64, step_mm: f64) -> Vec<Keyframe> {
    let mut chosen: Vec<Keyframe> = Vec::new();
    let mut at = 0;
    while at < schedule.len() {
        let (time_s, depth_mm) = schedule[at];
        let true_mm = depth_mm + deeper_mm;
        chosen.push(Keyframe {
            time_s,
            depth_mm: true_mm,
        });
        let hold_end = schedule[at..]
            .iter()
            .take_while(|(_, depth)| (depth - depth_mm).abs() < 1e-9)
            .count()
            + at
            - 1;
        if hold_end > at + 1 && true_mm > 0.0 {
            let hold = (hold_end - at) as f64;
            let hold_s = schedule[hold_end].0 - time_s;
            let mut last = at;
            for fraction in hold_fractions(hold_s) {
                let index = at + (fraction * hold).round() as usize;
                if index > last {
                    chosen.push(Keyframe {
                        time_s: schedule[index].0,
                        depth_mm: true_mm,
                    });
                    last = index;
                }
            }
            at = hold_end;
        }
        let from_mm = schedule[at].1;
        let next = schedule[at + 1..]
            .iter()
            .position(|(_, depth)| (depth - from_mm).abs() >= step_mm - 1e-9 || is_turn(schedule, *depth))
            .map(|offset| at + 1 + offset);
        match next {
            Some(index) => at = index,
            None if at + 1 < schedule.len() => at = schedule.len() - 1,
            None => break,
        }
    }
    chosen
}

/// The moments to compute in a hold of this duration, as fractions of it.
fn hold_fractions(hold_s: f64) -> Vec<f64> {
    let mut fractions = HOLD_FRACTIONS.to_vec();
    while fractions[0] * hold_s > FIRST_IN_HOLD_S {
        fractions.insert(0, fractions[0] / 3.0);
    }
    fractions
}

/// Whether a depth is the largest of the schedule. There the motion turns or holds.
fn is_turn(schedule: &[(f64, f64)], depth_mm: f64) -> bool {
    schedule.iter().all(|(_, other)| *other <= depth_mm + 1e-9)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn keyframes_keep_turns_and_ends() {
        let mut schedule: Vec<(f64, f64)> = (0..=60)
            .map(|i| (f64::from(i) * 0.02, -0.2 + f64::from(i) * 0.02))
            .collect();
        schedule.extend((1..=50).map(|i| (1.2 + f64::from(i) * 0.02, 1.0)));
        schedule.extend((1..=60).map(|i| (2.2 + f64::from(i) * 0.02, 1.0 - f64::from(i) * 0.02)));
        let chosen = keyframes(&schedule, 0.05, 0.25);
        assert!(chosen.windows(2).all(|pair| pair[0].time_s < pair[1].time_s));
        assert!(chosen.len() < 25, "{}", chosen.len());
        let deepest = chosen.iter().filter(|k| (k.depth_mm - 1.05).abs() < 1e-9).count();
        assert!(deepest >= 5, "start, inside and end of the hold: {deepest}");
        assert!((chosen.last().unwrap().time_s - schedule.last().unwrap().0).abs() < 1e-12);
    }
}
