//! Characterization of the sensor under a ball (the paper's section IV-A).

use std::path::Path;

use serde::{Deserialize, Serialize};
use twintac_characterize::{Characterization, KnownStep};
use twintac_recorded::Recorded;
use twintac_run::built_in::CHARACTERIZE_PROTOCOL;
use twintac_run::read_recording;
use twintac_sensor::SensorFile;
use twintac_store::{Finished, Keyed, Stage, read_json, write_json};
use twintac_work::{Planned, Progress, WorkError};

use crate::experiments::{PAPER_COMMAND, Paper};

/// The figures of the paper's characterization; `None` if the presses do not give a figure.
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

impl Paper {
    /// Characterizes the sensor under the paper's ball, with the default emulator configuration,
    /// which is tuned to the paper's sensitivity.
    pub(super) fn characterize(&self) -> Result<SensorFigures, WorkError> {
        let sensor = &self.sensor.sensor;
        let protocol = CHARACTERIZE_PROTOCOL;
        let planned = Planned::parse(protocol.name, protocol.text, sensor, self.seed)?;
        let run = self.run("under-a-ball", "presses and weights on the emulated bench")?;
        run.emulate(&self.effort.simple_emulator()?, &planned)?;
        let finished = self.run_stage(&Characterizing {
            sensor: &Keyed::of_bytes(self.sensor.clone(), self.sensor.text.as_bytes()),
            recordings: run.recordings()?,
        })?;
        Ok(read_json(&finished.file("figures.json"))?)
    }
}

/// The inputs of the characterization.
#[derive(Serialize)]
struct Characterizing<'a> {
    sensor: &'a Keyed<SensorFile>,
    recordings: Finished,
}

impl Stage for Characterizing<'_> {
    const NAME: &'static str = "characterization";
    const MADE_BY: &'static str = PAPER_COMMAND;
    type Follower = dyn Progress;
    type Error = WorkError;

    fn make(&self, folder: &Path, _: &dyn Progress) -> Result<(), WorkError> {
        let sensor = &self.sensor.sensor;
        let recorded = Recorded::from(read_recording(&self.recordings)?);
        let found = recorded.characterize(sensor)?;
        recorded.write(&found, sensor, folder)?;
        Ok(write_json(
            &folder.join("figures.json"),
            &SensorFigures::of(&found),
        )?)
    }
}
