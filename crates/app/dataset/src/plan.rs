//! What a data set is asked for with.

use std::path::PathBuf;

use twintac_protocol::{Area, Indenters, Part, Places, Protocol, Range};
use twintac_sensor::Sensor;
use twintac_work::WorkError;

/// Presses go so deep, as parts of the gel's height, if the description's limit lets them.
const DEPTHS: [f64; 2] = [0.05, 0.4];

/// Slowest and fastest, mm/s.
const SPEEDS_MM_PER_S: [f64; 2] = [1.0, 5.0];

/// Shortest and longest hold, s.
const HOLDS_S: [f64; 2] = [0.0, 1.0];

/// How high above the gel presses begin and end, mm.
const CLEARANCE_MM: f64 = 0.5;

/// Presses, unless it is said how many.
const N_PRESSES: usize = 1000;

/// A gel without finite elements.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum FastSource {
    /// PhysTac's, which is built in.
    BuiltIn,
    /// A file that `twintac fast train` made.
    File(PathBuf),
}

/// What a data set is made from.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct DatasetPlan {
    /// The sensor's description; without one that of the twin, or PhysTac's.
    pub sensor: Option<PathBuf>,
    /// What is pressed; without one, random presses all over the sensor's ports.
    pub protocol: Option<PathBuf>,
    /// Which indenters press at random; none are all.
    pub indenters: Vec<String>,
    /// So many presses: of a protocol the first in turn, at random 1000 unless it is said.
    pub n_presses: Option<usize>,
    /// Seed of all chance.
    pub seed: u64,
    /// A gel without finite elements; without one the gel is solved.
    pub fast: Option<FastSource>,
    /// The folder of a trained twin that reads; without one, readings are the pressures at the ports.
    pub twin: Option<PathBuf>,
    /// How imperfect sensors are: each press has one of its own.
    pub imperfection: Option<PathBuf>,
    /// Settings that differ from the usual ones, in a table `[simulate]`.
    pub settings: Option<PathBuf>,
}

impl DatasetPlan {
    /// Presses at random on a sensor: no farther from its ports than the gel is high, upright, with every indenter as often.
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
                spin_rad: Range::Between([0.0, std::f64::consts::TAU]),
                tilt_rad: Range::Fixed(0.0),
                clearance_mm: CLEARANCE_MM,
                repeats: 1,
            }],
            loads: Vec::new(),
        })
    }
}

/// Most presses with one indenter.
const MOST_OF_EACH: u32 = 10_000_000;
