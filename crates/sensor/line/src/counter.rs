//! Counters that roll over.

/// A fall of at least this part of a counter's range is a roll-over; a smaller one is a number out of order.
const ROLLED_OVER: f64 = 0.5;

/// A counter that goes on where the one on the line begins anew.
#[derive(Clone, Debug, Default)]
pub(crate) struct Counter {
    wraps_at: Option<f64>,
    turns: f64,
    last: Option<f64>,
}

/// What a count is, after the one before.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Step {
    /// The first one.
    First,
    /// So much further: above zero.
    On(f64),
    /// The same again.
    Same,
    /// So much back.
    Back(f64),
}

impl Counter {
    pub(crate) fn new(wraps_at: Option<f64>) -> Self {
        Self {
            wraps_at,
            ..Self::default()
        }
    }

    /// How a count relates to the last one that was taken, and what it is without roll-overs.
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

    /// Takes a count that [`look`](Self::look) gave.
    pub(crate) fn take(&mut self, count: f64, whole: f64) {
        self.turns = whole - count;
        self.last = Some(whole);
    }

    /// The counter begins anew.
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
