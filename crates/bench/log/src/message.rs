//! Messages of a test setup.

use glam::{DQuat, DVec3};
use phystac::TaxelState;

use crate::{Event, Stream};

/// Something that happened on the test setup, with its time.
#[derive(Clone, Debug, PartialEq)]
pub struct Message {
    /// Time on the bench clock, ns since
    /// [`Description::start_unix_ns`](crate::Description::start_unix_ns). For a tactile frame this
    /// is when its taxels were triggered.
    pub bench_ns: u64,
    /// The content.
    pub body: Body,
}

/// The content of a message.
#[derive(Clone, Debug, PartialEq)]
pub enum Body {
    /// All taxels were read.
    Tactile(TactileFrame),
    /// The force/torque sensor was read.
    Wrench(WrenchReading),
    /// The robot reported the pose of its tool.
    Pose(PoseReading),
    /// Something happened once.
    Event(Event),
}

impl Message {
    /// A message at a time of the bench clock, s since its start, rounded to ns.
    #[must_use]
    pub fn at_s(bench_s: f64, body: Body) -> Self {
        Self {
            bench_ns: (bench_s * 1e9).round() as u64, // negative and NaN give 0, too large values give the largest number
            body,
        }
    }

    /// The stream of the message.
    #[must_use]
    pub fn stream(&self) -> Stream {
        match self.body {
            Body::Tactile(_) => Stream::Tactile,
            Body::Wrench(_) => Stream::Wrench,
            Body::Pose(_) => Stream::Pose,
            Body::Event(_) => Stream::Event,
        }
    }
}

/// One reading of all taxels.
#[derive(Clone, Debug, PartialEq)]
pub struct TactileFrame {
    /// When the taxels were triggered, on the sensor's own clock, µs.
    pub triggered_us: u64,
    /// The taxels, in the order of [`Description::taxels`](crate::Description::taxels).
    pub taxels: Vec<TaxelReading>,
}

/// The reading of one taxel.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TaxelReading {
    /// Whether its pressure can be used, and if not, why.
    pub state: TaxelState,
    /// When it was read, on the sensor's own clock, µs.
    pub read_us: u64,
    /// Its counts, if it gave a reading. `i32::MIN` means no count.
    pub counts: Option<i32>,
    /// Pressure, Pa, if it gave one.
    pub pressure_pa: Option<f64>,
    /// Temperature, °C, if it gave one.
    pub temperature_c: Option<f64>,
}

/// One reading of the force/torque sensor, as the sensor gives it, without subtracting a tare.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct WrenchReading {
    /// When it was measured, on the source's own clock, s, if it has one.
    pub source_s: Option<f64>,
    /// The number that the source gave to the reading, if it has one.
    pub sequence: Option<u32>,
    /// The source's status bits; 0 is healthy.
    pub status: u32,
    /// Readings lost between the one before and this one.
    pub lost_before: u32,
    /// Force, N, in the sensor's frame.
    pub force_n: DVec3,
    /// Torque about the sensor's origin, N mm, in the sensor's frame.
    pub torque_n_mm: DVec3,
}

/// Pose of the robot's tool.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PoseReading {
    /// When it was measured, on the robot's own clock, s, if it has one.
    pub source_s: Option<f64>,
    /// The tool's origin in the robot's base frame, mm.
    pub position_mm: DVec3,
    /// Rotation from the tool's frame to the base frame, a unit quaternion.
    pub base_from_tool: DQuat,
}
