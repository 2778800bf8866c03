//! The request for a data set.

use std::path::PathBuf;

use twintac_protocol::{Area, Indenters, Part, Places, Protocol, Range};
use twintac_sensor::Sensor;
use twintac_work::WorkError;

/// Smallest and largest depth of random presses, as fractions of the gel's height, limited by the
/// description.
const DEPTHS: [f64; 2] = [0.05, 0.4];

/// Lowest and highest speed of random presses, mm/s.
const SPEEDS_MM_PER_S: [f64; 2] = [1.0, 5.0];

/// Shortest and longest hold of random presses, s.
const HOLDS_S: [f64; 2] = [0.0, 1.0];

/// Height above the gel at which random presses begin and end, mm.
const CLEARANCE_MM: f64 = 0.5;

/// Number of random presses if the plan names none.
const N_PRESSES: usize = 1000;

/// Where the surrogate (the gel without finite elements) comes from.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum FastSource {
    /// The built-in surrogate of PhysTac.
    BuiltIn,
    /// A file that `twintac fast train` made.
    File(PathBuf),
}

/// The inputs of a data set.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct DatasetPlan {
    /// The sensor's description. Default: that of the twin, or PhysTac's.
    pub sensor: Option<PathBuf>,
    /// The press protocol. Default: random presses all over the sensor's ports.
    pub protocol: Option<PathBuf>,
    /// Names of the indenters of random presses. If empty, all.
    pub indenters: Vec<String>,
    /// Number of presses: the first of a protocol, taken from its indenters in turn, or random ones
    /// (default 1000).
    pub n_presses: Option<usize>,
    /// Seed of all random choices.
    pub seed: u64,
    /// The surrogate. Default: the gel is solved by finite elements.
    pub fast: Option<FastSource>,
    /// The folder of a trained twin that computes the readings. Default: readings are the pressures
    /// at the ports.
    pub twin: Option<PathBuf>,
    /// File of the sensor variation: each press has an imperfect sensor of its own.
    pub variation: Option<PathBuf>,
    /// File of settings of the simulation, in a table `[simulate]`.
    pub settings: Option<PathBuf>,
}

impl DatasetPlan {
    /// A protocol of random presses: upright, no farther from the sensor's ports than the gel is
    /// high, equally many with each indenter.
    pub(super) fn at_random(&self, sensor: &Sensor) -> Result<Protocol, WorkError> {
        let names: Vec<String> = if self.indenters.is_empty() {
            let all = sensor.indenters.iter();
            all.map(|indenter| indenter.name.clone()).collect()
        } else {
            self.indenters.clone()
        };
        if names.is_empty() {
            return Err(WorkError::Input(format!(
                "the sensor `{}` describes no indenters to press with: add [[indenters]] to its description",
                sensor.name
            )));
        }
        let n_presses = self.n_presses.unwrap_or(N_PRESSES);
        let of_each = u32::try_from(n_presses.div_ceil(names.len()));
        let count = of_each.ok().filter(|count| (1..=MOST_OF_EACH).contains(count));
        let Some(count) = count else {
            return Err(WorkError::Input(format!(
                "--presses is {n_presses}: give 1 or more, and at most {} for {} indenters",
                MOST_OF_EACH as usize * names.len(),
                names.len()
            )));
        };
        let (low, high) = sensor.gel.solid.bounds_mm(&sensor.surfaces);
        let height_mm = high.z - low.z;
        let ports_mm = || sensor.taxels.iter().map(|taxel| taxel.position_mm);
        let across = |axis: usize| {
            let (first, last) = ports_mm().fold((f64::INFINITY, f64::NEG_INFINITY), |(first, last), at| {
                (first.min(at[axis]), last.max(at[axis]))
            });
            [
                (first - height_mm).max(low[axis]),
                (last + height_mm).min(high[axis]),
            ]
        };
        let limit_mm = sensor.limits.map_or(f64::INFINITY, |limits| limits.depth_mm);
        Ok(Protocol {
            summary: "Random presses all over the ports".to_owned(),
            parts: vec![Part {
                name: String::new(),
                summary: String::new(),
                indenters: Indenters::Named(names),
                places: Places::Random {
                    area: Area {
                        x_mm: across(0),
                        y_mm: across(1),
                    },
                    count,
                },
                depth_mm: Range::Between(DEPTHS.map(|part| (part * height_mm).min(limit_mm))),
                speed_mm_per_s: Range::Between(SPEEDS_MM_PER_S),
                hold_s: Range::Between(HOLDS_S),
                yaw_rad: Range::Between([0.0, std::f64::consts::TAU]),
                tilt_rad: Range::Fixed(0.0),
                clearance_mm: CLEARANCE_MM,
                repeats: 1,
            }],
            loads: Vec::new(),
        })
    }
}

/// Most random presses with one indenter.
const MOST_OF_EACH: u32 = 10_000_000;
