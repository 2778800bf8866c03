//! What a bench streams.

use glam::{DQuat, DVec3};
use phystac::TaxelState;

use crate::{Event, Stream};

/// Something that happened on the bench, and when.
#[derive(Clone, Debug, PartialEq)]
pub struct Message {
    /// When, on the bench's clock, ns since [`Description::start_unix_ns`](crate::Description::start_unix_ns). For a tactile
    /// frame: when its taxels were triggered.
    pub bench_ns: u64,
    /// What.
    pub body: Body,
}

/// What happened.
#[derive(Clone, Debug, PartialEq)]
pub enum Body {
    /// All taxels were read.
    Tactile(TactileFrame),
    /// The force/torque sensor was read.
    Wrench(WrenchReading),
    /// The robot said where its tool is.
    Pose(PoseReading),
    /// Something happened once.
    Event(Event),
}

impl Message {
    /// A message at a time of the bench's clock, s since its start; to the nearest ns.
    #[must_use]
    pub fn at_s(bench_s: f64, body: Body) -> Self {
        Self {
            bench_ns: (bench_s * 1e9).round() as u64, // negative and NaN give 0, too large gives the largest
            body,
        }
    }

    /// Where it belongs.
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

/// What one taxel gave.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TaxelReading {
    /// Whether its pressure can be used, or why not.
    pub state: TaxelState,
    /// When it was read, on the sensor's own clock, µs.
    pub read_us: u64,
    /// What it counted, if it gave anything. `i32::MIN` is no count.
    pub counts: Option<i32>,
    /// Pressure, Pa, if it gave one.
    pub pressure_pa: Option<f64>,
    /// Temperature, °C, if it gave one.
    pub temperature_c: Option<f64>,
}

/// One reading of the force/torque sensor, as the sensor gives it: no tare is taken off.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct WrenchReading {
    /// When it was measured, on the source's own clock, s, if it has one.
    pub source_s: Option<f64>,
    /// The source's number of the reading, if it has one.
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

/// Where the robot's tool is.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PoseReading {
    /// When it was measured, on the robot's own clock, s, if it has one.
    pub source_s: Option<f64>,
    /// The tool's origin in the robot's base frame, mm.
    pub position_mm: DVec3,
    /// From the tool's to the base's frame, a unit quaternion.
    pub base_from_tool: DQuat,
}
