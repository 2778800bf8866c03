//! Stage `simulation`: the unknowns of the bench, and a table over depth for each location.

use std::path::Path;

use digitac::{BenchEstimate, Contact, Places, Split, fit_bench, refine_bench};
use serde::Serialize;
use twintac_depth_table::{DepthTable, DepthTableSource};
use twintac_recording::Recording;
use twintac_sensor::SensorFile;
use twintac_store::{Finished, Keyed, Stage, read_json, write_json};
use twintac_tables::{DepthTableStore, FastTables};
use twintac_work::{Progress, Work, WorkError};

use super::recordings::read_recording;
use crate::run::gel_of;
use crate::settings::ResolvedSettings;
use crate::{Run, RunSettings};

/// The common inputs of all stages after the recordings.
#[derive(Clone, Copy, Serialize)]
pub(crate) struct Setup<'a> {
    pub(crate) sensor: &'a Keyed<SensorFile>,
    /// Each of its tables is an input.
    #[serde(flatten)]
    pub(crate) settings: &'a RunSettings,
    pub(crate) seed: u64,
    pub(crate) fast: Option<&'a Keyed<FastTables>>,
}

impl Setup<'_> {
    /// The settings from which stages compute: resolved for the sensor, its presses and the seed.
    pub(crate) fn resolved(&self, recording: &Recording) -> Result<ResolvedSettings, WorkError> {
        let sensor = &self.sensor.sensor;
        let is_fast = self.fast.is_some();
        Ok(self.settings.resolve(sensor, recording, self.seed, is_fast)?)
    }
}

#[derive(Serialize)]
struct Simulating<'a> {
    #[serde(flatten)]
    setup: Setup<'a>,
    recordings: Finished,
}

impl Stage for Simulating<'_> {
    const NAME: &'static str = "simulation";
    const MADE_BY: &'static str = "twintac align";
    type Follower = dyn Progress;
    type Error = WorkError;

    fn make(&self, folder: &Path, progress: &dyn Progress) -> Result<(), WorkError> {
        let setup = &self.setup;
        let recording = read_recording(&self.recordings)?;
        let gel = gel_of(setup.sensor, setup.settings);
        let _work = Work::start(progress, "simulating", 0);
        let store = DepthTableStore::of(gel, progress)?
            .kept_in(&folder.join("depth_tables"), Self::NAME)
            .with_fast(setup.fast.map(|fast| &**fast));
        let settings = setup.resolved(&recording)?;
        let places = Places::of(&recording, &store, &settings.places)?;
        let split = Split::new(&recording, &settings.split, settings.seed)?;
        let training_presses = [&split.train[..], &split.validation].concat();
        let (how, taxels) = (&settings.bench, &settings.taxels);
        let bench = fit_bench(&recording, &places, &training_presses, &store, how, taxels)?;
        let places = places.at_bench(&bench);
        let tables = store.depth_tables(&places.requests)?;
        let bench = refine_bench(
            &recording,
            &places,
            &tables,
            &training_presses,
            &bench,
            how,
            taxels,
        )?;
        write_json(&folder.join("split.json"), &split)?;
        write_json(&folder.join("bench.json"), &bench)?;
        write_json(&folder.join("places.json"), &places)?;
        write_json(&folder.join("tables.json"), &tables)?;
        Ok(())
    }
}

/// The result of the simulation stage.
pub struct Simulation {
    /// Division into training, validation and test presses.
    pub split: Split,
    /// The fitted unknowns of the bench.
    pub bench: BenchEstimate,
    /// The distinct locations.
    pub places: Places,
    /// A table over depth for each location.
    pub tables: Vec<DepthTable>,
}

impl Simulation {
    /// Reads the result of the stage.
    ///
    /// # Errors
    /// A file that cannot be read.
    pub fn read(stage: &Finished) -> Result<Self, WorkError> {
        Ok(Self {
            split: read_json(&stage.file("split.json"))?,
            bench: read_json(&stage.file("bench.json"))?,
            places: read_json(&stage.file("places.json"))?,
            tables: read_json(&stage.file("tables.json"))?,
        })
    }
}

/// The contact of each location: where and with what it is pressed; `[n_places]`.
pub(crate) fn contacts(
    places: &Places,
    sensor: &SensorFile,
    settings: &RunSettings,
) -> Result<Vec<Contact>, WorkError> {
    Ok(Contact::of_places(places, &gel_of(sensor, settings))?)
}

impl Run {
    /// Fits the unknowns of the bench to training and validation presses, and simulates the gel at
    /// every location that was pressed.
    ///
    /// # Errors
    /// There are no recordings yet; a location that cannot be pressed.
    pub fn simulate(&self) -> Result<(), WorkError> {
        self.run_stage(&self.simulating()?).map(drop)
    }

    pub(crate) fn setup(&self) -> Setup<'_> {
        Setup {
            sensor: self.keyed_sensor(),
            settings: self.settings(),
            seed: self.record().seed,
            fast: self.fast(),
        }
    }

    fn simulating(&self) -> Result<Simulating<'_>, WorkError> {
        Ok(Simulating {
            setup: Setup {
                settings: self.simulation_settings(),
                ..self.setup()
            },
            recordings: self.recordings()?,
        })
    }

    /// The simulation stage, if it matches its present inputs.
    ///
    /// # Errors
    /// It does not exist, or does not match its present inputs.
    pub fn simulation(&self) -> Result<Finished, WorkError> {
        Ok(self.stages().current(&self.simulating()?)?)
    }
}
