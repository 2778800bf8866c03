//! Settings of a test setup, which people write.

use glam::DVec3;
use serde::{Deserialize, Serialize};
use twintac_config::ConfigError;
use twintac_rig::{Limits, Retreat, Setup};

use crate::Placement;

/// Largest heights and speeds above the gel: no robot arm needs more.
const MOST_MM: f64 = 1000.0;
const MOST_RAD_PER_S: f64 = 10.0;
/// Largest distance from the robot's base, mm.
const FARTHEST_MM: f64 = 10_000.0;
const MOST_N: f64 = 1000.0;
/// Largest waiting time, s.
const MOST_S: f64 = 60.0;
/// One second, in µs. Barometers convert in milliseconds.
const MOST_CONVERSION_US: f64 = 1e6;

/// How presses are carried out on a test setup.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct PressSettings {
    /// Poses of gel and indenter.
    pub placement: Placement,
    /// Time from one pose to the next, s: 0.004 to 0.02.
    pub servo_period_s: f64,
    /// Height above the gel at which the indenter travels, mm.
    pub travel_height_mm: f64,
    /// Highest speed above the gel, mm/s.
    pub travel_speed_mm_per_s: f64,
    /// Highest speed of rotation above the gel, rad/s.
    pub turn_speed_rad_per_s: f64,
    /// Height above the gel at which the slow approach begins, mm, unless the protocol's clearance
    /// is larger.
    pub approach_height_mm: f64,
    /// Speed of the approach, mm/s.
    pub approach_speed_mm_per_s: f64,
    /// How far below the described surface the first touch is searched, mm.
    pub search_mm: f64,
    /// Mean force along the press direction that counts as first touch, N.
    pub touch_force_n: f64,
    /// Time over which that mean is taken, s.
    pub touch_window_s: f64,
    /// Time over which the force without load is averaged before each press, s.
    pub tare_s: f64,
    /// Largest force that may count as zero load, N.
    pub largest_tare_n: f64,
    /// The supervisor's limits.
    pub limits: Limits,
    /// Longest silence of the force sensor, s.
    pub force_silence_s: f64,
    /// Longest silence of the robot's reports, s.
    pub robot_silence_s: f64,
    /// Longest silence of the tactile sensor, s.
    pub tactile_silence_s: f64,
    /// Longest time between two tactile frames that does not count as a gap, s.
    pub frame_gap_s: f64,
    /// Longest time between two of the robot's reports that does not count as a gap, s.
    pub report_gap_s: f64,
    /// Most readings of the force sensor that may be lost in a row without a stop.
    pub tolerated_loss: u32,
    /// How to move back after a stop.
    pub retreat: Retreat,
    /// Time in which the barometers convert and are not read, µs.
    pub conversion_us: u32,
    /// Where the devices are. An emulated setup has its own devices.
    pub devices: Option<Devices>,
}

/// Where the devices of a test setup are.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Devices {
    /// Name or network address of the xArm's controller.
    pub robot: String,
    /// Name or network address of the Net F/T box.
    pub force: String,
    /// Where the tactile sensor is: its I²C bus, such as /dev/i2c-1; with `line`, a serial port
    /// such as /dev/ttyACM0, or `udp:0.0.0.0:9000` for datagrams.
    pub tactile: String,
    /// The TOML file that describes frames on a serial line or in datagrams, relative to the folder
    /// in which the program runs.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub line: Option<std::path::PathBuf>,
    /// The tool centre point that is set in the robot's controller, in the flange's frame, mm.
    /// Placement and limits refer to it, so a controller with another one is refused. Default: the
    /// flange itself.
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

    /// The first field that is not valid: its name, what is wrong, and what to do.
    pub(crate) fn problem(&self) -> Option<(&'static str, String, String)> {
        for (field, value, most) in [
            ("travel_height_mm", self.travel_height_mm, MOST_MM),
            ("travel_speed_mm_per_s", self.travel_speed_mm_per_s, MOST_MM),
            ("turn_speed_rad_per_s", self.turn_speed_rad_per_s, MOST_RAD_PER_S),
            ("approach_height_mm", self.approach_height_mm, MOST_MM),
            ("approach_speed_mm_per_s", self.approach_speed_mm_per_s, MOST_MM),
            ("search_mm", self.search_mm, MOST_MM),
            ("touch_force_n", self.touch_force_n, MOST_N),
            ("touch_window_s", self.touch_window_s, MOST_S),
            ("tare_s", self.tare_s, MOST_S),
            ("largest_tare_n", self.largest_tare_n, MOST_N),
            ("force_silence_s", self.force_silence_s, MOST_S),
            ("robot_silence_s", self.robot_silence_s, MOST_S),
            ("tactile_silence_s", self.tactile_silence_s, MOST_S),
            ("frame_gap_s", self.frame_gap_s, MOST_S),
            ("report_gap_s", self.report_gap_s, MOST_S),
            ("conversion_us", f64::from(self.conversion_us), MOST_CONVERSION_US),
        ] {
            if !(value > 0.0 && value <= most) {
                let hint = format!("give a number above zero, {most} at most");
                return Some((field, format!("is {value}"), hint));
            }
        }
        if !(0.004..=0.02).contains(&self.servo_period_s) {
            let problem = format!("is {}", self.servo_period_s);
            return Some(("servo_period_s", problem, "give 0.004 to 0.02".to_owned()));
        }
        let is_unit = |length: f64| (length - 1.0).abs() <= 1e-6;
        let placement = &self.placement;
        for (field, pose) in [
            ("placement.base_from_gel", placement.base_from_gel),
            ("placement.tool_from_indenter", placement.tool_from_indenter),
        ] {
            let is_near = pose.position_mm.abs().max_element() <= FARTHEST_MM;
            if !is_near || pose.position_mm.is_nan() {
                let problem = format!("is at {} mm", pose.position_mm);
                return Some((field, problem, format!("give positions within {FARTHEST_MM} mm")));
            }
            if !is_unit(pose.rotation.length()) {
                let problem = "has no unit quaternion".to_owned();
                return Some((field, problem, "normalise its rotation".to_owned()));
            }
        }
        if !is_unit(placement.force_axis.length()) {
            let problem = format!("is {}", placement.force_axis);
            return Some(("placement.force_axis", problem, "give a unit vector".to_owned()));
        }
        None
    }

    /// The supervisor's setup for a press. `surface_mm` is the tool's position at which its
    /// indenter touches the gel, in the base frame.
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
        for (field, value) in [
            ("tare_s", "1e9"),
            ("touch_window_s", "inf"),
            ("frame_gap_s", "nan"),
        ] {
            let line = text
                .lines()
                .find(|line| line.starts_with(&format!("{field} = ")))
                .unwrap();
            assert_eq!(wrong(line, &format!("{field} = {value}")), field);
        }
        let line = text
            .lines()
            .find(|line| line.starts_with("conversion_us = "))
            .unwrap();
        assert_eq!(wrong(line, "conversion_us = 4294967295"), "conversion_us");
        assert_eq!(
            wrong("force_axis = [0.0, 0.0, -1.0]", "force_axis = [0.0, 0.0, -2.0]"),
            "placement.force_axis"
        );
    }
}
