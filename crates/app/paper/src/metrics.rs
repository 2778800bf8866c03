//! All figures of the paper's experiments.

use serde::{Deserialize, Serialize};
use twintac_recording::Provenance;
use twintac_run::Metrics;

use crate::effort::Effort;
use crate::maps::ShapeMap;
use crate::material::GelMaterial;
use crate::shapes::ShapesResult;
use crate::under_a_ball::SensorFigures;

/// All figures of the paper's experiments: `metrics.json`.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct PaperMetrics {
    /// Where the sensor's readings come from: `emulated`. The twin's are `simulated`.
    pub provenance: Provenance,
    /// How much was made.
    pub effort: Effort,
    /// Seed of all that chance decides.
    pub seed: u64,
    /// How the sensor was found to lie: turned about the bench's x and y axes, radians.
    pub tilt_rad: [f64; 2],
    /// What the gel was found to be made of.
    pub material: GelMaterial,
    /// The twin, and what it is compared with.
    pub twin: Metrics,
    /// What the sensor does under a ball.
    pub sensor: SensorFigures,
    /// Five shapes, sensor beside twin.
    pub maps: Vec<ShapeMap>,
    /// Shapes told by touch.
    pub shapes: Vec<ShapesResult>,
}
