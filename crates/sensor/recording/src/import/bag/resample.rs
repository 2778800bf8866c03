//! Interpolates the messages of one topic at the times of another.

/// Largest distance between two messages for interpolation, ns. For slow topics it is two periods.
const WITHIN_NS: i64 = 20_000_000;

/// Positions of the rows between the messages of another topic.
pub(super) struct Between {
    /// For each row: the message before, the message after, and the fraction of the way between
    /// them. `None` if they are too far apart or one does not exist.
    places: Vec<Option<(usize, usize, f64)>>,
    /// For each row: the last message before it.
    latest: Vec<Option<usize>>,
    /// Largest distance between two messages, ns.
    pub(super) within_ns: i64,
}

impl Between {
    /// Times of messages and of rows, ns; neither may decrease.
    pub(super) fn new(messages_ns: &[i64], rows_ns: &[i64]) -> Self {
        let within_ns = WITHIN_NS.max(usual_step_ns(messages_ns).saturating_mul(2));
        let latest = |row_ns: &i64| {
            messages_ns
                .partition_point(|message_ns| message_ns <= row_ns)
                .checked_sub(1)
        };
        let place = |row_ns: &i64| {
            let before = latest(row_ns)?;
            if messages_ns[before] == *row_ns {
                return Some((before, before, 0.0));
            }
            let step_ns = messages_ns.get(before + 1)?.saturating_sub(messages_ns[before]);
            let part = row_ns.saturating_sub(messages_ns[before]) as f64 / step_ns as f64;
            (step_ns <= within_ns).then_some((before, before + 1, part))
        };
        Self {
            places: rows_ns.iter().map(place).collect(),
            latest: rows_ns.iter().map(latest).collect(),
            within_ns,
        }
    }

    /// Whether a row has messages on both sides.
    pub(super) fn is_known(&self, row: usize) -> bool {
        self.places[row].is_some()
    }

    /// Number of rows without messages on both sides.
    pub(super) fn n_unknown(&self) -> usize {
        self.places.iter().filter(|place| place.is_none()).count()
    }

    /// Linear interpolation at each row; NaN for a row without messages on both sides.
    pub(super) fn line(&self, numbers: &[f64]) -> Vec<f64> {
        self.each(|before, after, part| before + part * (after - before), numbers)
    }

    /// As [`line`](Self::line), but if one of the two numbers is out of bounds, that number is
    /// taken.
    pub(super) fn line_within(&self, numbers: &[f64], [lowest, highest]: [f64; 2]) -> Vec<f64> {
        let is_outside = |number: f64| !(lowest..=highest).contains(&number);
        let between = |before: f64, after: f64, part: f64| match [before, after].map(is_outside) {
            [true, _] => before,
            [false, true] => after,
            _ => before + part * (after - before),
        };
        self.each(between, numbers)
    }

    /// The number of the last message before each row, however old; NaN before the first message.
    pub(super) fn latest(&self, numbers: &[f64]) -> Vec<f64> {
        let number = |message: &Option<usize>| message.map_or(f64::NAN, |message| numbers[message]);
        self.latest.iter().map(number).collect()
    }

    fn each(&self, between: impl Fn(f64, f64, f64) -> f64, numbers: &[f64]) -> Vec<f64> {
        let number = |place: &Option<(usize, usize, f64)>| match *place {
            None => f64::NAN,
            Some((before, after, _)) if before == after => numbers[before],
            Some((before, after, part)) => between(numbers[before], numbers[after], part),
        };
        self.places.iter().map(number).collect()
    }
}

/// The median step, ns.
fn usual_step_ns(times_ns: &[i64]) -> i64 {
    let mut steps: Vec<i64> = times_ns
        .windows(2)
        .map(|pair| pair[1].saturating_sub(pair[0]))
        .collect();
    steps.sort_unstable();
    steps.get(steps.len() / 2).copied().unwrap_or(0)
}

#[cfg(test)]
mod tests {
    use super::*;

    const MS: i64 = 1_000_000;

    fn between(messages_ms: &[i64], rows_ms: &[i64]) -> Between {
        let ns = |times_ms: &[i64]| times_ms.iter().map(|time_ms| time_ms * MS).collect::<Vec<i64>>();
        Between::new(&ns(messages_ms), &ns(rows_ms))
    }

    /// As text, because NaN is not equal to itself.
    fn text(numbers: &[f64]) -> String {
        format!("{numbers:?}")
    }

    #[test]
    fn what_lies_between_two_messages_is_known_and_nothing_beyond_or_across_a_gap() {
        let found = between(&[0, 10, 20, 50, 60], &[-1, 0, 5, 20, 30, 50, 59, 61]);
        assert_eq!(found.within_ns, 20 * MS);
        let numbers = [0.0, 1.0, 2.0, 5.0, 6.0];
        let line = text(&found.line(&numbers));
        assert_eq!(line, "[NaN, 0.0, 0.5, 2.0, NaN, 5.0, 5.9, NaN]");
        assert_eq!(found.n_unknown(), 3);
        assert!(!found.is_known(0) && found.is_known(1));
        let latest = text(&found.latest(&numbers));
        assert_eq!(latest, "[NaN, 0.0, 0.0, 2.0, 2.0, 5.0, 5.0, 6.0]");
    }

    #[test]
    fn a_slow_topic_is_known_between_its_own_messages() {
        let found = between(&[0, 100, 200, 300, 600], &[50, 250, 450]);
        assert_eq!(found.within_ns, 200 * MS);
        assert_eq!(text(&found.line(&[0.0, 1.0, 2.0, 3.0, 6.0])), "[0.5, 2.5, NaN]");
    }

    #[test]
    fn what_cannot_be_used_is_not_mixed_into_what_can() {
        let found = between(&[0, 10, 20, 30], &[5, 15, 25, 30]);
        let line = found.line_within(&[1.0, 9.0, f64::NAN, 2.0], [0.0, 5.0]);
        assert_eq!(text(&line), "[9.0, 9.0, NaN, 2.0]");
    }

    #[test]
    fn messages_of_one_time_are_no_step() {
        let found = between(&[0, 10, 10, 20], &[10, 12]);
        assert_eq!(text(&found.line(&[0.0, 1.0, 3.0, 4.0])), "[3.0, 3.2]");
        assert_eq!(text(&between(&[], &[10]).line(&[])), "[NaN]");
    }
}
