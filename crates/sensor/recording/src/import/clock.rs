//! The times of a file's rows: counters that roll over, clocks that pass midnight, and rows that
//! were written in bursts.

use super::cell::{DAY_S, Kind};
use super::description::{Repeated, TimeColumn};
use super::table::Table;
use super::unit::Time;

/// A decrease by at least this fraction of a counter's range is a roll-over. A smaller decrease is
/// a time out of order.
const ROLLED_OVER: f64 = 0.5;

/// The time of each row, s. Roll-overs are undone. For a clock the first row is at 0.
pub(crate) fn times_s(table: &Table, time: Option<&TimeColumn>) -> Vec<f64> {
    let Some(time) = time else {
        return vec![0.0; table.rows()];
    };
    let Some(name) = &time.column else {
        return vec![time.offset; table.rows()];
    };
    let is_clock = matches!(time.unit, Time::Clock);
    let counts = table.column(name, if is_clock { Kind::Clock } else { Kind::Number });
    // Dates do not wrap at midnight.
    let is_of_day = is_clock && counts.iter().all(|&count| count < DAY_S);
    let wraps_at = time.wraps_at.or(is_of_day.then_some(DAY_S));
    let mut times = unrolled(counts, wraps_at);
    if is_clock && let Some(&first) = times.first() {
        times.iter_mut().for_each(|time| *time -= first);
    }
    times.into_iter().map(|count| time.convert(count)).collect()
}

fn unrolled(counts: &[f64], wraps_at: Option<f64>) -> Vec<f64> {
    let Some(wraps_at) = wraps_at else {
        return counts.to_vec();
    };
    let mut turns = 0.0;
    let mut before = f64::NEG_INFINITY;
    let count = |&count: &f64| {
        if before - count >= ROLLED_OVER * wraps_at {
            turns += wraps_at;
        }
        before = count;
        count + turns
    };
    counts.iter().map(count).collect()
}

/// Spreads rows with the same time: they were measured one after the other, and arrived together.
pub(crate) fn spread(times_s: &mut [f64], repeated: Repeated) {
    let mut start = 0;
    let mut before_s = None;
    while start < times_s.len() {
        let at_s = times_s[start];
        let n_rows = times_s[start..]
            .iter()
            .take_while(|&&time_s| time_s == at_s)
            .count();
        let end = start + n_rows;
        let step_s = match repeated {
            Repeated::Error => return,
            Repeated::RateHz(rate_hz) => 1.0 / rate_hz,
            // A burst covers the time since the one before. The first burst covers as much as the
            // one after it.
            Repeated::Spread => {
                let next_s = times_s.get(end).map(|next_s| next_s - at_s);
                before_s
                    .map(|before_s: f64| at_s - before_s)
                    .or(next_s)
                    .unwrap_or(0.0)
                    / n_rows as f64
            }
        };
        for (later, time_s) in times_s[start..end].iter_mut().rev().enumerate() {
            *time_s = at_s - step_s * later as f64;
        }
        before_s = Some(at_s);
        start = end;
    }
}

/// What may help if times do not increase.
pub(crate) fn remedy(before: f64, now: f64, time: &TimeColumn) -> String {
    if now == before {
        return "rows that were written in bursts are read with `repeated = \"spread\"`, or `repeated = { rate_hz = … }`".to_owned();
    }
    let counted = (before - time.offset) / time.convert_step(1.0);
    let rolls_over = [16, 32]
        .map(|bits| 2f64.powi(bits))
        .into_iter()
        .chain([1e3, 1e6, 1e9]);
    let near = |&wraps_at: &f64| counted <= wraps_at && counted >= 0.98 * wraps_at;
    match rolls_over.into_iter().find(near) {
        Some(wraps_at) if time.wraps_at.is_none() => {
            format!("a counter that rolls over is read with `wraps_at = {wraps_at}`")
        }
        _ => "if the log was started again, split it into two files".to_owned(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_counter_goes_on_after_it_rolled_over() {
        assert_eq!(
            unrolled(&[60_000.0, 65_000.0, 4_464.0, 9_464.0], Some(65_536.0)),
            [60_000.0, 65_000.0, 70_000.0, 75_000.0]
        );
        // A time out of order is not a roll-over.
        assert_eq!(unrolled(&[10.0, 9.0], Some(65_536.0)), [10.0, 9.0]);
        assert_eq!(unrolled(&[10.0, 1.0], None), [10.0, 1.0]);
    }

    #[test]
    fn bursts_are_spread_over_the_time_since_the_last() {
        let spread = |times_s: &[f64], repeated| {
            let mut times_s = times_s.to_vec();
            spread(&mut times_s, repeated);
            times_s
        };
        assert_eq!(
            spread(&[1.0, 1.0, 2.0, 2.0, 3.0], Repeated::Spread),
            [0.5, 1.0, 1.5, 2.0, 3.0]
        );
        assert_eq!(spread(&[1.0, 1.0, 2.0], Repeated::RateHz(4.0)), [0.75, 1.0, 2.0]);
        assert_eq!(spread(&[1.0, 1.0], Repeated::Error), [1.0, 1.0]);
        assert_eq!(spread(&[1.0, 1.0], Repeated::Spread), [1.0, 1.0]);
    }
}
