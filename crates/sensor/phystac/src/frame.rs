//! One reading of all taxels.

use crate::conversion::{Sample, Transfer};
use crate::fault::Fault;

/// The samples of all taxels at one moment.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Frame<const N: usize> {
    /// When all barometers started to convert, µs of the [`Clock`](crate::Clock).
    pub triggered_us: u64,
    /// When the read of each taxel ended, with a sample or a fault, µs of the
    /// [`Clock`](crate::Clock).
    pub read_us: [u64; N],
    /// The sample of each taxel, or its fault.
    pub taxels: [Result<Sample, Fault>; N],
}

impl<const N: usize> Frame<N> {
    /// The pressure of each taxel, Pa, or its fault. `transfer` is used only for chips whose scale
    /// is unknown.
    pub fn pressures_pa(&self, transfer: &Transfer) -> [Result<f32, Fault>; N] {
        self.taxels
            .map(|taxel| taxel.and_then(|sample| sample.pressure_pa(transfer)))
    }

    /// The taxels without a sample: index and fault.
    pub fn faults(&self) -> impl Iterator<Item = (usize, Fault)> {
        let of = |taxel: &Result<Sample, Fault>| taxel.err().filter(|fault| *fault != Fault::NotWired);
        let faults = self.taxels.iter().map(of);
        faults
            .enumerate()
            .filter_map(|(index, fault)| Some((index, fault?)))
    }
}
