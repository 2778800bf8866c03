//! Sensor variation: the distributions of deviations from a perfect sensor, read from TOML.

use serde::{Deserialize, Serialize};
use twintac_config::{ConfigError, Document};

/// The distributions from which each sensor's deviations are drawn. Zero leaves a deviation out;
/// [`SensorVariation::default`] is a perfect sensor. *Deviation* in the fields is the standard
/// deviation of a normal distribution about zero.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct SensorVariation {
    /// Deviation of each taxel's gain, as a fraction of the gain.
    pub gain_deviation: f64,
    /// Deviation of the relative growth of each taxel's gain with its reading, 1/kPa.
    pub growth_deviation_per_kpa: f64,
    /// Deviation of each taxel's zero, kPa.
    pub offset_deviation_kpa: f64,
    /// Temperature drift that all taxels share, kPa/K; of either sign.
    pub drift_kpa_per_k: f64,
    /// Deviation of each taxel's temperature drift from the shared one, kPa/K.
    pub drift_deviation_kpa_per_k: f64,
    /// Deviation of the temperature from that of the tare, K. It fluctuates with the time constant
    /// [`Self::temperature_time_s`].
    pub temperature_deviation_k: f64,
    /// Time constant with which the temperature fluctuates, s.
    pub temperature_time_s: f64,
    /// Fraction of every other taxel's pressure that a taxel reads in addition, beyond what the gel
    /// spreads; of either sign.
    pub cross_talk: f64,
    /// Deviation of that fraction from pair to pair.
    pub cross_talk_deviation: f64,
    /// Deviation of each reading's noise, kPa.
    pub noise_deviation_kpa: f64,
    /// Resolution: step between readings, kPa.
    pub quantum_kpa: f64,
    /// Half of the gap between loading and unloading, as a fraction of the reading.
    pub hysteresis: f64,
    /// Probability that a taxel always reads zero.
    pub dead_chance: f64,
    /// Probability that a taxel stays at its first reading.
    pub stuck_chance: f64,
    /// Probability that a taxel's readings are late by one frame.
    pub late_chance: f64,
    /// Frames that the bus delivers in a second, Hz; readings stay the same between them. Zero
    /// delivers a frame at each step.
    pub rate_hz: f64,
    /// Deviation of the time between frames, as a fraction of it.
    pub jitter: f64,
    /// Deviation of the logarithm of the gel's modulus from that of the surrogate's gel. Forces and
    /// pressures at given poses are proportional to it.
    pub modulus_deviation: f64,
    /// Deviation of the height at which the sensor is installed, mm.
    pub height_deviation_mm: f64,
    /// Deviation of the sensor's position along x and along y, mm.
    pub place_deviation_mm: f64,
    /// Deviation of the sensor's rotation about its vertical axis, radians.
    pub turn_deviation_rad: f64,
    /// Deviation of the sensor's tilt about x and about y, radians.
    pub tilt_deviation_rad: f64,
}

/// A file with the table `[variation]`.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct File {
    variation: SensorVariation,
}

impl SensorVariation {
    /// Parses a TOML text with the table `[variation]`; `file` names it in errors.
    ///
    /// # Errors
    /// The first field that is wrong, with file and line.
    pub fn parse(file: &str, text: &str) -> Result<Self, ConfigError> {
        let document = twintac_config::parse::<File>(file, text)?;
        document.value.variation.check(&document)?;
        Ok(document.value.variation)
    }

