//! Counters that roll over.

/// A decrease by at least this fraction of a counter's range is a roll-over. A smaller decrease is
/// a number out of order.
const ROLLED_OVER: f64 = 0.5;

/// A counter that continues where the counter on the line rolls over.
#[derive(Clone, Debug, Default)]
pub(crate) struct Counter {
    wraps_at: Option<f64>,
    turns: f64,
    last: Option<f64>,
}

/// The change from one count to the next.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Step {
    /// It is the first count.
    First,
    /// It increased by this much, above zero.
    On(f64),
    /// It is the same.
    Same,
    /// It decreased by this much.
    Back(f64),
}

impl Counter {
    pub(crate) fn new(wraps_at: Option<f64>) -> Self {
        Self {
            wraps_at,
            ..Self::default()
        }
    }

    /// The change since the last count that was taken, and the count with roll-overs undone.
    pub(crate) fn look(&self, count: f64) -> (Step, f64) {
        let Some(last) = self.last else {
            return (Step::First, count);
        };
        let mut whole = count + self.turns;
        if let Some(wraps_at) = self.wraps_at
            && last - whole >= ROLLED_OVER * wraps_at
        {
            whole += wraps_at;
        }
        let step = whole - last;
        match step {
            _ if step > 0.0 => (Step::On(step), whole),
            0.0 => (Step::Same, whole),
            _ => (Step::Back(-step), whole),
        }
    }

    /// Takes a count, with the value that [`look`](Self::look) returned for it.
    pub(crate) fn take(&mut self, count: f64, whole: f64) {
        self.turns = whole - count;
        self.last = Some(whole);
    }

    /// Starts anew.
    pub(crate) fn restart(&mut self) {
        self.turns = 0.0;
        self.last = None;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_counter_goes_on_over_its_end() {
        let mut counter = Counter::new(Some(256.0));
        let mut wholes = Vec::new();
        for turn in 0..1000 {
            let count = f64::from(turn * 3 % 256);
            let (step, whole) = counter.look(count);
            assert!(turn == 0 || step == Step::On(3.0), "{turn}: {step:?}");
            counter.take(count, whole);
            wholes.push(whole);
        }
        assert!(wholes.windows(2).all(|pair| pair[1] - pair[0] == 3.0));
        assert_eq!(counter.look(f64::from(999 * 3 % 256)).0, Step::Same);
        assert_eq!(counter.look(f64::from(999 * 3 % 256 - 6)).0, Step::Back(6.0));
    }
}
