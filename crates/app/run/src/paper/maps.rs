//! Pressure maps of five shapes, sensor beside twin (the paper's figure of five indenters).

use std::path::Path;

use digitac::{Model, simulated_recording};
use serde::{Deserialize, Serialize};
use twintac_protocol::PressPlan;
use twintac_recording::{Press, Recording};

use super::experiments::Paper;
use super::level::Level;
use crate::built_in::{MAPS_PROTOCOL, reality};
use crate::depth_tables::DepthTableStore;
use crate::files::{read_json, write_json};
use crate::model::gel_of;
use crate::progress::Work;
use crate::{Planned, Run, RunError};

/// A shape at its deepest, as the sensor reads it and as the twin does.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct ShapeMap {
    /// The shape.
    pub indenter: String,
    /// Readings at full depth, kPa; `[n_taxels]`.
    pub sensor_kpa: Vec<f64>,
    /// The same of the twin.
    pub twin_kpa: Vec<f64>,
    /// Mean difference of the taxels over the sensor's largest reading, %.
    pub difference_percent: f64,
}

impl Paper {
    /// Presses five shapes at the gel's middle, on the bench and in the twin.
    pub(super) fn maps(&self, data: &Run, level: &Level) -> Result<Vec<ShapeMap>, RunError> {
        let sensor = &self.sensor.sensor;
        let planned = Planned::parse(MAPS_PROTOCOL.name, MAPS_PROTOCOL.text, sensor, self.seed)?;
        let run = self.run("five-shapes", "five presses on the emulated bench")?;
        run.emulate(&reality(Some(Path::new(self.effort.reality())))?, &planned)?;
        let felt: Vec<PressPlan> = planned.presses.iter().map(|plan| level.plan(plan)).collect();
        let model_folder = data.model_folder();
        let inputs = self
            .inputs()
            .settings("plans", &felt)?
            .file(&model_folder.join("weights.safetensors"))?
            .file(&model_folder.join("twin.json"))?
            .stage(&run.stage("recordings"))?;
        self.run_stage("maps", inputs, |folder| {
            let _work = Work::start(self.progress(), "simulating five shapes", 0);
            let model = Model::load(&model_folder)?;
            let gel = gel_of(&model, &model_folder)?;
            let store = DepthTableStore::new(&gel, folder.join("depth_tables"), self.progress());
            let (bench, rate_hz) = (&model.record.bench, sensor.readout.rate_hz);
            let twin = simulated_recording(&model.twin, bench, &store, &felt, rate_hz)?;
            write_json(&folder.join("maps.json"), &compared(&run.recording()?, &twin))
        })?;
        read_json(&self.folder.join("maps/maps.json"))
    }
}

fn compared(sensor: &Recording, twin: &Recording) -> Vec<ShapeMap> {
    let presses = sensor.presses.iter().zip(&twin.presses);
    let map = |(measured, predicted): (&Press, &Press)| {
        let (sensor_kpa, twin_kpa) = (at_full_depth(measured), at_full_depth(predicted));
        let largest = sensor_kpa.iter().copied().fold(0.0, f64::max);
        let differences = sensor_kpa.iter().zip(&twin_kpa).map(|(s, t)| (s - t).abs());
        ShapeMap {
            indenter: measured.indenter.clone(),
            difference_percent: 100.0 * differences.sum::<f64>() / sensor_kpa.len() as f64 / largest,
            sensor_kpa,
            twin_kpa,
        }
    };
    presses.map(map).collect()
}

/// Mean readings over the second half of the frames at full depth, which differ by relaxation alone.
fn at_full_depth(press: &Press) -> Vec<f64> {
    let heights = press.gel_from_indenter.iter().map(|pose| pose.position_mm.z);
    let lowest_mm = heights.clone().fold(f64::INFINITY, f64::min);
    let deep: Vec<usize> = heights
        .enumerate()
        .filter(|(_, z_mm)| z_mm - lowest_mm < 0.02)
        .map(|(frame, _)| frame)
        .collect();
    let late = &deep[deep.len() / 2..];
    let mean = |taxel: usize| {
        late.iter()
            .map(|&frame| press.taxels_kpa[frame][taxel])
            .sum::<f64>()
            / late.len() as f64
    };
    (0..press.taxels_kpa[0].len()).map(mean).collect()
}
