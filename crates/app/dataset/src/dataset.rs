//! A data set, and how its shards are made.

use std::path::Path;

use rayon::prelude::*;
use twintac_protocol::PressPlan;
use twintac_recording::{Press, Provenance, Recording};
use twintac_work::{Progress, Work, WorkError, in_one_sentence, target};

use crate::folder::Folder;
use crate::identity::Inputs;
use crate::press;
use crate::{DatasetPlan, LeftOut, MadeShard, Shard};

/// A data set: its inputs, read, and the number of its presses.
pub struct Dataset {
    inputs: Inputs,
    n_presses: usize,
    seed: u64,
    /// The text of `dataset.toml`.
    identity: String,
}

impl Dataset {
    /// Opens a planned data set: reads the files that the plan names, and makes nothing yet.
    ///
    /// # Errors
    /// A file that cannot be read or is wrong; indenters that the sensor does not have; a twin or a
    /// surrogate of another sensor.
    pub fn open(plan: &DatasetPlan) -> Result<Self, WorkError> {
        let inputs = Inputs::read(plan)?;
        let there_are = inputs.protocol.n_presses(&target(&inputs.sensor.sensor))?;
        let n_presses = plan.n_presses.unwrap_or(there_are).min(there_are);
        Ok(Self {
            identity: inputs.identity(n_presses, plan.seed)?,
            inputs,
            n_presses,
            seed: plan.seed,
        })
    }

    /// The number of presses.
    #[must_use]
    pub fn n_presses(&self) -> usize {
        self.n_presses
    }

    /// The text of `dataset.toml`: all inputs. Data sets with the same text are the same.
    #[must_use]
    pub fn identity(&self) -> &str {
        &self.identity
    }

    /// Makes one shard in a folder, with all threads of the pool, unless it is complete there. The
    /// shard appears whole or not at all, even if other programs work in the folder.
    ///
    /// # Errors
    /// More shards than presses; a folder with shards of another data set or another division; no
    /// press that can be simulated; files that cannot be written.
    pub fn make(&self, shard: Shard, folder: &Path, progress: &dyn Progress) -> Result<MadeShard, WorkError> {
        let stretch = shard.stretch(self.n_presses)?;
        let folder = Folder::open(folder, &self.identity, &self.inputs.sensor.text, shard)?;
        if let Some(made) = folder.complete(shard)? {
            return Ok(made);
        }
        let sensor = &self.inputs.sensor.sensor;
        let plans = self
            .inputs
            .protocol
            .plan_in_turn(&target(sensor), self.seed, stretch)?;
        let work = Work::start(progress, "pressing", plans.len());
        let pressed: Vec<Result<Press, LeftOut>> = plans
            .par_iter()
            .with_max_len(1)
            .map(|plan| {
                work.go_on()?;
                let pressed = self.press(plan);
                work.step("");
                Ok(pressed)
            })
            .collect::<Result<_, WorkError>>()?;
        drop(work);
        let (mut presses, mut left_out) = (Vec::new(), Vec::new());
        for pressed in pressed {
            match pressed {
                Ok(press) => presses.push(press),
                Err(why) => left_out.push(why),
            }
        }
        if let (true, Some(first)) = (presses.is_empty(), left_out.first()) {
            return Err(WorkError::Input(format!(
                "none of the {} presses of shard {shard} can be simulated; the first, {}: {}",
                left_out.len(),
                first.press,
                first.why
            )));
        }
        let recording = Recording {
            sensor: sensor.name.clone(),
            provenance: Provenance::Simulated,
            taxels: sensor.taxels.iter().map(|taxel| taxel.name.clone()).collect(),
            presses,
        };
        folder.put(shard, &recording, left_out)
    }

    /// One press, or why it is left out.
    fn press(&self, plan: &PressPlan) -> Result<Press, LeftOut> {
        press::press(&self.inputs, plan, self.seed).map_err(|error| LeftOut {
            press: plan.name.clone(),
            why: in_one_sentence(&error),
        })
    }
}
