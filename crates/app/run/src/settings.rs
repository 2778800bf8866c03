//! Settings of every stage of a run.

use std::path::{Path, PathBuf};

use crate::RunError;
use digitac::{BenchSettings, PairSettings, PlaceSettings, SplitSettings, TrainSettings, Variant};
use serde::{Deserialize, Serialize};
use twintac_config::Document;
use twintac_recording::{Control, Recording};
use twintac_sensor::Sensor;
use twintac_shape::Shape;
use twintac_simulate::SimulateSettings;

/// From this many places on, presses are told apart for the split by squares of the gel, not by place: neighbours on a dense grid
/// know too much of each other.
const DENSE_FROM: usize = 150;

/// Side of those squares, mm.
const DENSE_BLOCK_MM: f64 = 3.0;

/// Settings of every stage of a run; each has a default. A TOML file with those that differ has a table for each field.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct RunSettings {
    /// How finely the gel is simulated.
    pub simulate: SimulateSettings,
    /// A fast gel's file, made by `twintac fast train`: tables are then its answers, and nothing is solved.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub fast_gel: Option<PathBuf>,
    /// How deep places are simulated.
    pub places: PlaceSettings,
    /// What is fitted about the bench.
    pub bench: BenchSettings,
    /// Which presses are held out.
    pub split: SplitSettings,
    /// How clocks are aligned.
    pub pair: PairSettings,
    /// How twins are trained.
    pub train: TrainSettings,
}

impl RunSettings {
    /// The default settings but for those in the file, if there is one.
    ///
    /// # Errors
    /// A file that cannot be read, a field that there is not, a value that makes no sense.
    pub fn read(path: Option<&Path>) -> Result<Self, RunError> {
        Self::default().but(path)
    }

    /// For presses that are looked at one by one: the gel is simulated more finely than for the many tables of a run.
    #[must_use]
    pub fn fine() -> Self {
        Self {
            simulate: SimulateSettings::fine(),
            ..Self::default()
        }
    }

    /// These settings but for those in the file, if there is one.
    ///
    /// # Errors
    /// Those of [`read`](Self::read).
    pub fn but(self, path: Option<&Path>) -> Result<Self, RunError> {
        let Some(path) = path else {
            return Ok(self);
        };
        checked(twintac_config::read_over(path, &self)?)
    }

    /// These settings but for those of a TOML text, which `file` names in errors.
    ///
    /// # Errors
    /// A field that there is not, a value that makes no sense.
    pub fn but_parsed(self, file: &str, text: &str) -> Result<Self, RunError> {
        checked(twintac_config::parse_over(file, text, &self)?)
    }

    /// The settings with all that depends on the seed, the sensor and the presses filled in.
    pub(crate) fn resolve(
        &self,
        sensor: &Sensor,
        recording: &Recording,
        n_places: usize,
        seed: u64,
        is_fast: bool,
    ) -> Self {
        let mut resolved = self.clone();
        resolved.split.seed = seed;
        resolved.train.seed = seed;
        resolved.bench.left_out = crate::doubtful::left_out(sensor);
        resolved.bench.ports_mm = ports_mm(sensor);
        if !has_unknown_tip(sensor, recording) {
            resolved.bench.tip_radii_mm.clear();
        }
        if is_fast {
            // It has no stress features.
            resolved
                .train
                .variants
                .retain(|variant| *variant != Variant::Paper);
        }
        if n_places >= DENSE_FROM {
            resolved.split.block_mm = DENSE_BLOCK_MM;
        }
        resolved
    }
}

/// The settings, if their simulation can be.
fn checked(document: Document<RunSettings>) -> Result<RunSettings, RunError> {
    let simulate = &document.value.simulate;
    for (field, value) in [
        ("edges_per_height", simulate.edges_per_height),
        ("edges_per_contact_radius", simulate.edges_per_contact_radius),
        ("contact_edge_mm", simulate.contact_edge_mm.unwrap_or(1.0)),
        ("edges_per_rounding", simulate.edges_per_rounding),
        ("depth_step_mm", simulate.depth_step_mm),
    ] {
        if value <= 0.0 || !value.is_finite() {
            let field = format!("simulate.{field}");
            return Err(document
                .error(&field, format!("is {value}"), "give a number above zero")
                .into());
        }
    }
    Ok(document.value)
}

/// Places of the ports in the gel's plane, mm.
pub(crate) fn ports_mm(sensor: &Sensor) -> Vec<[f64; 2]> {
    let places = sensor.taxels.iter().map(|taxel| taxel.position_mm.truncate());
    places.map(|place| place.to_array()).collect()
}

/// Whether all presses were made with one ball whose radius the sensor's description only infers.
fn has_unknown_tip(sensor: &Sensor, recording: &Recording) -> bool {
    let Some(first) = recording.presses.first() else {
        return false;
    };
    let one = recording
        .presses
        .iter()
        .all(|press| press.indenter == first.indenter);
    let is_inferred = |index: usize| sensor.is_inferred(&format!("indenters[{index}].shape.radius_mm"));
    one && sensor.indenters.iter().enumerate().any(|(index, indenter)| {
        indenter.name == first.indenter
            && matches!(indenter.shape, Shape::Sphere { .. })
            && is_inferred(index)
    })
}

/// Whether the presses are static: one frame each, under a prescribed force.
pub(crate) fn is_static(recording: &Recording) -> bool {
    recording
        .presses
        .iter()
        .all(|press| press.control == Control::Force && press.time_s.len() == 1)
}
