//! Settings of the force sensor.

use serde::{Deserialize, Serialize};
use twintac_rig::netft::Configuration;

use crate::EmulateError;
use crate::error::{check_not_negative, check_positive};

/// Settings of the force sensor and its sockets.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct ForceSettings {
    /// UDP port for requests, and TCP port of its web server. 0: any free port.
    pub ports: [u16; 2],
    /// Records per second, Hz; at most 7000.
    pub rate_hz: f64,
    /// Records in a buffered datagram.
    pub buffered_records: usize,
    /// Counts per newton.
    pub counts_per_newton: f64,
    /// Counts per newton metre.
    pub counts_per_newton_metre: f64,
    /// Largest Fx, Fy, Fz, N, and Tx, Ty, Tz, N mm, positive or negative. Beyond them the gauges
    /// are saturated.
    pub range: [f64; 6],
    /// Standard deviation of a record's forces, N.
    pub noise_n: f64,
    /// Standard deviation of a record's torques, N mm.
    pub noise_n_mm: f64,
    /// Reading without load before the first bias: Fx, Fy, Fz, N, and Tx, Ty, Tz, N mm.
    pub zero: [f64; 6],
    /// Force above which a monitor condition is latched, N, if there is one.
    pub monitor_n: Option<f64>,
    /// Seed of the noise.
    pub seed: u64,
}

impl Default for ForceSettings {
    /// A Mini45 with the calibration SI-290-10, a million counts per unit, 1000 records a second
    /// and 50 mN of noise.
    fn default() -> Self {
        Self {
            ports: [0; 2],
            rate_hz: 1000.0,
            buffered_records: 10,
            counts_per_newton: 1e6,
            counts_per_newton_metre: 1e6,
            range: [290.0, 290.0, 580.0, 1e4, 1e4, 1e4],
            noise_n: 0.05,
            noise_n_mm: 1.0,
            zero: [0.0; 6],
            monitor_n: None,
            seed: 1,
        }
    }
}

impl ForceSettings {
    /// The content of its configuration page.
    #[must_use]
    pub fn configuration(&self) -> Configuration {
        Configuration {
            counts_per_force: self.counts_per_newton,
            counts_per_torque: self.counts_per_newton_metre,
            force_unit: "N".to_owned(),
            torque_unit: "Nm".to_owned(),
            product: Some("emulated Net F/T".to_owned()),
            rate_hz: Some(self.rate_hz),
        }
    }

    pub(crate) fn check(&self) -> Result<(), EmulateError> {
        check_positive(&[
            ("force.rate_hz", self.rate_hz),
            ("force.counts_per_newton", self.counts_per_newton),
            ("force.counts_per_newton_metre", self.counts_per_newton_metre),
            ("force.monitor_n", self.monitor_n.unwrap_or(1.0)),
        ])?;
        check_positive(&self.range.map(|most| ("force.range", most)))?;
        check_not_negative(&[
            ("force.noise_n", self.noise_n),
            ("force.noise_n_mm", self.noise_n_mm),
        ])?;
        if self.zero.iter().any(|zero| !zero.is_finite()) {
            return Err(EmulateError::setting(
                "force.zero",
                "has a number that is not finite",
            ));
        }
        if self.rate_hz > 7000.0 {
            let problem = format!("is {}, expected at most 7000", self.rate_hz);
            return Err(EmulateError::setting("force.rate_hz", problem));
        }
        if !(1..=40).contains(&self.buffered_records) {
            let problem = format!("is {}, expected 1 to 40", self.buffered_records);
            return Err(EmulateError::setting("force.buffered_records", problem));
        }
        Ok(())
    }
}
