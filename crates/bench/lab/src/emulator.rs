//! Emulator configurations: how the emulated bench differs from its drawings.

use serde::{Deserialize, Serialize};
use twintac_config::{Checked, ConfigError, Ranges};

/// The imperfections of one emulated bench. All random values come from `seed` and a name, and are
/// drawn once per bench or per press.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct EmulatorConfiguration {
    /// Description of this configuration for people.
    pub summary: String,
    /// Seed of the cast and of every press.
    pub seed: u64,
    /// The gel as it was cast.
    pub gel: EmulatedGel,
    /// The barometers and their clock.
    pub readout: EmulatedReadout,
    /// The robot and the force sensor.
    pub robot: EmulatedRobot,
    /// The installation of the sensor under the robot. Default: level.
    #[serde(default)]
    pub mounting: EmulatedInstallation,
    /// The temperature of the sensor. Default: always 25 °C.
    #[serde(default)]
    pub climate: EmulatedClimate,
}

/// The gel as it was cast, and the resolution of its computation.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct EmulatedGel {
    /// Element edges of the emulator's own mesh over the gel's height.
    pub edges_per_height: f64,
    /// Element edges over the radius of the contact.
    pub edges_per_contact_radius: f64,
    /// Yeoh constants C10, C20, C30 of the instantaneous response, kPa.
    pub yeoh_kpa: [f64; 3],
    /// Bulk modulus, kPa.
    pub bulk_modulus_kpa: f64,
    /// Viscoelastic relaxation: fraction of the instantaneous stiffness and time constant of each
    /// term.
    pub relaxation: Vec<Relaxation>,
    /// Ratio of the height to the described height. Default 1. A robot that is set up by touching
    /// the gel does not notice this difference.
    #[serde(default = "one")]
    pub height_ratio: f64,
    /// Coulomb's coefficient of friction between indenters and gel. Default 0. An indenter whose
    /// description has a coefficient keeps it.
    #[serde(default)]
    pub friction: f64,
    /// Largest change of depth between two computed moments, mm.
    pub depth_step_mm: f64,
}

/// One term of the gel's relaxation.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Relaxation {
    /// Fraction of the instantaneous isochoric stiffness that relaxes, 0 to 1.
    pub weight: f64,
    /// Time constant, s.
    pub time_s: f64,
}

/// The barometers and their clock. Standard deviations are of normal distributions.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct EmulatedReadout {
    /// Mean gain of the taxels: the ratio of the reading to the pressure of the gel at the port. A
    /// cast that is badly bonded or has bubbles has a lower gain, a cavity that concentrates
    /// pressure has a higher one. Default 1.
    #[serde(default = "one")]
    pub gain_mean: f64,
    /// Standard deviation of a taxel's gain, as a fraction of the mean.
    pub gain_deviation: f64,
    /// Mean volume of the air that is trapped in a port, mm³. Default 0.
    #[serde(default)]
    pub bubble_mm3: f64,
    /// Standard deviation of this volume between taxels, mm³. Negative volumes become 0. Default 0.
    #[serde(default)]
    pub bubble_deviation_mm3: f64,
    /// Standard deviation of a taxel's offset, kPa.
    pub offset_deviation_kpa: f64,
    /// Standard deviation of a taxel's position along x and y, mm.
    pub position_deviation_mm: f64,
    /// Standard deviation of the noise of one reading, kPa.
    pub noise_kpa: f64,
    /// Standard deviation of the random walk of each offset over one second, kPa.
    pub drift_kpa_per_sqrt_s: f64,
    /// Change of an offset with temperature, mean of the taxels, kPa/K. Default 0.
    #[serde(default)]
    pub offset_kpa_per_k: f64,
    /// Standard deviation of this change between taxels, kPa/K. Default 0.
    #[serde(default)]
    pub offset_deviation_kpa_per_k: f64,
    /// Time from the time stamp to the reading of the first taxel, s.
    pub lag_s: f64,
    /// Additional time for each next taxel, s.
    pub lag_per_taxel_s: f64,
    /// Standard deviation of a frame's time stamp about its schedule, s.
    pub jitter_s: f64,
}

/// The robot and the force sensor. Standard deviations are of normal distributions.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct EmulatedRobot {
    /// Standard deviation of a press's location along x and y, mm.
    pub place_deviation_mm: f64,
    /// Depth by which every press is deeper than commanded, because the surface is not where it was
    /// taught, mm.
    pub depth_offset_mm: f64,
    /// Standard deviation of a press's depth about this value, mm.
    pub depth_deviation_mm: f64,
    /// Standard deviation of the noise of one force sample, N.
    pub force_noise_n: f64,
    /// Delay of the force sensor's samples, s.
    pub force_lag_s: f64,
}

