//! Stages `mesh` and `simulation`: the gel, the bench's unknowns, and a table over depth for each place.

use digitac::{BenchEstimate, Places, Split, fit_bench, refine_bench};
use twintac_depth_table::{DepthTable, DepthTableSource};
use twintac_recording::Recording;

use crate::depth_tables::DepthTableStore;
use crate::fast::FAST_GEL;
use crate::files::{read_json, write_json};
use crate::mesh::{Fineness, MeshedGel};
use crate::progress::{Silent, Work};
use crate::settings::ResolvedSettings;
use crate::{Run, RunError};

/// What the simulation stage left.
pub(crate) struct Simulation {
    /// Which presses teach, decide and judge.
    pub(crate) split: Split,
    /// What was fitted about the bench.
    pub(crate) bench: BenchEstimate,
    /// The distinct places.
    pub(crate) places: Places,
    /// A table over depth for each place.
    pub(crate) tables: Vec<DepthTable>,
}

impl Run {
    /// Meshes the gel as it stands, for people to look at; presses refine it where they touch.
    ///
    /// # Errors
    /// A gel that cannot be meshed; a folder that cannot be written.
    pub fn mesh(&self) -> Result<(), RunError> {
        let settings = &self.record.settings.simulate;
        let inputs = self
            .inputs()
            .settings("simulate", settings)?
            .file(&self.folder.join("sensor.toml"))?;
        self.run_stage("mesh", inputs, |folder| {
            let gel = self.gel();
            let edge_mm = gel.height_mm() / settings.edges_per_height;
            MeshedGel::of(gel.sensor(), Fineness::EdgeMm(edge_mm))?.write(folder)
        })
    }

    /// Fits what is unknown about the bench to training presses, and simulates the gel at every place that was pressed.
    ///
    /// # Errors
    /// There are no recordings yet; a place that cannot be pressed.
    pub fn simulate(&self) -> Result<(), RunError> {
        let mut inputs = self
            .inputs()
            .settings("settings", &self.record.settings)?
            .settings("seed", &self.record.seed)?
            .file(&self.folder.join("sensor.toml"))?
            .stage(&self.stage("recordings"))?;
        let fast = self.fast()?;
        if fast.is_some() {
            inputs = inputs.file(&self.folder.join(FAST_GEL))?;
        }
        self.run_stage("simulation", inputs, |folder| {
            let recording = self.recording()?;
            let settings = self.resolved(&recording)?;
            let gel = self.gel();
            let _work = Work::start(self.progress(), "simulating", 0);
            let store = DepthTableStore::new(&gel, folder.join("depth_tables"), self.progress())
                .with_fast(fast.as_ref());
            let places = Places::of(&recording, &store, &settings.places)?;
            let split = Split::new(&recording, &settings.split, settings.seed)?;
            let teachers = [&split.train[..], &split.validation].concat();
            let (how, taxels) = (&settings.bench, &settings.taxels);
            let bench = fit_bench(&recording, &places, &teachers, &store, how, taxels)?;
            let places = places.at_bench(&bench);
            let tables = store.depth_tables(&places.requests)?;
            let bench = refine_bench(&recording, &places, &tables, &teachers, &bench, how, taxels)?;
            write_json(&folder.join("split.json"), &split)?;
            write_json(&folder.join("bench.json"), &bench)?;
            write_json(&folder.join("places.json"), &tables)?;
            Ok(())
        })
    }

    /// What the simulation stage left.
    pub(crate) fn simulation(&self, recording: &Recording) -> Result<Simulation, RunError> {
        let folder = self.stage("simulation");
        let bench: BenchEstimate = read_json(&folder.join("bench.json"))?;
        let gel = self.gel();
        let store = DepthTableStore::new(&gel, folder.join("depth_tables"), &Silent);
        let settings = self.resolved(recording)?;
        let places = Places::of(recording, &store, &settings.places)?.at_bench(&bench);
        Ok(Simulation {
            split: read_json(&folder.join("split.json"))?,
            bench,
            places,
            tables: read_json(&folder.join("places.json"))?,
        })
    }

    /// The settings for the run's sensor, presses and seed: what its stages compute from.
    pub(crate) fn resolved(&self, recording: &Recording) -> Result<ResolvedSettings, RunError> {
        let settings = &self.record.settings;
        Ok(settings.resolve(&self.sensor.sensor, recording, self.record.seed)?)
    }
}
