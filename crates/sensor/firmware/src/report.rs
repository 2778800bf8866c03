//! The result of a round.

use phystac::{Chip, Frame, Pressure, Sample, TaxelState, Transfer};

use crate::trouble::Trouble;

/// Numbers beyond this are not readings, whatever caused them; Pa and °C.
const MOST: f32 = 1e9;

/// The reading of one taxel in a round.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Taxel {
    /// Pressure, Pa. `None` if `state` is a fault.
    pub pressure_pa: Option<f32>,
    /// Temperature of the chip, °C, if it was read.
    pub temperature_c: Option<f32>,
    /// Whether there is a pressure, and if not, why.
    pub state: TaxelState,
}

/// The result of a round: readings, and which taxels could not be read and why. A value that was
/// not read is never a number.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Report<const N: usize> {
    /// Number of the round. It rolls over after 2³² - 1.
    pub sequence: u32,
    /// When all barometers started to convert, or the round failed, µs since power-on.
    pub triggered_us: u64,
    /// The reading of each taxel.
    pub taxels: [Taxel; N],
    /// The failure of the round as a whole.
    pub trouble: Trouble,
    /// Number of resets of the switches since power-on; it stops at its largest value.
    pub rescues: u16,
}

impl Taxel {
    const fn without(state: TaxelState) -> Self {
        Self {
            pressure_pa: None,
            temperature_c: None,
            state,
        }
    }

    fn of(sample: &Sample, transfer: Option<&Transfer>) -> Self {
        let temperature_c = Some(sample.temperature_c).filter(|celsius| celsius.abs() < MOST);
        let pressure = match (sample.pressure, transfer) {
            (Pressure::Unscaled, None) => Err(TaxelState::Unscaled),
            (_, Some(transfer)) => sample.pressure_pa(transfer).map_err(TaxelState::from),
            (Pressure::Pascal(pressure_pa), None) => Ok(pressure_pa),
            (Pressure::OutOfRange, None) => Err(TaxelState::Saturated),
        };
        match pressure {
            Ok(pressure_pa) if pressure_pa.abs() < MOST => Self {
                pressure_pa: Some(pressure_pa),
                temperature_c,
                state: TaxelState::Good,
            },
            failed => Self {
                pressure_pa: None,
                temperature_c,
                state: failed.err().unwrap_or(TaxelState::Saturated),
            },
        }
    }
}

impl<const N: usize> Report<N> {
    pub(crate) fn of(frame: &Frame<N>, transfer: Option<&Transfer>, sequence: u32, rescues: u16) -> Self {
        Self {
            sequence,
            triggered_us: frame.triggered_us,
            taxels: frame.taxels.each_ref().map(|taxel| match taxel {
                Ok(sample) => Taxel::of(sample, transfer),
                Err(fault) => Taxel::without((*fault).into()),
            }),
            trouble: Trouble::None,
            rescues,
        }
    }

    /// The report of a round in which nothing was read.
    pub(crate) const fn failed(trouble: Trouble, now_us: u64, sequence: u32, rescues: u16) -> Self {
        let state = match trouble {
            Trouble::NotTriggered => TaxelState::Missing,
            _ => TaxelState::BusError,
        };
        Self {
            sequence,
            triggered_us: now_us,
            taxels: [Taxel::without(state); N],
            trouble,
            rescues,
        }
    }
}

/// Whether a chip has an unknown scale.
pub(crate) const fn needs_scale(chip: Chip) -> bool {
    !chip.data().knows_its_scale
}
