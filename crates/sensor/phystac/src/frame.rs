//! One reading of all taxels.

use crate::conversion::{Sample, Transfer};
use crate::fault::Fault;

/// What all taxels sensed at one moment.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Frame<const N: usize> {
    /// When all barometers began to convert, µs of the [`Clock`](crate::Clock).
    pub triggered_us: u64,
    /// When each taxel had been read, or given up, µs of the [`Clock`](crate::Clock).
    pub read_us: [u64; N],
    /// What each taxel gave, or why it gave nothing.
    pub taxels: [Result<Sample, Fault>; N],
}

impl<const N: usize> Frame<N> {
    /// What each taxel gave as pressure, Pa, or why it gave nothing. `transfer` counts for chips that do not know their scale.
    pub fn pressures_pa(&self, transfer: &Transfer) -> [Result<f32, Fault>; N] {
        self.taxels
            .map(|taxel| taxel.and_then(|sample| sample.pressure_pa(transfer)))
    }

    /// The taxels that gave nothing, by index.
    pub fn faults(&self) -> impl Iterator<Item = (usize, Fault)> {
        let of = |taxel: &Result<Sample, Fault>| taxel.err().filter(|fault| *fault != Fault::NotWired);
        let faults = self.taxels.iter().map(of);
        faults
            .enumerate()
            .filter_map(|(index, fault)| Some((index, fault?)))
    }
}