/// The installation of the sensor under the robot. The robot assumes that the sensor is level. The
/// sensor is rotated about the middle of its top, where the robot was set up.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct EmulatedInstallation {
    /// Rotation about the bench's x and y axes, rad.
    pub tilt_rad: [f64; 2],
}

/// The temperature of the sensor. After power-up it rises, because of the heat of its own chips and
/// of a robot above it.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct EmulatedClimate {
    /// Temperature at power-up, °C.
    pub start_c: f64,
    /// Final temperature rise, K.
    pub warming_k: f64,
    /// Time constant of the rise, s.
    pub warming_time_s: f64,
}

impl Default for EmulatedClimate {
    /// Always 25 °C.
    fn default() -> Self {
        Self {
            start_c: 25.0,
            warming_k: 0.0,
            warming_time_s: 300.0,
        }
    }
}

impl EmulatedClimate {
    /// Temperature rise since power-up, K, at a time since power-up, s.
    pub(crate) fn warmed_k(&self, time_s: f64) -> f64 {
        -self.warming_k * (-time_s / self.warming_time_s).exp_m1()
    }
}

/// Largest tilt about an axis, rad. Nobody would take a sensor with a larger tilt for level.
const LARGEST_TILT_RAD: f64 = 0.2;

fn one() -> f64 {
    1.0
}

impl EmulatorConfiguration {
    /// Reads an emulator configuration from the text of a TOML file. Errors name file, line and
    /// field.
    pub fn parse(file: &str, text: &str) -> Result<Self, ConfigError> {
        twintac_config::parse::<Self>(file, text)?.checked()
    }
}

impl Checked for EmulatorConfiguration {
    fn check(&self, ranges: &mut Ranges) {
        let Self {
            summary: _,
            seed: _,
            gel,
            readout,
            robot,
            mounting,
            climate,
        } = self;
        ranges.inside("gel", gel);
        ranges.inside("readout", readout);
        ranges.inside("robot", robot);
        ranges.inside("mounting", mounting);
        ranges.inside("climate", climate);
    }
}

impl Checked for EmulatedGel {
    fn check(&self, ranges: &mut Ranges) {
        let Self {
            edges_per_height,
            edges_per_contact_radius,
            yeoh_kpa: [c10, c20, c30],
            bulk_modulus_kpa,
            relaxation,
            height_ratio,
            friction,
            depth_step_mm,
        } = self;
        ranges.number("edges_per_height", *edges_per_height, 1.0..=20.0);
        ranges.number("edges_per_contact_radius", *edges_per_contact_radius, 0.5..=20.0);
        ranges.number("yeoh_kpa[0]", *c10, 0.01..=1e5);
        ranges.number("yeoh_kpa[1]", *c20, -1e5..=1e5);
        ranges.number("yeoh_kpa[2]", *c30, -1e5..=1e5);
        ranges.number("bulk_modulus_kpa", *bulk_modulus_kpa, 1.0..=1e7);
        ranges.number("height_ratio", *height_ratio, 0.1..=10.0);
        ranges.zero_or("friction", *friction, 1e-6..=10.0);
        ranges.number("depth_step_mm", *depth_step_mm, 0.005..=5.0);
        for (index, Relaxation { weight, time_s }) in relaxation.iter().enumerate() {
            ranges.number(&format!("relaxation[{index}].weight"), *weight, 1e-6..=1.0);
            ranges.number(&format!("relaxation[{index}].time_s"), *time_s, 1e-4..=1e6);
        }
        let relaxing: f64 = relaxation.iter().map(|term| term.weight).sum();
        let problem = || format!("relaxes {relaxing} of the stiffness");
        let hint = || "keep the weights' sum below 1";
        ranges.that("relaxation", relaxing < 1.0, problem, hint);
    }
}

