//! Stages `mesh` and `simulation`: the gel, the bench's unknowns, and a table over depth for each place.

use anyhow::Result;
use digitac::{Bench, Places, Split, fit_bench};
use twintac_depth_table::{DepthTable, DepthTableSource};
use twintac_mesh::MeshSettings;
use twintac_recording::Recording;

use crate::cache::{Inputs, read_json, write_json};
use crate::depth_tables::DepthTableStore;
use crate::progress;
use crate::run::Run;
use crate::settings::is_static;

/// What the simulation stage left.
pub struct Simulation {
    /// Which presses teach, decide and judge.
    pub split: Split,
    /// What was fitted about the bench.
    pub bench: Bench,
    /// The distinct places.
    pub places: Places,
    /// A table over depth for each place.
    pub tables: Vec<DepthTable>,
}

impl Run {
    /// Meshes the gel as it stands, for people to look at; presses refine it where they touch.
    pub fn mesh(&self) -> Result<()> {
        let settings = &self.record.settings.simulate;
        let inputs = Inputs::new()?
            .settings("simulate", settings)?
            .file(&self.folder.join("sensor.toml"))?;
        self.run_stage("mesh", inputs, |folder| {
            let gel = self.gel();
            let edge_mm = gel.height_mm() / settings.edges_per_height;
            let sensor = gel.sensor();
            let mesh = crate::mesh::mesh_of(
                sensor,
                &MeshSettings {
                    edge_mm,
                    ..MeshSettings::default()
                },
            )?;
            crate::mesh::write_mesh(folder, sensor, &mesh).map(|_| ())
        })
    }

    /// Fits the bench to training presses and simulates every place.
    pub fn simulate(&self) -> Result<()> {
        let inputs = Inputs::new()?
            .settings("settings", &self.record.settings)?
            .settings("seed", &self.record.seed)?
            .file(&self.folder.join("sensor.toml"))?
            .stage(&self.stage("recordings"))?;
        self.run_stage("simulation", inputs, |folder| {
            let recording = self.recording()?;
            let gel = self.gel();
            let bar = progress::bar("simulating", 0);
            let store = DepthTableStore::new(&gel, folder.join("depth_tables"), bar.clone());
            let places = Places::of(&recording, &store, &self.record.settings.places)?;
            let settings = self.resolved(&recording, &places);
            let split = Split::new(&recording, &settings.split)?;
            let bench = fit_bench(&recording, &places, &split.train, &store, &settings.bench)?;
            let places = places.at_bench(&bench);
            let tables = store
                .depth_tables(&places.requests)
                .map_err(anyhow::Error::from_boxed)?;
            bar.finish_and_clear();
            write_json(&folder.join("split.json"), &split)?;
            write_json(&folder.join("bench.json"), &bench)?;
            write_json(&folder.join("places.json"), &tables)?;
            Ok(())
        })
    }

    /// What the simulation stage left.
    pub fn simulation(&self, recording: &Recording) -> Result<Simulation> {
        let folder = self.stage("simulation");
        let bench: Bench = read_json(&folder.join("bench.json"))?;
        let gel = self.gel();
        let store = DepthTableStore::new(
            &gel,
            folder.join("depth_tables"),
            indicatif::ProgressBar::hidden(),
        );
        let places = Places::of(recording, &store, &self.record.settings.places)?.at_bench(&bench);
        Ok(Simulation {
            split: read_json(&folder.join("split.json"))?,
            bench,
            places,
            tables: read_json(&folder.join("places.json"))?,
        })
    }

    /// The settings with what depends on sensor and presses filled in.
    pub fn resolved(&self, recording: &Recording, places: &Places) -> crate::settings::RunSettings {
        let n_places = if is_static(recording) {
            places.requests.len()
        } else {
            0
        };
        self.record
            .settings
            .resolve(&self.sensor.sensor, recording, n_places, self.record.seed)
    }
}
