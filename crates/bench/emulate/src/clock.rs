//! The clock that all emulated devices share.

use std::sync::{Arc, Condvar, Mutex};
use std::time::{Duration, Instant};

use embedded_hal::delay::DelayNs;

use crate::worker::locked;

/// By how much a sleep may be too long: about as long as a transaction on the bus. A wait sleeps
/// until this long before its end, and then spins.
const OVERSLEEP: Duration = Duration::from_micros(100);

/// The clock of the emulator, in real or in virtual time. Clones read the same clock.
///
/// Real time passes by itself, and waiting takes as long as requested. Virtual time stands still
/// until somebody waits. The latest end of all waits moves it for all, so a test of minutes is over
/// at once and always gives the same result.
#[derive(Clone, Debug)]
pub struct LabClock(Arc<Time>);

#[derive(Debug)]
enum Time {
    Real(Instant),
    Virtual { now_ns: Mutex<u64>, moved: Condvar },
}

impl LabClock {
    /// A clock of real time that starts at zero.
    #[must_use]
    pub fn real() -> Self {
        Self(Arc::new(Time::Real(Instant::now())))
    }

    /// A clock of virtual time that starts at zero.
    #[must_use]
    pub fn virtual_time() -> Self {
        let (now_ns, moved) = (Mutex::new(0), Condvar::new());
        Self(Arc::new(Time::Virtual { now_ns, moved }))
    }

    /// Time since the start, ns.
    #[must_use]
    pub fn now_ns(&self) -> u64 {
        match &*self.0 {
            Time::Real(start) => start.elapsed().as_nanos() as u64, // 584 years
            Time::Virtual { now_ns, .. } => *locked(now_ns),
        }
    }

    /// Time since the start, µs.
    #[must_use]
    pub fn now_us(&self) -> u64 {
        self.now_ns() / 1000
    }

    /// Time since the start, s.
    #[must_use]
    pub fn now_s(&self) -> f64 {
        seconds(self.now_ns())
    }

    /// Waits until a time since the start. Virtual time moves to that time, unless it is later
    /// already.
    pub(crate) fn wait_until_ns(&self, until_ns: u64) {
        match &*self.0 {
            Time::Real(_) => {
                let left = Duration::from_nanos(until_ns.saturating_sub(self.now_ns()));
                std::thread::sleep(left.saturating_sub(OVERSLEEP));
                while self.now_ns() < until_ns {
                    std::hint::spin_loop();
                }
            }
            Time::Virtual { now_ns, moved } => {
                let mut now_ns = locked(now_ns);
                *now_ns = until_ns.max(*now_ns);
                moved.notify_all();
            }
        }
    }

    /// Waits for `seconds`, s.
    pub fn wait_s(&self, seconds: f64) {
        self.wait_until_ns(self.now_ns() + nanoseconds(seconds));
    }

    /// Lets a server rest until `due_ns`, or for at most the real time `at_most`, because a server
    /// must also look after its sockets. Never moves the clock.
    pub(crate) fn rest_until_ns(&self, due_ns: u64, at_most: Duration) {
        match &*self.0 {
            Time::Real(_) => {
                let left = Duration::from_nanos(due_ns.saturating_sub(self.now_ns()));
                std::thread::sleep(left.min(at_most));
            }
            Time::Virtual { now_ns, moved } => {
                let now_ns = locked(now_ns);
                // Whether the time was reached does not matter here: the server looks at the clock.
                let _ = moved.wait_timeout_while(now_ns, at_most, |now_ns| *now_ns < due_ns);
            }
        }
    }
}

impl DelayNs for LabClock {
    fn delay_ns(&mut self, ns: u32) {
        self.wait_until_ns(self.now_ns() + u64::from(ns));
    }

    fn delay_us(&mut self, us: u32) {
        self.wait_until_ns(self.now_ns() + 1000 * u64::from(us));
    }
}

pub(crate) fn seconds(ns: u64) -> f64 {
    ns as f64 * 1e-9
}

pub(crate) fn nanoseconds(seconds: f64) -> u64 {
    (seconds * 1e9).round() as u64 // below zero becomes zero
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn virtual_time_passes_only_where_somebody_waits() {
        let clock = LabClock::virtual_time();
        let mut copy = clock.clone();
        copy.delay_us(250);
        assert_eq!((clock.now_ns(), clock.now_us()), (250_000, 250));
        clock.wait_until_ns(100_000);
        assert_eq!(clock.now_us(), 250);
        clock.rest_until_ns(1_000_000, Duration::from_millis(1));
        assert_eq!(clock.now_us(), 250);
    }

    #[test]
    fn real_time_is_waited_for() {
        let clock = LabClock::real();
        let before_ns = clock.now_ns();
        clock.wait_s(0.003);
        assert!(clock.now_ns() - before_ns >= 3_000_000);
    }
}
