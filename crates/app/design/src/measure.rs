//! How designs are measured.

use phystac::Chip;
use serde::Serialize;
use twintac_sensor::Sensor;
use twintac_work::WorkError;

/// How designs are measured.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Measure {
    /// The force at which the figures hold that depend on force, N.
    pub force_n: f64,
    /// Radius of the ball that presses, mm.
    pub ball_radius_mm: f64,
    /// Standard deviation of a single reading of an untouched taxel, kPa. `None`: the value of the
    /// chip's data sheet, or the readings' resolution if that is larger.
    pub noise_kpa: Option<f64>,
    /// Most nodes of the gel's mesh.
    pub max_nodes: usize,
}

impl Default for Measure {
    fn default() -> Self {
        Self {
            force_n: 0.5,
            ball_radius_mm: 5.0,
            noise_kpa: None,
            max_nodes: 16_000,
        }
    }
}

impl Measure {
    pub(crate) fn check(&self) -> Result<(), WorkError> {
        let within = |name: &str, value: f64, unit: &str, [low, high]: [f64; 2]| {
            if (low..=high).contains(&value) {
                return Ok(());
            }
            Err(WorkError::Input(format!(
                "the {name} is {value} {unit}: give {low} to {high} {unit}"
            )))
        };
        within("force", self.force_n, "N", [1e-3, 1e3])?;
        within("radius of the ball", self.ball_radius_mm, "mm", [0.1, 500.0])?;
        if let Some(noise_kpa) = self.noise_kpa {
            within("noise", noise_kpa, "kPa", [1e-6, 1e3])?;
        }
        within("number of nodes", self.max_nodes as f64, "nodes", [500.0, 1e5])
    }

    /// Standard deviation of a single reading, kPa.
    pub(crate) fn noise_kpa(&self, sensor: &Sensor) -> f64 {
        self.noise_kpa.unwrap_or_else(|| {
            let readout = &sensor.readout;
            let of_data_sheet = chip_noise_kpa(readout.chip.as_deref(), readout.samples);
            of_data_sheet.unwrap_or(0.0).max(readout.resolution_kpa)
        })
    }
}

/// The noise of a chip by its data sheet, kPa.
fn chip_noise_kpa(chip: Option<&str>, samples: Option<u16>) -> Option<f64> {
    let chip = Chip::named(chip?)?.data();
    let samples = samples.or(chip.usual_samples)?;
    let speed = chip.speeds.iter().find(|speed| speed.samples == samples)?;
    Some(f64::from(speed.noise_pa?) / 1000.0)
}

#[cfg(test)]
mod tests {
    use super::*;
    use twintac_sensor::SensorFile;

    #[test]
    fn noise_is_the_chips_where_its_data_sheet_says_it() {
        assert!((chip_noise_kpa(Some("MS5837-30BA"), Some(8192)).unwrap() - 0.020).abs() < 1e-6);
        assert!((chip_noise_kpa(Some("MS5837-30BA"), None).unwrap() - 0.038).abs() < 1e-6);
        assert_eq!(chip_noise_kpa(Some("CPS135B"), None), None);
        let phystac = SensorFile::phystac().unwrap().sensor;
        assert_eq!(
            Measure::default().noise_kpa(&phystac),
            phystac.readout.resolution_kpa
        );
    }

    #[test]
    fn what_can_not_be_measured_with_is_refused() {
        for wrong in [f64::NAN, 0.0, -1.0, 1e9, f64::INFINITY] {
            let force = Measure {
                force_n: wrong,
                ..Measure::default()
            };
            let ball = Measure {
                ball_radius_mm: wrong,
                ..Measure::default()
            };
            let noise = Measure {
                noise_kpa: Some(wrong),
                ..Measure::default()
            };
            assert!(
                [force, ball, noise]
                    .iter()
                    .all(|measure| measure.check().is_err()),
                "{wrong}"
            );
        }
        assert!(Measure::default().check().is_ok());
    }
}
