//! Conditions that must hold before anything moves.

use twintac_recording::Provenance;
use twintac_rig::SensorLimits;
use twintac_rig::xarm::RobotStatus;
use twintac_sensor::Sensor;

use crate::{Devices, PressError, PressSettings};

/// Longest allowed silence of the force sensor on a real setup, s.
const LONGEST_FORCE_SILENCE_S: f64 = 0.1;
/// Longest allowed silence of the robot or of the tactile sensor on a real setup, s.
const LONGEST_SILENCE_S: f64 = 0.5;
/// Largest distance of the controller's tool centre point from the expected one, mm.
const SAME_TOOL_MM: f64 = 0.01;

/// The limits in the description of a sensor. A sensor without limits is not pressed.
///
/// # Errors
/// [`PressError::NoLimits`].
pub fn sensor_limits(sensor: &Sensor) -> Result<SensorLimits, PressError> {
    let limits = sensor.limits.ok_or_else(|| PressError::NoLimits {
        sensor: sensor.name.clone(),
    })?;
    Ok(SensorLimits {
        force_n: limits.force_n,
        depth_mm: limits.depth_mm,
    })
}

impl PressSettings {
    /// The devices of a real setup.
    ///
    /// # Errors
    /// [`PressError::NoDevices`]: the settings name no devices. [`PressError::Setting`]: a device
    /// may be silent for too long.
    pub fn real_devices(&self) -> Result<&Devices, PressError> {
        let devices = self.devices.as_ref().ok_or(PressError::NoDevices)?;
        self.check_for(Provenance::Real)?;
        Ok(devices)
    }

    /// Checks every field and, for a real setup, also the allowed silences of its devices.
    pub(crate) fn check_for(&self, provenance: Provenance) -> Result<(), PressError> {
        if let Some((field, problem, hint)) = self.problem() {
            return Err(PressError::Setting { field, problem, hint });
        }
        if provenance != Provenance::Real {
            return Ok(());
        }
        for (field, silence_s, longest_s) in [
            ("force_silence_s", self.force_silence_s, LONGEST_FORCE_SILENCE_S),
            ("robot_silence_s", self.robot_silence_s, LONGEST_SILENCE_S),
            ("tactile_silence_s", self.tactile_silence_s, LONGEST_SILENCE_S),
        ] {
            let is_watched_closely = silence_s <= longest_s; // false for NaN
            if !is_watched_closely {
                let problem = format!("is {silence_s} on a test setup with a real robot");
                let hint = match field {
                    "force_silence_s" => "give at most 0.1 s",
                    _ => "give at most 0.5 s",
                };
                return Err(PressError::Setting {
                    field,
                    problem,
                    hint: hint.to_owned(),
                });
            }
        }
        Ok(())
    }
}

impl Devices {
    /// Checks that the controller's tool centre point is the one to which placement and limits
    /// refer.
    ///
    /// # Errors
    /// [`PressError::OtherTool`].
    pub fn check_tool(&self, found: &RobotStatus) -> Result<(), PressError> {
        let found_mm = found.tcp_offset.position_mm;
        let is_same = found_mm.distance(self.tcp_offset_mm) <= SAME_TOOL_MM; // false for NaN
        is_same.then_some(()).ok_or(PressError::OtherTool {
            found_mm,
            expected_mm: self.tcp_offset_mm,
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const REAL: &str = include_str!("../../../../rigs/xarm.toml");

    fn refused(text: &str) -> String {
        let settings = PressSettings::parse("bench.toml", text).unwrap();
        settings.real_devices().unwrap_err().to_string()
    }

    #[test]
    fn the_shipped_bench_is_watched_closely_enough() {
        let settings = PressSettings::parse("xarm.toml", REAL).unwrap();
        assert_eq!(settings.real_devices().unwrap().tactile, "/dev/i2c-1");
    }

    #[test]
    fn a_real_bench_with_the_labs_patience_or_without_devices_is_refused() {
        let patient = REAL.replace("force_silence_s = 0.05", "force_silence_s = 0.5");
        assert!(refused(&patient).contains("`force_silence_s` is 0.5"));
        let patient = REAL.replace("tactile_silence_s = 0.2", "tactile_silence_s = 0.6");
        assert!(refused(&patient).contains("`tactile_silence_s` is 0.6"));
        let (before, _) = REAL.split_once("\n[devices]").unwrap();
        let (_, after) = REAL.split_once("\n[placement]").unwrap();
        assert!(refused(&format!("{before}\n[placement]{after}")).contains("[devices]"));
    }

    #[test]
    fn settings_that_a_program_has_changed_are_checked_again() {
        let settings = PressSettings::parse("xarm.toml", REAL).unwrap();
        let field = |change: fn(&mut PressSettings)| {
            let mut changed = settings.clone();
            change(&mut changed);
            match changed.check_for(Provenance::Real) {
                Err(PressError::Setting { field, .. }) => field,
                other => panic!("{other:?}"),
            }
        };
        assert_eq!(
            field(|settings| settings.robot_silence_s = f64::NAN),
            "robot_silence_s"
        );
        assert_eq!(field(|settings| settings.search_mm = f64::NAN), "search_mm");
        assert_eq!(field(|settings| settings.servo_period_s = 0.5), "servo_period_s");
        let mut patient = settings.clone();
        patient.robot_silence_s = 0.6;
        assert!(patient.check_for(Provenance::Emulated).is_ok());
    }

    #[test]
    fn a_sensor_without_limits_is_not_pressed() {
        let mut sensor = Sensor::read("../../../sensors/phystac.toml").unwrap();
        let limits = sensor.limits.unwrap();
        assert_eq!(sensor_limits(&sensor).unwrap().force_n, limits.force_n);
        sensor.limits = None;
        assert!(
            sensor_limits(&sensor)
                .unwrap_err()
                .to_string()
                .contains("[limits]")
        );
    }
}
