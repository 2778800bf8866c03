//! The interface to the physics at the robot's tool.

use twintac_rig::{TcpPose, Wrench};

/// Most barometers of a board.
pub const MOST_TAXELS: usize = 64;

/// Pressures, temperature and wrench at the sensors at one moment.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sensed {
    /// Absolute pressure at each barometer, kPa, in the order of the board's parts. Entries beyond
    /// the last part are not used.
    pub taxel_pressures_kpa: [f64; MOST_TAXELS],
    /// Temperature of the barometers, °C.
    pub temperature_c: f64,
    /// Force and torque on the force sensor, in its own frame.
    pub wrench: Wrench,
}

/// What happens between the robot's tool and the sensor.
pub trait Physics: Send {
    /// Pressures, temperature and wrench with the tool at a pose in the robot's base frame, at a
    /// time of the emulator's clock, s.
    ///
    /// It is called at equal time steps ([`Workcell::STEP_S`](crate::Workcell::STEP_S)), from zero
    /// on and once for each: it may depend on earlier steps. In real time it must keep up with the
    /// steps, because all devices wait meanwhile.
    fn at(&mut self, tool: &TcpPose, time_s: f64) -> Sensed;
}

impl Sensed {
    /// Without contact: the same pressure everywhere, kPa, at a temperature, °C.
    #[must_use]
    pub fn untouched(pressure_kpa: f64, temperature_c: f64) -> Self {
        Self {
            taxel_pressures_kpa: [pressure_kpa; MOST_TAXELS],
            temperature_c,
            wrench: Wrench::ZERO,
        }
    }

    /// Interpolates between this and another by a fraction from 0 to 1.
    pub(crate) fn mix(&self, other: &Self, fraction: f64) -> Self {
        let between = |one: f64, two: f64| one + fraction * (two - one);
        Self {
            taxel_pressures_kpa: std::array::from_fn(|taxel| {
                between(self.taxel_pressures_kpa[taxel], other.taxel_pressures_kpa[taxel])
            }),
            temperature_c: between(self.temperature_c, other.temperature_c),
            wrench: Wrench {
                force_n: self.wrench.force_n.lerp(other.wrench.force_n, fraction),
                torque_n_mm: self.wrench.torque_n_mm.lerp(other.wrench.torque_n_mm, fraction),
            },
        }
    }
}
