//! Stage `pairs`: measured and simulated frames on one clock.

use anyhow::{Context, Result};
use digitac::{PairedPress, pair};

use crate::cache::{Inputs, read_json, write_json};
use crate::run::Run;

impl Run {
    /// Aligns every press with its simulation, and pairs their frames.
    pub fn pair(&self) -> Result<()> {
        let inputs = Inputs::new()?
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
                &self.record.settings.pair,
            )?;
            write_json(&folder.join("paired.json"), &pairs)?;
            let warps = crate::report::warps(&pairs);
            crate::report::warp_plot(&warps).write(&folder.join("warps.svg"))?;
            Ok(())
        })
    }

    /// The paired presses.
    pub fn pairs(&self) -> Result<Vec<PairedPress>> {
        read_json(&self.stage("pairs").join("paired.json")).context("run `twintac align` first")
    }
}
