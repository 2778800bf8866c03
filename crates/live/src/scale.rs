//! What counts stand for, checked against free air when the sensor is switched on.

use embedded_hal::delay::DelayNs;
use embedded_hal::i2c::I2c;
use phystac::{Clock, Frame, FreeAir, PhysTac, Thresholds, Transfer, propose};
use twintac_log::Screening;
use twintac_sensor::Sensor;

use crate::LiveError;
use crate::reader::bus_error;

/// Scales that parts of the family have, counts per Pa.
pub(crate) const SCALES_PER_PA: [u16; 5] = [4, 8, 16, 32, 64];

/// The largest pressure that counts of a scale can say, kPa.
pub(crate) fn full_scale_kpa(counts_per_pa: u16, signed: bool) -> f64 {
    let transfer = Transfer {
        signed,
        ..Transfer::per_pa(counts_per_pa)
    };
    1e-3 * f64::from(transfer.full_scale_pa())
}

/// What was found when the sensor was switched on.
#[derive(Clone, Debug, PartialEq)]
pub struct PowerOn {
    /// What counts stand for, confirmed.
    pub transfer: Transfer,
    /// From when on a taxel is suspect; its range is the description's.
    pub thresholds: Thresholds,
    /// What is odd but stops nothing, a sentence each.
    pub notes: Vec<String>,
}

impl PowerOn {
    /// What makes messages of the frames to come.
    #[must_use]
    pub const fn screening<const N: usize>(&self) -> Screening<N> {
        Screening::new(self.transfer, self.thresholds)
    }
}

/// Reads a frame in free air, and says what counts stand for if somebody has confirmed it: `counts_per_pa`, or else the sensor's description.
///
/// Counts are two's complement, as the family's data sheet has it, unless only unsigned ones reach the description's range.
///
/// # Errors
/// [`LiveError::ScaleUnconfirmed`]: nobody has; with what free air proposes. [`LiveError::ScaleContradicted`]: free air is not what
/// any taxel then reads. [`LiveError::Bus`].
pub fn power_on<I2C: I2c, D: DelayNs, C: Clock, const N: usize>(
    phystac: &mut PhysTac<I2C, D, C, N>,
    sensor: &Sensor,
    counts_per_pa: Option<u16>,
) -> Result<PowerOn, LiveError> {
    let frame = phystac.frame().map_err(bus_error)?;
    check(&frame, sensor, counts_per_pa.or(sensor.readout.counts_per_pa))
}

fn check<const N: usize>(
    frame: &Frame<N>,
    sensor: &Sensor,
    confirmed: Option<u16>,
) -> Result<PowerOn, LiveError> {
    let air = FreeAir::default();
    let proposal = propose(frame, air);
    let found = match proposal {
        Ok(found) => format!(
            "free air proposes {} counts per Pa: the taxels then read {:.1} to {:.1} kPa",
            found.counts_per_pa,
            1e-3 * found.lowest_pa,
            1e-3 * found.highest_pa
        ),
        Err(error) => format!("free air proposes no scale: {error}"),
    };
    let Some(counts_per_pa) = confirmed else {
        let scale = proposal.map_or("K".to_owned(), |found| found.counts_per_pa.to_string());
        let advice = format!(
            "give `--scale {scale}`, or write `counts_per_pa = {scale}` under [readout] in the description of sensor {}",
            sensor.name
        );
        return Err(LiveError::ScaleUnconfirmed { found, advice });
    };
    let max_kpa = sensor.readout.max_kpa;
    let reaches = |signed| full_scale_kpa(counts_per_pa, signed) >= max_kpa;
    let transfer = Transfer {
        signed: reaches(true) || !reaches(false),
        ..Transfer::per_pa(counts_per_pa)
    };
    let mut notes = Vec::new();
    let mut n_free = 0;
    for ((taxel, pressure), sample) in sensor
        .taxels
        .iter()
        .zip(frame.pressures_pa(&transfer))
        .zip(frame.taxels)
    {
        match (pressure, sample) {
            (Ok(pressure_pa), _) if (air.lowest_pa..=air.highest_pa).contains(&pressure_pa) => n_free += 1,
            (Ok(pressure_pa), _) => {
                let pressure_kpa = 1e-3 * pressure_pa;
                notes.push(format!(
                    "taxel {} reads {pressure_kpa:.1} kPa: is it touched?",
                    taxel.name
                ));
            }
            (Err(fault), _) => notes.push(format!("taxel {}: {fault}", taxel.name)),
        }
    }
    if n_free == 0 {
        return Err(LiveError::ScaleContradicted { counts_per_pa, found });
    }
    if !reaches(transfer.signed) {
        let most_kpa = full_scale_kpa(counts_per_pa, transfer.signed);
        notes.push(format!(
            "{counts_per_pa} counts per Pa say at most {most_kpa:.0} kPa; the description's range ends at {max_kpa} kPa"
        ));
    }
    let thresholds = Thresholds {
        rated_pa: [sensor.readout.min_kpa, max_kpa].map(|kpa| (1e3 * kpa) as f32),
        ..Thresholds::default()
    };
    Ok(PowerOn {
        transfer,
        thresholds,
        notes,
    })
}
