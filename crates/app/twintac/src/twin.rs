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
use twintac_sensors::{SensorBatch, SensorVariation};

use crate::{Error, Press, Sensor};
#[cfg(feature = "run")]
use crate::{Predicted, PressPath};

/// A trained twin: it predicts the readings of one sensor's barometers while its gel is pressed.
#[derive(Clone, Debug)]
pub struct Twin {
    sensor: Sensor,
    gel: twintac_simulate::Gel,
    model: Model,
}

impl Twin {
    /// Loads a twin from a model folder of a run: `<run>/model`.
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

    /// The twin's sensor.
    #[must_use]
    pub fn sensor(&self) -> &Sensor {
        &self.sensor
    }

    /// Provenance of the recordings that it was trained on. Its predictions are `simulated`.
    #[must_use]
    pub fn trained_on(&self) -> Provenance {
        self.model.record.provenance
    }

    /// Predicts the readings along a press, at the sensor's frame rate: takes a few seconds. Test
    /// setup and gel are as fitted in training. [`Prediction::certainty`] has the 90 % intervals
    /// and the OOD score.
    ///
    /// # Errors
    /// An indenter that the sensor does not have; a location that cannot be pressed.
    pub fn predict(&self, press: &Press) -> Result<Prediction, Error> {
        let rate_hz = self.sensor.file().sensor.readout.rate_hz;
        let bench = &self.model.record.bench;
        let plans = std::slice::from_ref(&press.plan);
        let twin = (&self.model.twin, self.model.record.certainty.as_ref());
        Ok(digitac::predict(twin, bench, &self.gel, plans, rate_hz)?.swap_remove(0))
    }

    /// Predicts the readings along a path: the gel is solved frame by frame, sliding and tilting
    /// included. `progress` is told of each frame, and can stop the work. If a path ends early,
    /// [`Predicted::failure`] says why. Points of the path are not read.
    ///
    /// # Errors
    /// An indenter that the sensor does not have; a path that misses the gel; work that was
    /// stopped.
    #[cfg(feature = "run")]
    pub fn predict_along(
        &self,
        path: &PressPath,
        progress: &dyn twintac_work::Progress,
    ) -> Result<Predicted, Error> {
        let predictor = Predictor::new(self.model.clone(), self.gel.clone());
        Ok(predictor.along(path.clone(), progress)?)
    }

    /// The twin at the location of a press and down to its depth, to be stepped with depths or
    /// poses as they come. The call takes about a second; a step then takes about a microsecond.
    ///
    /// # Errors
    /// As [`predict`](Self::predict).
    pub fn at(&self, press: &Press) -> Result<TwinAtPlace, Error> {
        let bench = &self.model.record.bench;
        let twin = (&self.model.twin, self.model.record.certainty.as_ref());
        Ok(digitac::at_place(twin, bench, &self.gel, &press.plan)?)
    }

    /// A batch of sensors with this twin's gains and relaxation, over a surrogate of the same
    /// sensor's gel. It is stepped with the bodies that touch each sensor.
    ///
    /// # Errors
    /// A surrogate of another gel, or of other port positions.
    #[cfg(feature = "sensors")]
    pub fn sensors(
        &self,
        gel: &FastGel,
        variation: SensorVariation,
        [n_sensors, n_threads]: [usize; 2],
        seed: u64,
    ) -> Result<SensorBatch, Error> {
        gel.check(&self.sensor.file().sensor)?;
        let twin = Some(&self.model.twin);
        Ok(SensorBatch::new(
            gel,
            twin,
            variation,
            [n_sensors, n_threads],
            seed,
        ))
    }

    /// Twins of `n_sensors` sensors, stepped together with pressures at their ports: for programs
    /// that solve the gel themselves, with one sensor or thousands.
    #[must_use]
    pub fn states(&self, n_sensors: usize) -> TwinState {
        self.model.twin.states(n_sensors)
    }
}
