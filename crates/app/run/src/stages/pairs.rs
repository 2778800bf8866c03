//! Stage `pairs`: measured and simulated frames on one clock.

use digitac::{PairedPress, pair};

use crate::error::At;
use crate::files::{read_json, write_json};
use crate::{Run, RunError};

impl Run {
    /// Aligns every press with its simulation, and pairs their frames.
    ///
    /// # Errors
    /// The recordings or their simulations are not there yet.
    pub fn pair(&self) -> Result<(), RunError> {
        let inputs = self
            .inputs()
            .settings("pair", &self.record.settings.pair)?
            .stage(&self.stage("recordings"))?
            .stage(&self.stage("simulation"))?;
        self.run_stage("pairs", inputs, |folder| {
            let recording = self.recording()?;
            let simulation = self.simulation(&recording)?;
            let pairs = pair(
                &recording,
                &simulation.places,
                &simulation.tables,
                &simulation.bench,
                &self.resolved(&recording)?.pair,
            )?;
            write_json(&folder.join("paired.json"), &pairs)?;
            twintac_report::warp_plot(&pairs).write(&folder.join("warps.svg"))?;
            Ok(())
        })
    }

    /// The paired presses.
    pub(crate) fn pairs(&self) -> Result<Vec<PairedPress>, RunError> {
        read_json(&self.stage("pairs").join("paired.json")).at(|| "run `twintac align` first".to_owned())
    }
}
