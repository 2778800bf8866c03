//! All figures of the paper's experiments.

use serde::{Deserialize, Serialize};
use twintac_characterize::{Characterization, KnownStep};
use twintac_recording::Provenance;

use super::{Effort, ShapeMap, ShapesResult};
use crate::Metrics;

/// All figures of the paper's experiments: `metrics.json`.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct PaperMetrics {
    /// Where the sensor's readings come from: `emulated`. The twin's are `simulated`.
    pub provenance: Provenance,
    /// How much was made.
    pub effort: Effort,
    /// Seed of all that chance decides.
    pub seed: u64,
    /// The twin, and what it is compared with.
    pub twin: Metrics,
    /// What the sensor does under a ball.
    pub sensor: SensorFigures,
    /// Five shapes, sensor beside twin.
    pub maps: Vec<ShapeMap>,
    /// Shapes told by touch.
    pub shapes: Vec<ShapesResult>,
}

/// The figures of the paper's characterization; `None` where the presses do not give one.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct SensorFigures {
    /// Mean sensitivity of the taxels under the 25 mm ball, kPa/N.
    pub sensitivity_kpa_per_n: Option<f64>,
    /// End of the linear range of all taxels, N.
    pub linear_to_n: Option<f64>,
    /// Largest force in the data, N.
    pub largest_force_n: Option<f64>,
    /// Smallest known weight that a taxel detects, N.
    pub smallest_step_n: Option<f64>,
}

impl SensorFigures {
    pub(super) fn of(found: &Characterization) -> Self {
        let overall = found.overall.found();
        let steps = found.steps.found();
        let smallest = |steps: &Vec<KnownStep>| {
            let detected = steps.iter().filter(|step| step.is_detected);
            detected.map(|step| step.force_n).reduce(f64::min)
        };
        Self {
            sensitivity_kpa_per_n: overall.map(|overall| overall.mean_kpa_per_n),
            linear_to_n: overall.map(|overall| overall.linear_to_n),
            largest_force_n: found.range.found().map(|range| range.force_n),
            smallest_step_n: steps.and_then(smallest),
        }
    }
}
