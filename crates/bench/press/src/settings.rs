//! The bench settings that people write.

use glam::DVec3;
use serde::{Deserialize, Serialize};
use twintac_config::ConfigError;
use twintac_rig::{Limits, Retreat, Setup};

use crate::Placement;

/// How presses are carried out on a bench.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct PressSettings {
    /// Where gel and indenter stand.
    pub placement: Placement,
    /// Time from one pose to the next, s: 0.004 to 0.02.
    pub servo_period_s: f64,
    /// Height above the gel at which the indenter travels, mm.
    pub travel_height_mm: f64,
    /// Speed above the gel, at its highest, mm/s.
    pub travel_speed_mm_per_s: f64,
    /// Speed of turning above the gel, at its highest, rad/s.
    pub turn_speed_rad_per_s: f64,
    /// Height above the gel at which the slow approach begins, if the protocol's clearance is no larger, mm.
    pub approach_height_mm: f64,
    /// Speed of the approach, mm/s.
    pub approach_speed_mm_per_s: f64,
    /// How far below the described surface first touch is looked for, mm.
    pub search_mm: f64,
    /// Mean force along the press that is first touch, N.
    pub touch_force_n: f64,
    /// Time over which that mean is taken, s.
    pub touch_window_s: f64,
    /// Time over which the force without load is averaged before each press, s.
    pub tare_s: f64,
    /// Largest force that may count as no load, N.
    pub largest_tare_n: f64,
    /// The supervisor's limits.
    pub limits: Limits,
    /// Longest silence of the force sensor, s.
    pub force_silence_s: f64,
    /// Longest silence of the robot's reports, s.
    pub robot_silence_s: f64,
    /// Longest silence of the tactile sensor, s.
    pub tactile_silence_s: f64,
    /// Longest time between two tactile frames that is no gap, s.
    pub frame_gap_s: f64,
    /// Longest time between two of the robot's reports that is no gap, s.
    pub report_gap_s: f64,
    /// Readings of the force sensor that may be lost in a row without a stop.
    pub tolerated_loss: u32,
    /// How to go back after a stop.
    pub retreat: Retreat,
    /// How long the barometers are left alone to convert, µs.
    pub conversion_us: u32,
    /// Where the devices are; an emulated bench has its own.
    pub devices: Option<Devices>,
}

/// Where the devices of a bench are.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Devices {
    /// Name or address of the xArm's controller.
    pub robot: String,
    /// Name or address of the Net F/T box.
    pub force: String,
    /// I²C bus of the tactile sensor, such as /dev/i2c-1.
    pub tactile: String,
    /// The tool centre point that is set in the robot's controller, in the flange's frame, mm: placement and limits count from there, so a
    /// controller with another one is refused. Default: the flange itself.
    #[serde(default)]
    pub tcp_offset_mm: DVec3,
}

impl PressSettings {
    /// Reads settings from the text of a TOML file.
    ///
    /// # Errors
    /// The first field that is wrong, with file and line.
    pub fn parse(file: &str, text: &str) -> Result<Self, ConfigError> {
        let document = twintac_config::parse::<Self>(file, text)?;
        match document.value.problem() {
            Some((field, problem, hint)) => Err(document.error(field, problem, hint)),
            None => Ok(document.value),
        }
    }

    /// The first field that makes no sense: its name, what is wrong, and what to do.
    pub(crate) fn problem(&self) -> Option<(&'static str, String, &'static str)> {
        for (field, value) in [
            ("travel_height_mm", self.travel_height_mm),
            ("travel_speed_mm_per_s", self.travel_speed_mm_per_s),
            ("turn_speed_rad_per_s", self.turn_speed_rad_per_s),
            ("approach_height_mm", self.approach_height_mm),
            ("approach_speed_mm_per_s", self.approach_speed_mm_per_s),
            ("search_mm", self.search_mm),
            ("touch_force_n", self.touch_force_n),
            ("touch_window_s", self.touch_window_s),
            ("tare_s", self.tare_s),
            ("largest_tare_n", self.largest_tare_n),
            ("tactile_silence_s", self.tactile_silence_s),
            ("frame_gap_s", self.frame_gap_s),
            ("report_gap_s", self.report_gap_s),
        ] {
            if value <= 0.0 || !value.is_finite() {
                return Some((field, format!("is {value}"), "give a number above zero"));
            }
        }
        if !(0.004..=0.02).contains(&self.servo_period_s) {
            let problem = format!("is {}", self.servo_period_s);
            return Some(("servo_period_s", problem, "give 0.004 to 0.02"));
        }
        let is_unit = |length: f64| (length - 1.0).abs() <= 1e-6;
        let placement = &self.placement;
        for (field, rotation) in [
            ("placement.base_from_gel", placement.base_from_gel.rotation),
            (
                "placement.tool_from_indenter",
                placement.tool_from_indenter.rotation,
            ),
        ] {
            if !is_unit(rotation.length()) {
                let problem = "has no unit quaternion".to_owned();
                return Some((field, problem, "normalise its rotation"));
            }
        }
        if !is_unit(placement.force_axis.length()) {
            let problem = format!("is {}", placement.force_axis);
            return Some(("placement.force_axis", problem, "give a unit vector"));
        }
        None
    }

    /// What the supervisor is set up with for a press whose indenter touches the gel with the tool at `surface_mm`, in the base's frame.
    pub(crate) fn setup(&self, surface_mm: DVec3) -> Setup {
        Setup {
            limits: self.limits,
            surface_mm,
            approach: self.placement.approach(),
            servo_period_s: self.servo_period_s,
            force_silence_s: self.force_silence_s,
            robot_silence_s: self.robot_silence_s,
            retreat: self.retreat,
        }
    }
}

#[cfg(test)]
pub(crate) fn example() -> PressSettings {
    PressSettings::parse("bench.toml", include_str!("../tests/bench.toml")).unwrap()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn mistakes_are_named_with_their_line() {
        let text = include_str!("../tests/bench.toml");
        let wrong = |old: &str, new: &str| {
            assert!(text.contains(old), "{old}");
            PressSettings::parse("bench.toml", &text.replace(old, new))
                .unwrap_err()
                .field
        };
        assert_eq!(wrong("search_mm = ", "search_mm = -"), "search_mm");
        assert_eq!(
            wrong("servo_period_s = 0.008", "servo_period_s = 0.5"),
            "servo_period_s"
        );
        assert_eq!(
            wrong("force_axis = [0.0, 0.0, -1.0]", "force_axis = [0.0, 0.0, -2.0]"),
            "placement.force_axis"
        );
    }
}