impl Checked for EmulatedReadout {
    fn check(&self, ranges: &mut Ranges) {
        let Self {
            gain_mean,
            gain_deviation,
            bubble_mm3,
            bubble_deviation_mm3,
            offset_deviation_kpa,
            position_deviation_mm,
            noise_kpa,
            drift_kpa_per_sqrt_s,
            offset_kpa_per_k,
            offset_deviation_kpa_per_k,
            lag_s,
            lag_per_taxel_s,
            jitter_s,
        } = *self;
        ranges.number("gain_mean", gain_mean, 1e-3..=1e3);
        ranges.number("gain_deviation", gain_deviation, 0.0..=1.0);
        ranges.number("bubble_mm3", bubble_mm3, 0.0..=1e3);
        ranges.number("bubble_deviation_mm3", bubble_deviation_mm3, 0.0..=1e3);
        ranges.number("offset_deviation_kpa", offset_deviation_kpa, 0.0..=1e3);
        ranges.number("position_deviation_mm", position_deviation_mm, 0.0..=5.0);
        ranges.number("noise_kpa", noise_kpa, 0.0..=1e3);
        ranges.number("drift_kpa_per_sqrt_s", drift_kpa_per_sqrt_s, 0.0..=1e3);
        ranges.number("offset_kpa_per_k", offset_kpa_per_k, -1e3..=1e3);
        ranges.number(
            "offset_deviation_kpa_per_k",
            offset_deviation_kpa_per_k,
            0.0..=1e3,
        );
        ranges.number("lag_s", lag_s, 0.0..=1.0);
        ranges.number("lag_per_taxel_s", lag_per_taxel_s, 0.0..=1.0);
        ranges.number("jitter_s", jitter_s, 0.0..=0.1);
    }
}

impl Checked for EmulatedRobot {
    fn check(&self, ranges: &mut Ranges) {
        let Self {
            place_deviation_mm,
            depth_offset_mm,
            depth_deviation_mm,
            force_noise_n,
            force_lag_s,
        } = *self;
        ranges.number("place_deviation_mm", place_deviation_mm, 0.0..=5.0);
        ranges.number("depth_offset_mm", depth_offset_mm, -5.0..=5.0);
        ranges.number("depth_deviation_mm", depth_deviation_mm, 0.0..=5.0);
        ranges.number("force_noise_n", force_noise_n, 0.0..=100.0);
        ranges.number("force_lag_s", force_lag_s, 0.0..=10.0);
    }
}

impl Checked for EmulatedInstallation {
    fn check(&self, ranges: &mut Ranges) {
        let Self { tilt_rad } = self;
        ranges.numbers("tilt_rad", tilt_rad, 2, -LARGEST_TILT_RAD..=LARGEST_TILT_RAD);
    }
}

