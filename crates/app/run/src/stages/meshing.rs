//! Stage `mesh`: the gel at rest, for people to look at.

use std::path::Path;

use serde::Serialize;
use twintac_gel::mesh::{Fineness, MeshedGel};
use twintac_sensor::SensorFile;
use twintac_store::{Keyed, Stage};
use twintac_work::{Progress, WorkError};

use crate::Run;

#[derive(Serialize)]
struct Meshing<'a> {
    sensor: &'a Keyed<SensorFile>,
    edges_per_height: f64,
}

impl Stage for Meshing<'_> {
    const NAME: &'static str = "mesh";
    const MADE_BY: &'static str = "twintac simulate --run";
    type Follower = dyn Progress;
    type Error = WorkError;

    fn make(&self, folder: &Path, _: &dyn Progress) -> Result<(), WorkError> {
        let sensor = &self.sensor.sensor;
        let height_mm = sensor.gel.solid.bounds_mm(&sensor.surfaces).1.z;
        MeshedGel::of(sensor, Fineness::EdgeMm(height_mm / self.edges_per_height))?.write(folder)
    }
}

impl Run {
    /// Meshes the gel at rest. Presses have meshes of their own, which are fine where they touch.
    ///
    /// # Errors
    /// A gel that cannot be meshed; a folder that cannot be written.
    pub fn mesh(&self) -> Result<(), WorkError> {
        self.run_stage(&Meshing {
            sensor: self.keyed_sensor(),
            edges_per_height: self.record().settings.simulate.edges_per_height,
        })
        .map(drop)
    }
}
