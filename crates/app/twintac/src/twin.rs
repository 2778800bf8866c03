//! A trained twin.

use std::path::Path;
use std::sync::Arc;

use digitac::{Model, PlaceSettings, Places, features};
use glam::DVec3;
use twintac_depth_table::DepthTableSource;
use twintac_recording::{Control, Provenance, Recording};
use twintac_sensor::SensorFile;
use twintac_shape::Pose;

use crate::{Error, Press, Sensor};

/// A trained twin: what the barometers of one sensor would read while its gel is pressed.
#[derive(Clone, Debug)]
pub struct Twin {
    sensor: Sensor,
    gel: twintac_simulate::Gel,
    model: Model,
}

/// What a twin would read along a press. All vectors have the same length, `n_frames`.
#[derive(Clone, Debug, PartialEq)]
pub struct Prediction {
    /// Time since first touch, s; as many frames a second as the sensor gives.
    pub time_s: Vec<f64>,
    /// Depth below first touch, mm, with the height at which the bench of the recordings touched.
    pub depth_mm: Vec<f64>,
    /// Force of the indenter on the gel, N.
    pub force_n: Vec<f64>,
    /// What the barometers would read above their unloaded baseline, kPa; `[n_frames][n_taxels]`.
    pub readings_kpa: Vec<Vec<f64>>,
}

impl Twin {
    /// Loads a twin from the folder that a run leaves it in: `<run>/model`.
    ///
    /// # Errors
    /// A folder that holds no twin, or a damaged one.
    pub fn load(folder: impl AsRef<Path>) -> Result<Self, Error> {
        let folder = folder.as_ref();
        let model = Model::load(folder)?;
        let file = SensorFile::parse(&folder.join("sensor.toml"), &model.record.sensor)?;
        let settings = serde_json::from_value(model.record.simulation.clone())?;
        Ok(Self {
            gel: twintac_simulate::Gel::new(Arc::clone(&file.sensor), settings),
            sensor: file.into(),
            model,
        })
    }

    /// The sensor whose twin it is.
    #[must_use]
    pub fn sensor(&self) -> &Sensor {
        &self.sensor
    }

    /// Where the recordings come from that it was trained with. What it predicts is simulated.
    #[must_use]
    pub fn trained_on(&self) -> Provenance {
        self.model.record.provenance
    }

    /// What the barometers would read along a press: takes a few seconds. Bench and gel are as they were found at training.
    ///
    /// # Errors
    /// An indenter that the sensor does not have; a place that cannot be pressed.
    pub fn predict(&self, press: &Press) -> Result<Prediction, Error> {
        let recording = self.as_recording(press)?;
        let bench = &self.model.record.bench;
        let places = Places::of(&recording, &self.gel, &PlaceSettings::default())?.at_bench(bench);
        let tables = self
            .gel
            .depth_tables(&places.requests)
            .map_err(digitac::DigitacError::Simulation)?;
        let mut along = features(&recording, &places, &tables, bench)?;
        let along = along.swap_remove(0);
        Ok(Prediction {
            readings_kpa: self.model.twin.predict(&[&along]).swap_remove(0),
            time_s: along.time_s,
            depth_mm: along.depth_mm,
            force_n: along.force_n,
        })
    }

    /// The press as a recording without readings.
    fn as_recording(&self, press: &Press) -> Result<Recording, Error> {
        let plan = &press.plan;
        let described = &self.sensor.file().sensor;
        let trajectory = plan.trajectory(described.readout.rate_hz);
        let above = Pose {
            position_mm: DVec3::new(plan.x_mm, plan.y_mm, 0.0),
            rotation: plan.rotation,
        };
        let touch = self.gel.touch(self.gel.shape(&plan.indenter)?, &above)?;
        let pose = |depth_mm: f64| Pose {
            position_mm: touch.position_mm - depth_mm * DVec3::Z,
            ..touch
        };
        let n_taxels = described.taxels.len();
        let unread = vec![vec![0.0; n_taxels]; trajectory.len()];
        let press = twintac_recording::Press {
            name: plan.name.clone(),
            mounting: plan.indenter.clone(),
            indenter: plan.indenter.clone(),
            control: Control::Pose,
            time_s: trajectory.iter().map(|(time_s, _)| *time_s).collect(),
            gel_from_indenter: trajectory.iter().map(|(_, depth_mm)| pose(*depth_mm)).collect(),
            force_n: None,
            taxels_kpa: unread.clone(),
            taxels_raw: unread,
            valid: vec![vec![false; n_taxels]; trajectory.len()],
        };
        Ok(Recording {
            sensor: self.sensor.name().to_owned(),
            provenance: Provenance::Simulated,
            taxels: self.sensor.taxels().map(str::to_owned).collect(),
            presses: vec![press],
        })
    }
}
