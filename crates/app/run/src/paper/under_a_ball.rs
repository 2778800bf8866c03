//! The sensor under a ball (the paper's section IV-A).

use serde::{Deserialize, Serialize};
use twintac_characterize::{Characterization, KnownStep};

use super::experiments::Paper;
use crate::built_in::{CHARACTERIZE_PROTOCOL, reality};
use crate::characterization::Recorded;
use crate::files::{read_json, write_json};
use crate::{Planned, RunError};

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

impl Paper {
    /// The sensor under the paper's ball, on the bench that the paper's sensitivity is tuned on.
    pub(super) fn characterize(&self) -> Result<SensorFigures, RunError> {
        let sensor = &self.sensor.sensor;
        let protocol = CHARACTERIZE_PROTOCOL;
        let planned = Planned::parse(protocol.name, protocol.text, sensor, self.seed)?;
        let run = self.run("under-a-ball", "presses and weights on the emulated bench")?;
        run.emulate(&reality(None)?, &planned)?;
        let recordings = run.stage("recordings");
        let inputs = self.inputs().stage(&recordings)?;
        self.run_stage("characterization", inputs, |folder| {
            let recorded = Recorded::read(&[recordings.join("presses.parquet")], self.progress())?;
            let found = recorded.characterize(sensor)?;
            recorded.write(&found, sensor, folder)?;
            write_json(&folder.join("figures.json"), &SensorFigures::of(&found))
        })?;
        read_json(&self.folder.join("characterization/figures.json"))
    }
}
