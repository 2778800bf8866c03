//! Full scales of the scale factors of chips.

use phystac::{SCALES_PER_PA, Transfer};
use twintac_sensor::Sensor;

/// The largest pressure that counts of a scale can represent, kPa.
#[must_use]
pub fn full_scale_kpa(counts_per_pa: u16, signed: bool) -> f64 {
    let transfer = Transfer {
        signed,
        ..Transfer::per_pa(counts_per_pa)
    };
    1e-3 * f64::from(transfer.full_scale_pa())
}

/// The scale of emulated barometers for which the description confirms none, counts per Pa: the
/// finest scale that reaches the description's range.
#[must_use]
pub fn emulated_scale(sensor: &Sensor) -> u16 {
    let reaches = |per_pa: &u16| full_scale_kpa(*per_pa, false) >= sensor.readout.max_kpa;
    let finest = SCALES_PER_PA.into_iter().rev().find(reaches);
    finest.unwrap_or(SCALES_PER_PA[0])
}