impl Checked for EmulatedClimate {
    fn check(&self, ranges: &mut Ranges) {
        let Self {
            start_c,
            warming_k,
            warming_time_s,
        } = *self;
        ranges.number("warming_time_s", warming_time_s, 1e-3..=1e6);
        // The range that the barometers' registers can represent.
        for (field, temperature_c) in [("start_c", start_c), ("warming_k", start_c + warming_k)] {
            let problem = || format!("makes the sensor {temperature_c:?} °C");
            let hint = || "keep it between -128 and 128 °C";
            ranges.that(field, (-128.0..128.0).contains(&temperature_c), problem, hint);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const SHIPPED: &str = include_str!("../../../../emulators/default.toml");

    const HARDER: &str = include_str!("../../../../emulators/harder.toml");
    const THICKER: &str = include_str!("../../../../emulators/thicker.toml");

    #[test]
    fn the_shipped_configurations_are_valid() {
        for text in [SHIPPED, HARDER, THICKER] {
            EmulatorConfiguration::parse("shipped.toml", text).unwrap();
        }
    }

    #[test]
    fn a_file_that_names_no_further_imperfection_has_none() {
        let emulator = EmulatorConfiguration::parse("default.toml", SHIPPED).unwrap();
        assert_eq!(emulator.mounting, EmulatedInstallation::default());
        assert_eq!((emulator.gel.height_ratio, emulator.gel.friction), (1.0, 0.0));
        assert_eq!(
            (emulator.readout.bubble_mm3, emulator.readout.bubble_deviation_mm3),
            (0.0, 0.0)
        );
    }

    #[test]
    fn the_thicker_gel_is_the_default_one_but_for_its_height_and_stiffness() {
        let mut thicker = EmulatorConfiguration::parse("thicker.toml", THICKER).unwrap();
        let default = EmulatorConfiguration::parse("default.toml", SHIPPED).unwrap();
        assert_eq!(thicker.gel.height_ratio, 1.2);
        for (thicker, default) in thicker.gel.yeoh_kpa.iter().zip(default.gel.yeoh_kpa) {
            assert!((thicker - 1.2 * default).abs() < 1e-12);
        }
        thicker.gel = default.gel.clone();
        thicker.summary.clone_from(&default.summary);
        assert_eq!(thicker, default);
    }

    #[test]
    fn an_impossible_imperfection_is_refused_at_its_field() {
        for (right, wrong, field) in [
            ("friction = 0.25", "friction = -0.25", "gel.friction"),
            ("friction = 0.25", "height_ratio = 0.0", "gel.height_ratio"),
            ("friction = 0.25", "height_ratio = inf", "gel.height_ratio"),
            ("bubble_mm3 = 2.0", "bubble_mm3 = nan", "readout.bubble_mm3"),
            (
                "bubble_deviation_mm3 = 0.6",
                "bubble_deviation_mm3 = -1",
                "readout.bubble_deviation_mm3",
            ),
            ("tilt_rad = [0.02,", "tilt_rad = [1.1,", "mounting.tilt_rad[0]"),
            ("-0.015]", "nan]", "mounting.tilt_rad[1]"),
        ] {
            assert!(HARDER.contains(right), "{right}");
            let error =
                EmulatorConfiguration::parse("harder.toml", &HARDER.replace(right, wrong)).unwrap_err();
            assert_eq!(error.field, field);
        }
    }

    #[test]
    fn a_gel_that_relaxes_to_nothing_is_refused() {
        let text = SHIPPED.replace("weight = 0.06", "weight = 0.96");
        let error = EmulatorConfiguration::parse("default.toml", &text)
            .unwrap_err()
            .to_string();
        assert!(
            error.contains("gel.relaxation") && error.contains("below 1"),
            "{error}"
        );
    }

    #[test]
    fn a_bench_without_a_climate_keeps_its_temperature() {
        let (before, _) = SHIPPED.split_once("[climate]").unwrap();
        let emulator = EmulatorConfiguration::parse("default.toml", before).unwrap();
        assert_eq!(emulator.climate.warmed_k(1000.0), 0.0);
    }

    #[test]
    fn it_warms_by_two_thirds_in_its_time_constant_and_no_further_than_said() {
        let climate = EmulatedClimate {
            start_c: 20.0,
            warming_k: 3.0,
            warming_time_s: 100.0,
        };
        assert_eq!(climate.warmed_k(0.0), 0.0);
        assert!((climate.warmed_k(100.0) - 3.0 * (1.0 - (-1.0_f64).exp())).abs() < 1e-12);
        assert!((climate.warmed_k(1e5) - 3.0).abs() < 1e-12);
    }

    #[test]
    fn a_temperature_that_no_register_can_say_is_refused() {
        let text = SHIPPED.replace("start_c = ", "start_c = 2");
        let error = EmulatorConfiguration::parse("default.toml", &text).unwrap_err();
        assert_eq!(error.field, "climate.start_c");
    }

    #[test]
    fn a_negative_noise_is_refused_at_its_line() {
        let text = SHIPPED.replace("noise_kpa = ", "noise_kpa = -");
        let error = EmulatorConfiguration::parse("default.toml", &text).unwrap_err();
        assert_eq!(error.field, "readout.noise_kpa");
        assert!(
            text.lines().nth(error.line - 1).unwrap().starts_with("noise_kpa"),
            "{error}"
        );
    }

    #[test]
    fn every_number_has_a_range() {
        // Zero switches these imperfections off.
        let signed = [
            "gel.yeoh_kpa[1]",
            "gel.yeoh_kpa[2]",
            "readout.offset_kpa_per_k",
            "robot.depth_offset_mm",
            "climate.start_c",
            "climate.warming_k",
        ];
        let mut n_numbers = 0;
        for wrong in [-1.0, 1e300, 1e-300, 0.0, f64::NAN] {
            for (field, text) in twintac_config::with_each_number(HARDER, wrong) {
                n_numbers += 1;
                match EmulatorConfiguration::parse("harder.toml", &text) {
                    Ok(_) if field == "seed" => assert_eq!(wrong, 0.0),
                    Ok(_) if wrong < 0.0 => assert!(signed.contains(&&field[..]), "{field} = {wrong}"),
                    Ok(_) => assert!(wrong < 1.0, "{field} = {wrong}"),
                    Err(error) => {
                        let sum = field == "climate.start_c" && error.field == "climate.warming_k";
                        assert!(error.field == field || sum, "{field} = {wrong}: {error}");
                    }
                }
            }
        }
        assert!(n_numbers >= 5 * 38, "{n_numbers}");
    }
}
