//! Temperature coefficients, as a file.

use std::path::Path;

use serde::{Deserialize, Serialize};
use twintac_config::{Checked, ConfigError, Ranges};
use twintac_recording::Provenance;

/// Drift of the zeros of a sensor's taxels with temperature.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Compensation {
    /// Name of the sensor's description.
    pub sensor: String,
    /// Provenance of the log that the coefficients were found from.
    pub provenance: Provenance,
    /// The taxels with a coefficient.
    pub taxels: Vec<TaxelDrift>,
}

/// Drift of a taxel's zero with temperature.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct TaxelDrift {
    /// The taxel's name.
    pub name: String,
    /// Temperature coefficient, kPa/K: rise of the unloaded reading with the temperature of the
    /// taxel's chip.
    pub kpa_per_k: f64,
    /// Lowest and highest temperature in the log, °C.
    pub between_c: [f64; 2],
    /// Root mean square of the residuals of the log's readings, averaged over some seconds, kPa.
    pub remaining_kpa: f64,
}

/// Why a compensation does not fit a sensor.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum TemperatureError {
    /// It belongs to another sensor.
    #[error("the temperature compensation is of sensor `{found}`, but these readings are of `{expected}`")]
    OtherSensor {
        /// The sensor of the compensation.
        found: String,
        /// The sensor of the readings.
        expected: String,
    },
    /// A taxel has no coefficient.
    #[error(
        "the temperature compensation has no taxel `{0}`; find it in a log in which all taxels have temperatures that change by a kelvin or more"
    )]
    NoTaxel(String),
}

impl Checked for Compensation {
    fn check(&self, ranges: &mut Ranges) {
        let Self {
            sensor: _,
            provenance: _,
            taxels,
        } = self;
        for (index, taxel) in taxels.iter().enumerate() {
            ranges.inside(&format!("taxels[{index}]"), taxel);
            let is_first = taxels[..index].iter().all(|other| other.name != taxel.name);
            ranges.that(
                &format!("taxels[{index}].name"),
                is_first,
                || format!("`{}` is given twice", taxel.name),
                || "name each taxel once",
            );
        }
    }
}

impl Checked for TaxelDrift {
    fn check(&self, ranges: &mut Ranges) {
        let Self {
            name: _,
            kpa_per_k,
            between_c: [low_c, high_c],
            remaining_kpa,
        } = self;
        ranges.number("kpa_per_k", *kpa_per_k, -1000.0..=1000.0);
        ranges.number("remaining_kpa", *remaining_kpa, 0.0..=1000.0);
        ranges.that(
            "between_c",
            low_c <= high_c,
            || format!("is from {low_c} to {high_c} °C"),
            || "give the lower temperature first",
        );
    }
}

impl Compensation {
    /// Reads a file (TOML).
    ///
    /// # Errors
    /// The file cannot be read or is wrong; the error names line and field.
    pub fn read(path: &Path) -> Result<Self, ConfigError> {
        twintac_config::read::<Self>(path)?.checked()
    }

    /// Reads the text of such a file. `file` names it in errors.
    ///
    /// # Errors
    /// The text is wrong; the error names line and field.
    pub fn parse(file: &str, text: &str) -> Result<Self, ConfigError> {
        twintac_config::parse::<Self>(file, text)?.checked()
    }

    /// The text of such a file.
    #[must_use]
    pub fn to_toml(&self) -> String {
        let head = "# The drift of the taxels' zeros with temperature, found by `twintac characterize`.\n";
        // Names and finite numbers are always valid TOML.
        format!("{head}{}", toml::to_string(self).unwrap_or_default())
    }

    /// The coefficients of a sensor's taxels, kPa/K, in the sensor's order.
    ///
    /// # Errors
    /// The compensation belongs to another sensor, or a taxel has no coefficient.
    pub fn coefficients(&self, sensor: &str, taxels: &[String]) -> Result<Vec<f64>, TemperatureError> {
        let drifts = self.of(sensor, taxels)?;
        Ok(drifts.into_iter().map(|drift| drift.kpa_per_k).collect())
    }

    /// The entries of a sensor's taxels, in the sensor's order.
    pub(crate) fn of(&self, sensor: &str, taxels: &[String]) -> Result<Vec<&TaxelDrift>, TemperatureError> {
        if self.sensor != sensor {
            return Err(TemperatureError::OtherSensor {
                found: self.sensor.clone(),
                expected: sensor.to_owned(),
            });
        }
        let of_taxel = |name: &String| {
            let found = self.taxels.iter().find(|drift| drift.name == *name);
            found.ok_or_else(|| TemperatureError::NoTaxel(name.clone()))
        };
        taxels.iter().map(of_taxel).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn example() -> Compensation {
        let taxel = |name: &str, kpa_per_k: f64| TaxelDrift {
            name: name.to_owned(),
            kpa_per_k,
            between_c: [24.5, 31.25],
            remaining_kpa: 0.0125,
        };
        Compensation {
            sensor: "pair".to_owned(),
            provenance: Provenance::Real,
            taxels: vec![taxel("a", 0.31), taxel("b", -0.07)],
        }
    }

    #[test]
    fn a_file_reads_back_and_gives_coefficients_by_name() {
        let text = example().to_toml();
        assert_eq!(Compensation::parse("t.toml", &text).unwrap(), example());
        let taxels = ["b", "a"].map(str::to_owned);
        assert_eq!(example().coefficients("pair", &taxels).unwrap(), [-0.07, 0.31]);
        let other = example().coefficients("tip", &taxels).unwrap_err().to_string();
        assert!(other.contains("`pair`") && other.contains("`tip`"), "{other}");
        let missing = example().coefficients("pair", &["c".to_owned()]).unwrap_err();
        assert_eq!(missing, TemperatureError::NoTaxel("c".to_owned()));
    }

    #[test]
    fn what_makes_no_sense_is_named() {
        let text = example().to_toml();
        for (old, new, field) in [
            ("kpa_per_k = 0.31", "kpa_per_k = 31000.0", "taxels[0].kpa_per_k"),
            ("name = \"b\"", "name = \"a\"", "taxels[1].name"),
            ("[24.5, 31.25]", "[31.25, 24.5]", "taxels[0].between_c"),
            (
                "remaining_kpa = 0.0125",
                "remaining_kpa = -1.0",
                "taxels[0].remaining_kpa",
            ),
            ("remaining_kpa = 0.0125", "remaining_kpa = nan", "remaining_kpa"),
            ("provenance = \"real\"", "provenance = \"guessed\"", "provenance"),
        ] {
            assert!(text.contains(old), "no `{old}` in {text}");
            let error = Compensation::parse("t.toml", &text.replace(old, new)).unwrap_err();
            assert!(error.to_string().contains(field), "{error}");
        }
    }
}