    fn check(&self, document: &Document<File>) -> Result<(), ConfigError> {
        let widths = [
            ("gain_deviation", self.gain_deviation),
            ("growth_deviation_per_kpa", self.growth_deviation_per_kpa),
            ("offset_deviation_kpa", self.offset_deviation_kpa),
            ("drift_deviation_kpa_per_k", self.drift_deviation_kpa_per_k),
            ("temperature_deviation_k", self.temperature_deviation_k),
            ("temperature_time_s", self.temperature_time_s),
            ("cross_talk_deviation", self.cross_talk_deviation),
            ("noise_deviation_kpa", self.noise_deviation_kpa),
            ("quantum_kpa", self.quantum_kpa),
            ("rate_hz", self.rate_hz),
            ("modulus_deviation", self.modulus_deviation),
            ("height_deviation_mm", self.height_deviation_mm),
            ("place_deviation_mm", self.place_deviation_mm),
            ("turn_deviation_rad", self.turn_deviation_rad),
            ("tilt_deviation_rad", self.tilt_deviation_rad),
        ];
        let parts = [
            ("hysteresis", self.hysteresis),
            ("dead_chance", self.dead_chance),
            ("stuck_chance", self.stuck_chance),
            ("late_chance", self.late_chance),
            ("jitter", self.jitter),
        ];
        let wrong = |name: &str, value: f64, hint: &str| {
            document.error(&format!("variation.{name}"), format!("is {value}"), hint)
        };
        for (name, value) in widths {
            if !value.is_finite() || value < 0.0 {
                return Err(wrong(name, value, "give zero or more"));
            }
        }
        for (name, value) in parts {
            if !(0.0..=1.0).contains(&value) {
                return Err(wrong(name, value, "give a fraction from 0 to 1"));
            }
        }
        if !self.drift_kpa_per_k.is_finite() {
            return Err(wrong(
                "drift_kpa_per_k",
                self.drift_kpa_per_k,
                "give a finite number",
            ));
        }
        if !self.cross_talk.is_finite() || self.cross_talk.abs() > 1.0 {
            return Err(wrong(
                "cross_talk",
                self.cross_talk,
                "give a fraction from -1 to 1",
            ));
        }
        let chances = self.dead_chance + self.stuck_chance + self.late_chance;
        if chances > 1.0 {
            return Err(wrong(
                "late_chance",
                self.late_chance,
                "give three chances with a sum of at most 1",
            ));
        }
        if self.temperature_deviation_k > 0.0 && self.temperature_time_s == 0.0 {
            let hint = "give the time constant of the temperature";
            return Err(wrong("temperature_time_s", 0.0, hint));
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_file_is_read_and_a_wrong_field_is_named() {
        let text = "[variation]\ngain_deviation = 0.05\nrate_hz = 100.0\n";
        let found = SensorVariation::parse("a.toml", text).unwrap();
        assert_eq!(
            found,
            SensorVariation {
                gain_deviation: 0.05,
                rate_hz: 100.0,
                ..SensorVariation::default()
            }
        );
        let former = text.replace("variation", "imperfection");
        assert_eq!(SensorVariation::parse("a.toml", &former).unwrap(), found);
        for (text, expected) in [
            ("[variation]\nnoise_deviation_kpa = -1.0\n", "noise_deviation_kpa"),
            ("[variation]\nhysteresis = 1.5\n", "hysteresis"),
            ("[variation]\ncross_talk = -1.5\n", "cross_talk"),
            (
                "[variation]\ncross_talk_deviation = -0.1\n",
                "cross_talk_deviation",
            ),
            ("[variation]\ntilt_deviation_rad = nan\n", "tilt_deviation_rad"),
            ("[variation]\ndrift_kpa_per_k = inf\n", "drift_kpa_per_k"),
            (
                "[variation]\ndead_chance = 0.6\nlate_chance = 0.5\n",
                "late_chance",
            ),
            (
                "[variation]\ntemperature_deviation_k = 2.0\n",
                "temperature_time_s",
            ),
            ("[variation]\nnois = 1.0\n", "nois"),
            (
                "[imperfection]\njitter = 0.1\nhysteresis = 2.0\n",
                "a.toml:3: `variation.hysteresis`",
            ),
        ] {
            let error = SensorVariation::parse("a.toml", text).unwrap_err().to_string();
            assert!(error.contains(expected) && error.contains("a.toml"), "{error}");
        }
    }
}
