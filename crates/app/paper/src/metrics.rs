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
    /// Provenance of the sensor's readings: `emulated`. The twin's are `simulated`.
    pub provenance: Provenance,
    /// The extent of the experiments.
    pub effort: Effort,
    /// Seed of all random choices.
    pub seed: u64,
    /// The tilt that was found: rotation about the bench's x and y axes, radians.
    pub tilt_rad: [f64; 2],
    /// The fitted material of the gel.
    pub material: GelMaterial,
    /// Errors of the twin and of the baselines.
    pub twin: Metrics,
    /// Figures of the sensor under a ball.
    pub sensor: SensorFigures,
    /// Maps of five shapes, sensor beside twin.
    pub maps: Vec<ShapeMap>,
    /// Classification of shapes by touch.
    pub shapes: Vec<ShapesResult>,
}
