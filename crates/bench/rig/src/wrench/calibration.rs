//! From gauge voltages to a wrench.

use glam::DVec3;
use serde::{Deserialize, Serialize};
use twintac_config::ConfigError;

use super::Wrench;
use crate::RigError;

/// How a wrench follows from six gauge voltages: `matrix * (volts - bias)`.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct AnalogCalibration {
    /// Rows Fx, Fy, Fz in N/V and Tx, Ty, Tz in N mm/V; columns are the gauges.
    pub matrix: [[f64; 6]; 6],
    /// Voltages without load, V.
    #[serde(default)]
    pub bias_v: [f64; 6],
    /// Voltage at which a gauge counts as saturated, V, positive or negative.
    #[serde(default = "usual_range_v")]
    pub range_v: f64,
}

/// The range of most measuring cards, V.
pub(super) fn usual_range_v() -> f64 {
    10.0
}

impl AnalogCalibration {
    /// Reads a calibration from the text of a TOML file.
    ///
    /// # Errors
    /// The first field that is wrong, with file and line.
    pub fn parse_toml(file: &str, text: &str) -> Result<Self, ConfigError> {
        let document = twintac_config::parse::<Self>(file, text)?;
        if document.value.range_v <= 0.0 {
            let problem = format!("is {} V", document.value.range_v);
            return Err(document.error("range_v", problem, "give a voltage above zero"));
        }
        Ok(document.value)
    }

    /// The same calibration, with these voltages, V, as the bias (no load).
    #[must_use]
    pub fn with_bias(self, bias_v: [f64; 6]) -> Self {
        Self { bias_v, ..self }
    }

    /// The wrench of six gauge voltages, V.
    ///
    /// # Errors
    /// A gauge that is saturated: the force is then not known.
    pub fn wrench(&self, volts: [f64; 6]) -> Result<Wrench, RigError> {
        let is_measured = |volt: &f64| volt.abs() < self.range_v;
        if let Some(gauge) = volts.iter().position(|volt| !is_measured(volt)) {
            return Err(RigError::ForceSensor {
                problem: format!(
                    "gauge {gauge} reads {} V, its range is ±{} V",
                    volts[gauge], self.range_v
                ),
                hint: "unload the sensor, or check its cable",
            });
        }
        let row = |axis: usize| -> f64 {
            (0..6)
                .map(|gauge| self.matrix[axis][gauge] * (volts[gauge] - self.bias_v[gauge]))
                .sum()
        };
        Ok(Wrench {
            force_n: DVec3::new(row(0), row(1), row(2)),
            torque_n_mm: DVec3::new(row(3), row(4), row(5)),
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const TEXT: &str = "bias_v = [0.5, 0.0, 0.0, 0.0, 0.0, 0.0]\nmatrix = [\n  [2.0, 0.0, 0.0, 0.0, 0.0, 0.0],\n  \
        [0.0, 1.0, 0.0, 0.0, 0.0, 0.0],\n  [0.0, 0.0, 1.0, 0.0, 0.0, 0.0],\n  [0.0, 0.0, 0.0, 10.0, 0.0, 0.0],\n  \
        [0.0, 0.0, 0.0, 0.0, 1.0, 0.0],\n  [0.0, 0.0, 0.0, 0.0, 0.0, 1.0],\n]\n";

    #[test]
    fn voltages_become_a_wrench() {
        let calibration = AnalogCalibration::parse_toml("cal.toml", TEXT).unwrap();
        let volts = [1.0, 2.0, 3.0, 4.0, 5.0, 6.0];
        let wrench = calibration.wrench(volts).unwrap();
        assert_eq!(wrench, Wrench::from_axes([1.0, 2.0, 3.0, 40.0, 5.0, 6.0]));
    }

    #[test]
    fn saturated_gauges_have_no_force() {
        let calibration = AnalogCalibration::parse_toml("cal.toml", TEXT).unwrap();
        for volt in [10.0, -10.5, f64::NAN] {
            let error = calibration.wrench([0.0, volt, 0.0, 0.0, 0.0, 0.0]).unwrap_err();
            assert!(error.to_string().contains("gauge 1 reads"), "{error}");
        }
        let error = AnalogCalibration::parse_toml("cal.toml", &format!("range_v = 0.0\n{TEXT}")).unwrap_err();
        assert!(
            error.to_string().starts_with("cal.toml:1: `range_v` is 0 V"),
            "{error}"
        );
        assert!(AnalogCalibration::parse_toml("cal.toml", "matrix = [[1.0]]").is_err());
    }
}
