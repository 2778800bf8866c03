//! Stage `pairs`: measured and simulated frames on one clock.

use std::path::Path;

use digitac::{PairSettings, PairedPress, pair};
use serde::Serialize;
use twintac_store::{Finished, Stage, read_json, write_json};
use twintac_work::{Progress, WorkError};

use super::recordings::read_recording;
use super::simulation::Simulation;
use crate::Run;

#[derive(Serialize)]
struct Pairing<'a> {
    settings: &'a PairSettings,
    recordings: Finished,
    simulation: Finished,
}

impl Stage for Pairing<'_> {
    const NAME: &'static str = "pairs";
    const MADE_BY: &'static str = "twintac align";
    type Follower = dyn Progress;
    type Error = WorkError;

    fn make(&self, folder: &Path, _: &dyn Progress) -> Result<(), WorkError> {
        let recording = read_recording(&self.recordings)?;
        let simulation = Simulation::read(&self.simulation)?;
        let Simulation {
            places,
            tables,
            bench,
            ..
        } = &simulation;
        let pairs = pair(&recording, places, tables, bench, self.settings)?;
        write_json(&folder.join("paired.json"), &pairs)?;
        twintac_report::warp_plot(&pairs).write(&folder.join("warps.svg"))?;
        Ok(())
    }
}

/// The paired presses of the stage.
///
/// # Errors
/// A file that cannot be read.
pub fn read_pairs(stage: &Finished) -> Result<Vec<PairedPress>, WorkError> {
    Ok(read_json(&stage.file("paired.json"))?)
}

impl Run {
    /// Aligns every press with its simulation, and pairs their frames.
    ///
    /// # Errors
    /// The recordings or their simulations do not exist yet.
    pub fn pair(&self) -> Result<(), WorkError> {
        self.run_stage(&self.pairing()?).map(drop)
    }

    fn pairing(&self) -> Result<Pairing<'_>, WorkError> {
        Ok(Pairing {
            settings: &self.record().settings.pair,
            recordings: self.recordings()?,
            simulation: self.simulation()?,
        })
    }

    /// The stage of paired presses, if it matches its present inputs.
    ///
    /// # Errors
    /// It does not exist, or does not match its present inputs.
    pub fn pairs(&self) -> Result<Finished, WorkError> {
        Ok(self.stages().current(&self.pairing()?)?)
    }
}
