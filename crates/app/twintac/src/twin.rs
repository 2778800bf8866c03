//! A trained twin.

use std::path::Path;
use std::sync::Arc;

use digitac::{Model, Prediction, TwinAtPlace, TwinState};
#[cfg(feature = "sensors")]
use twintac_fast::FastGel;
#[cfg(feature = "run")]
use twintac_model::Predictor;
use twintac_recording::Provenance;
use twintac_sensor::SensorFile;
#[cfg(feature = "sensors")]
use twintac_sensors::{Imperfection, SensorBatch};

use crate::{Error, Press, Sensor};
#[cfg(feature = "run")]
use crate::{Predicted, PressPath};

/// A trained twin: what the barometers of one sensor would read while its gel is pressed.
#[derive(Clone, Debug)]
pub struct Twin {
    sensor: Sensor,
    gel: twintac_simulate::Gel,
    model: Model,
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

    /// What the barometers would read along a press, as many frames a second as the sensor gives: takes a few seconds. Bench and gel are as
    /// they were found at training. [`Prediction::certainty`] says how sure the twin is.
    ///
    /// # Errors
    /// An indenter that the sensor does not have; a place that cannot be pressed.
    pub fn predict(&self, press: &Press) -> Result<Prediction, Error> {
        let rate_hz = self.sensor.file().sensor.readout.rate_hz;
        let bench = &self.model.record.bench;
        let plans = std::slice::from_ref(&press.plan);
        let twin = (&self.model.twin, self.model.record.certainty.as_ref());
        Ok(digitac::predict(twin, bench, &self.gel, plans, rate_hz)?.swap_remove(0))
    }

    /// What the barometers would read along a path: the gel is solved frame by frame, sliding and tilting included. `progress` hears of each frame, and can stop it.
    /// [`Predicted::failure`] says why a path ends before it should. Points of the path are not read.
    ///
    /// # Errors
    /// An indenter that the sensor does not have; a path that misses the gel; work that was stopped.
    #[cfg(feature = "run")]
    pub fn predict_along(
        &self,
        path: &PressPath,
        progress: &dyn twintac_work::Progress,
    ) -> Result<Predicted, Error> {
        let predictor = Predictor::new(self.model.clone(), self.gel.clone());
        Ok(predictor.along(path.clone(), progress)?)
    }

    /// The twin at the place of a press and down to its depth, to be stepped with depths or poses as they come. Takes a second; a step then
    /// takes a microsecond.
    ///
    /// # Errors
    /// As [`predict`](Self::predict).
    pub fn at(&self, press: &Press) -> Result<TwinAtPlace, Error> {
        let bench = &self.model.record.bench;
        let twin = (&self.model.twin, self.model.record.certainty.as_ref());
        Ok(digitac::at_place(twin, bench, &self.gel, &press.plan)?)
    }

    /// So many sensors with this twin's gains and memory, over a fast gel of the same sensor, to be
    /// stepped with what touches them.
    ///
    /// # Errors
    /// The fast gel of another gel, or of ports elsewhere.
    #[cfg(feature = "sensors")]
    pub fn sensors(
        &self,
        gel: &FastGel,
        imperfection: Imperfection,
        [n_sensors, n_threads]: [usize; 2],
        seed: u64,
    ) -> Result<SensorBatch, Error> {
        gel.check(&self.sensor.file().sensor)?;
        let twin = Some(&self.model.twin);
        Ok(SensorBatch::new(
            gel,
            twin,
            imperfection,
            [n_sensors, n_threads],
            seed,
        ))
    }

    /// Twins of so many sensors, to be stepped together with pressures at their ports, for programs that solve the gel themselves: one sensor,
    /// or thousands.
    #[must_use]
    pub fn states(&self, n_sensors: usize) -> TwinState {
        self.model.twin.states(n_sensors)
    }
}
