//! The meaning of counts, checked in free air when the sensor is switched on.

use embedded_hal::delay::DelayNs;
use embedded_hal::i2c::I2c;
use phystac::{Clock, Frame, FreeAir, PhysTac, Thresholds, Transfer, scale_hint};
use twintac_sensor::Sensor;

use super::full_scale::{emulated_scale, full_scale_kpa};
use super::screening::{Screening, UNUSED};
use crate::SourceError;
use crate::error::bus_error;

/// What a person knows of the parts and of the location.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Known {
    /// Counts per Pa. `None`: the value of the sensor's description.
    pub counts_per_pa: Option<u16>,
    /// Altitude, m. `None`: any altitude up to 2000 m.
    pub altitude_m: Option<f32>,
}

impl Known {
    /// Adds the scale of emulated barometers if neither `self` nor the description has a scale.
    #[must_use]
    pub fn or_emulated(self, sensor: &Sensor) -> Self {
        let is_described = sensor.readout.transfer.is_some() || sensor.readout.counts_per_pa.is_some();
        let scale = (!is_described && sensor.has_unscaled_chips()).then(|| emulated_scale(sensor));
        Self {
            counts_per_pa: self.counts_per_pa.or(scale),
            ..self
        }
    }
}

/// Results of the check when the sensor is switched on.
#[derive(Clone, Debug, PartialEq)]
pub struct PowerOn {
    /// The confirmed conversion from counts to pressure, if the chips do not know their own scale.
    pub transfer: Option<Transfer>,
    /// Thresholds from which a taxel is suspect. The range is that of the description.
    pub thresholds: Thresholds,
    /// Observations that do not prevent reading, one sentence each.
    pub notes: Vec<String>,
}

impl PowerOn {
    /// Creates the screening of the frames that follow.
    #[must_use]
    pub(super) const fn screening<const N: usize>(&self) -> Screening<N> {
        Screening::new(self.transfer, self.thresholds)
    }
}

/// Reads a frame in free air, and returns the conversion from counts to pressure if a person has
/// confirmed it: the value of `known`, or else that of the sensor's description. Chips that know
/// their own scale need no confirmation.
///
/// Counts per Pa are in two's complement, as in the data sheet of the family, unless only unsigned
/// counts reach the description's range.
///
/// # Errors
/// [`SourceError::ScaleUnconfirmed`]: nobody has confirmed the scale; the error has the hint from
/// free air. [`SourceError::NothingToScale`]: a scale was given for chips that know their own.
/// [`SourceError::ScaleContradicted`], [`SourceError::NotFreeAir`]: most taxels do not read free
/// air. [`SourceError::Wire`]: the bus failed.
pub fn power_on<I2C: I2c, D: DelayNs, C: Clock, const N: usize>(
    phystac: &mut PhysTac<I2C, D, C, N>,
    sensor: &Sensor,
    known: &Known,
) -> Result<PowerOn, SourceError> {
    let frame = phystac.frame().map_err(bus_error)?;
    let air = known
        .altitude_m
        .map_or_else(FreeAir::default, FreeAir::at_altitude_m);
    let found = Found::of(&frame, air);
    let transfer = match sensor.has_unscaled_chips() {
        true => Some(confirmed(sensor, known).ok_or_else(|| found.unconfirmed(sensor))?),
        false if known.counts_per_pa.is_some() => return Err(SourceError::NothingToScale),
        false => None,
    };
    let notes = check(&frame, sensor, air, transfer.as_ref(), found)?;
    let rated_kpa = [sensor.readout.min_kpa, sensor.readout.max_kpa];
    Ok(PowerOn {
        transfer,
        thresholds: Thresholds {
            rated_pa: rated_kpa.map(|kpa| (1e3 * kpa) as f32),
            ..Thresholds::default()
        },
        notes,
    })
}

/// The conversion that a person has confirmed.
fn confirmed(sensor: &Sensor, known: &Known) -> Option<Transfer> {
    let readout = &sensor.readout;
    let per_pa = |counts_per_pa: u16| {
        let reaches = |signed| full_scale_kpa(counts_per_pa, signed) >= readout.max_kpa;
        Transfer {
            signed: reaches(true) || !reaches(false),
            ..Transfer::per_pa(counts_per_pa)
        }
    };
    let described = readout.transfer.map(|transfer| Transfer {
        pa_per_count: transfer.pa_per_count as f32,
        offset_pa: transfer.offset_pa as f32,
        signed: transfer.signed,
    });
    let typed = known.counts_per_pa.map(per_pa);
    typed.or(described).or(readout.counts_per_pa.map(per_pa))
}

/// The hint for the scale that free air gives.
struct Found {
    counts_per_pa: Option<u16>,
    text: String,
}

impl Found {
    fn of<const N: usize>(frame: &Frame<N>, air: FreeAir) -> Self {
        match scale_hint(frame, air) {
            Ok(found) => Self {
                counts_per_pa: Some(found.counts_per_pa),
                text: format!(
                    "the readings in free air suggest {} counts per Pa: the taxels then read {:.1} to {:.1} kPa",
                    found.counts_per_pa,
                    1e-3 * found.lowest_pa,
                    1e-3 * found.highest_pa
                ),
            },
            Err(error) => Self {
                counts_per_pa: None,
                text: format!("the readings in free air suggest no scale: {error}"),
            },
        }
    }

    fn unconfirmed(&self, sensor: &Sensor) -> SourceError {
        let scale = self
            .counts_per_pa
            .map_or("K".to_owned(), |found| found.to_string());
        SourceError::ScaleUnconfirmed {
            found: self.text.clone(),
            advice: format!(
                "give `--scale {scale}`, or write `counts_per_pa = {scale}` under [readout] in the description of sensor {}",
                sensor.name
            ),
        }
    }
}

/// Checks that most taxels read free air. Returns observations that do not prevent reading, one
/// sentence each.
fn check<const N: usize>(
    frame: &Frame<N>,
    sensor: &Sensor,
    air: FreeAir,
    transfer: Option<&Transfer>,
    found: Found,
) -> Result<Vec<String>, SourceError> {
    let mut notes = Vec::new();
    let (mut n_free, mut n_read) = (0, 0);
    let pressures = frame.pressures_pa(transfer.unwrap_or(&UNUSED));
    for (taxel, pressure) in sensor.taxels.iter().zip(pressures) {
        let name = &taxel.name;
        match pressure {
            Ok(pressure_pa) => {
                n_read += 1;
                if (air.lowest_pa..=air.highest_pa).contains(&pressure_pa) {
                    n_free += 1;
                } else {
                    notes.push(format!(
                        "taxel {name} reads {:.1} kPa: is it touched?",
                        1e-3 * pressure_pa
                    ));
                }
            }
            Err(fault) => notes.push(format!("taxel {name}: {fault}")),
        }
    }
    if 2 * n_free <= n_read || n_read == 0 {
        let Some(transfer) = transfer else {
            return Err(SourceError::NotFreeAir {
                n_free,
                n_read,
                notes: notes.join("; "),
            });
        };
        return Err(SourceError::ScaleContradicted {
            pa_per_count: transfer.pa_per_count,
            n_free,
            n_read,
            found: found.text,
        });
    }
    let Some(transfer) = transfer else {
        return Ok(notes);
    };
    let (most_kpa, max_kpa) = (1e-3 * transfer.full_scale_pa(), sensor.readout.max_kpa);
    if f64::from(most_kpa) < max_kpa {
        notes.push(format!(
            "counts go up to {most_kpa:.0} kPa only; the description's range ends at {max_kpa} kPa"
        ));
    }
    Ok(notes)
}
