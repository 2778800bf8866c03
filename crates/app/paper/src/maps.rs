//! Pressure maps of five shapes, sensor beside twin (the paper's figure of five indenters).

use std::path::Path;

use digitac::{Model, simulated_recording};
use serde::{Deserialize, Serialize};
use twintac_model::gel_of;
use twintac_protocol::PressPlan;
use twintac_recording::{Press, Recording};
use twintac_run::built_in::MAPS_PROTOCOL;
use twintac_run::{COMPLETE, Run, read_recording};
use twintac_store::{Finished, Stage, read_json, write_json};
use twintac_tables::DepthTableStore;
use twintac_work::{Planned, Progress, Work, WorkError};

use crate::experiments::{PAPER_COMMAND, Paper};
use crate::level::Level;

/// Readings of a shape at its deepest, of sensor and twin.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct ShapeMap {
    /// The shape.
    pub indenter: String,
    /// Readings at full depth, kPa; `[n_taxels]`.
    pub sensor_kpa: Vec<f64>,
    /// Readings of the twin at full depth, kPa; `[n_taxels]`.
    pub twin_kpa: Vec<f64>,
    /// Mean absolute difference of the taxels, % of the sensor's largest reading.
    pub difference_percent: f64,
}

/// The inputs of the maps.
#[derive(Serialize)]
struct Mapping<'a> {
    felt: &'a [PressPlan],
    rate_hz: f64,
    training: Finished,
    recordings: Finished,
}

impl Stage for Mapping<'_> {
    const NAME: &'static str = "maps";
    const MADE_BY: &'static str = PAPER_COMMAND;
    type Follower = dyn Progress;
    type Error = WorkError;

    fn make(&self, folder: &Path, progress: &dyn Progress) -> Result<(), WorkError> {
        let _work = Work::start(progress, "simulating five shapes", 0);
        let model_folder = self.training.file(COMPLETE);
        let model = Model::load(&model_folder)?;
        let store = DepthTableStore::of(gel_of(&model, &model_folder)?, progress)?
            .kept_in(&folder.join("depth_tables"), Self::NAME);
        let bench = &model.record.bench;
        let twin = simulated_recording(&model.twin, bench, &store, self.felt, self.rate_hz)?;
        let maps = compared(&read_recording(&self.recordings)?, &twin);
        Ok(write_json(&folder.join("maps.json"), &maps)?)
    }
}

impl Paper {
    /// Presses five shapes at the gel's middle, on the bench and in the twin.
    pub(super) fn maps(&self, data: &Run, level: &Level) -> Result<Vec<ShapeMap>, WorkError> {
        let sensor = &self.sensor.sensor;
        let planned = Planned::parse(MAPS_PROTOCOL.name, MAPS_PROTOCOL.text, sensor, self.seed)?;
        let run = self.run("five-shapes", "five presses on the emulated bench")?;
        run.emulate(&self.effort.emulator()?, &planned)?;
        let felt: Vec<PressPlan> = planned.presses.iter().map(|plan| level.plan(plan)).collect();
        let finished = self.run_stage(&Mapping {
            felt: &felt,
            rate_hz: sensor.readout.rate_hz,
            training: data.training()?,
            recordings: run.recordings()?,
        })?;
        Ok(read_json(&finished.file("maps.json"))?)
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

/// Mean readings over the second half of the frames at full depth. These frames differ by
/// relaxation alone.
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
