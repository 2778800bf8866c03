//! The frame rate that a bus allows.

use crate::asynch::FRAMES_PER_TEMPERATURE;
use crate::settings::Settings;
use crate::wiring::Wired;

/// The time that a frame takes on the bus: nine clocks for each byte, and one clock for each START,
/// repeated START and STOP. It assumes that each barometer is asked once whether its conversion has
/// ended, because it has after the longest conversion time.
///
/// ```
/// use phystac::{Budget, Settings};
///
/// let budget = Budget::new(&Settings::default(), 400_000);
/// assert_eq!(budget.rate_hz().round(), 114.0);
/// assert_eq!(budget.one_by_one_hz().round(), 20.0);
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Budget {
    /// Clocks of a frame, without separate temperature conversions.
    frame_clocks: u32,
    /// The longest conversion, µs.
    conversion_us: u32,
    /// Mean time per frame for separate temperature conversions, µs.
    temperature_us: f32,
    /// Time of a frame if each barometer is triggered, awaited and read alone, µs.
    one_by_one_us: f32,
    bus_hz: u32,
}

impl Budget {
    /// Clocks of a write of the switch's mask: address and mask.
    const OPEN: u32 = 9 * 2 + 2;

    /// The budget of a sensor on a bus of `bus_hz` clocks per second, at most 400 000.
    #[must_use]
    pub fn new<const N: usize>(settings: &Settings<N>, bus_hz: u32) -> Self {
        let clocks_us = |clocks: u32| 1e6 * clocks as f32 / bus_hz as f32;
        let wiring = &settings.wiring;
        let n_switches = wiring.switches().count() as u32;
        let is_apart = |wired: &Wired| wired.chip.data().cost.is_temperature_apart;
        let time_us = |index: usize| {
            let published = wiring.speed(index).and_then(|speed| speed.conversion_us);
            published.unwrap_or(settings.conversion_us)
        };
        let (mut frame_clocks, mut temperature_clocks, mut one_by_one_us) = (0, 0, 0.0);
        let (mut conversion_us, mut apart_us) = (0, 0);
        for (index, wired) in wiring.taxels().enumerate() {
            let cost = wired.chip.data().cost;
            let is_first = |is_alike: &dyn Fn(&Wired) -> bool| {
                !wiring.taxels().take(index).any(|before| is_alike(&before))
            };
            let command = 9 * (1 + cost.command) + 2;
            let opening = if wired.behind.is_some() { Self::OPEN } else { 0 };
            // Barometers that take the same command get it in one write, after the channels of
            // every switch are open.
            let alike = |before: &Wired| {
                (before.chip, before.address, before.samples) == (wired.chip, wired.address, wired.samples)
            };
            let told = if is_first(&alike) {
                command + n_switches * Self::OPEN
            } else {
                0
            };
            // Where the switch changes, the channels of the one before are closed first.
            let changes = |before: &Wired| {
                before.behind.map(|(switch, _)| switch) != wired.behind.map(|(switch, _)| switch)
            };
            let is_other = index > 0
                && wiring
                    .taxels()
                    .nth(index - 1)
                    .is_some_and(|before| changes(&before));
            let closing = if is_other { Self::OPEN } else { 0 };
            let clocks = told + closing + opening + cost.collect_clocks;
            frame_clocks += clocks;
            conversion_us = conversion_us.max(time_us(index));
            if is_apart(&wired) {
                temperature_clocks += clocks;
                apart_us = apart_us.max(time_us(index));
            }
            one_by_one_us += time_us(index) as f32 + clocks_us(opening + command + cost.collect_clocks);
        }
        Self {
            frame_clocks,
            conversion_us,
            temperature_us: (apart_us as f32 + clocks_us(temperature_clocks)) / FRAMES_PER_TEMPERATURE as f32,
            one_by_one_us,
            bus_hz,
        }
    }

    /// Clocks of a frame, without separate temperature conversions.
    #[must_use]
    pub const fn frame_clocks(&self) -> u32 {
        self.frame_clocks
    }

    /// Mean time of a frame, µs.
    #[must_use]
    pub fn frame_us(&self) -> f32 {
        let clocks_us = 1e6 * self.frame_clocks as f32 / self.bus_hz as f32;
        self.conversion_us as f32 + clocks_us + self.temperature_us
    }

    /// Frame rate, Hz.
    #[must_use]
    pub fn rate_hz(&self) -> f32 {
        1e6 / self.frame_us()
    }

    /// Frame rate if each taxel is triggered, awaited and read alone, Hz.
    #[must_use]
    pub fn one_by_one_hz(&self) -> f32 {
        1e6 / self.one_by_one_us
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rates_of_eight_taxels() {
        // conversion time; then with one trigger for all at 100 and 400 kHz; then one by one
        let table = [
            (2500, [71.92, 185.05], [30.11, 42.91]),
            (6000, [57.47, 112.43], [16.36, 19.49]),
            (20_000, [31.85, 43.70], [5.77, 6.12]),
        ];
        for (conversion_us, together_hz, one_by_one_hz) in table {
            for (index, bus_hz) in [100_000, 400_000].into_iter().enumerate() {
                let settings = Settings {
                    conversion_us,
                    ..Settings::default()
                };
                let budget = Budget::new(&settings, bus_hz);
                assert_eq!(budget.frame_clocks(), 809 + 8 * 39);
                assert!(
                    (budget.rate_hz() / together_hz[index] - 1.0).abs() < 0.02,
                    "{budget:?} {}",
                    budget.rate_hz()
                );
                assert!(
                    (budget.one_by_one_hz() / one_by_one_hz[index] - 1.0).abs() < 0.02,
                    "{budget:?} {}",
                    budget.one_by_one_hz()
                );
            }
        }
    }
}
