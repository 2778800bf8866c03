//! Runs: from recordings to an evaluated twin.

use std::path::PathBuf;
use std::sync::Arc;

use pyo3::prelude::*;
use pyo3::types::PyDict;
use twintac::{RunSettings, Silent, WorkError};

use crate::error::OrRaise;
use crate::given::Given;
use crate::long_call::followed;
use crate::pickle::{Kept, Reduced, reduced};
use crate::program::caller;
use crate::recording::Recording;
use crate::sensor::Sensor;
use crate::settings::{but, to_python};

/// A folder in which recordings become an evaluated twin and a report. Finished stages are kept: a
/// call with the same inputs does only what is missing.
///
/// `start`, `import_csv` and `finish` make a run, `demo` makes one without data, and `open` opens
/// an existing one.
#[pyclass(frozen, module = "twintac")]
pub(crate) struct Run {
    run: twintac::Run,
}

impl Run {
    /// Does work on the run and reports to `progress`.
    fn work<T: Send + 'static>(
        &self,
        py: Python<'_>,
        progress: Option<&Bound<'_, PyAny>>,
        work: impl FnOnce(&twintac::Run) -> Result<T, WorkError> + Send + 'static,
    ) -> PyResult<T> {
        let run = self.run.clone();
        followed(py, progress, |progress| work(&run.followed_by(progress)))?.or_raise(py)
    }
}

#[pymethods]
impl Run {
    /// Starts a run, or continues the one in the folder with new settings. The same recordings,
    /// settings and `seed` give the same twin.
    ///
    /// - `folder`: path of the folder.
    /// - `sensor`: the sensor.
    /// - `source`: a text that says where the presses come from.
    /// - `seed`: seed of all random choices.
    /// - `settings`: settings that differ from the default ones, with a dictionary for each stage:
    ///   `{"train": {"epochs": 40}}`.
    ///
    /// Raises `Error` for a setting that is not allowed (its `field` names the setting), and for a
    /// folder that cannot be written.
    #[staticmethod]
    #[pyo3(signature = (folder, sensor, source, *, seed=None, settings=None), text_signature = "(folder, sensor, source, *, seed=1, settings=None)")]
    fn start(
        py: Python<'_>,
        folder: PathBuf,
        sensor: &Sensor,
        source: &str,
        seed: Option<Given<'_>>,
        settings: Option<Bound<'_, PyDict>>,
    ) -> PyResult<Self> {
        let seed = seed.map_or(Ok(1), |seed| seed.seed("seed"))?;
        let settings = but(py, RunSettings::default(), settings.as_ref(), "")?;
        let run = twintac::Run::start(&folder, &sensor.sensor, source, seed, settings, caller(py)?);
        Ok(Self {
            run: run.or_raise(py)?,
        })
    }

    /// Opens an existing run.
    ///
    /// Raises `Error` for a folder that is not a run.
    #[staticmethod]
    fn open(py: Python<'_>, folder: PathBuf) -> PyResult<Self> {
        let run = twintac::Run::open(&folder, caller(py)?).or_raise(py)?;
        Ok(Self { run })
    }

    /// Starts a demo run, and makes its recordings: PhysTac, pressed on the emulated bench.
    /// `finish` does the rest. Both together take a minute. Ctrl-C stops the call.
    ///
    /// - `folder`: path of the folder.
    /// - `seed`: seed of all random choices.
    /// - `progress`: display of the progress, see `Progress`.
    #[staticmethod]
    #[pyo3(signature = (folder, *, seed=None, progress=None), text_signature = "(folder, *, seed=1, progress=None)")]
    fn demo(
        py: Python<'_>,
        folder: PathBuf,
        seed: Option<Given<'_>>,
        progress: Option<Bound<'_, PyAny>>,
    ) -> PyResult<Self> {
        let seed = seed.map_or(Ok(1), |seed| seed.seed("seed"))?;
        let caller = caller(py)?;
        let run = followed(py, progress.as_ref(), move |progress| {
            twintac::Run::demo(&folder, seed, twintac::Caller { progress, ..caller })
        })?;
        Ok(Self {
            run: run.or_raise(py)?.followed_by(Arc::new(Silent)),
        })
    }

    /// Makes the recordings of the run from CSV files of any laboratory, as `Recording.import_csv`
    /// does.
    ///
    /// - `description`: path of the import description (TOML), which says how to read the files.
    /// - `paths`: paths of the CSV files.
    ///
    /// Raises `Error` with file, line and field: of the import description, or of the cell that
    /// cannot be read.
    #[pyo3(signature = (description, *paths))]
    fn import_csv(&self, py: Python<'_>, description: PathBuf, paths: Vec<PathBuf>) -> PyResult<()> {
        self.work(py, None, move |run| run.import(&description, &paths))
    }

    /// Runs all stages after the recordings: simulation, alignment, training, evaluation, report.
    /// Ctrl-C stops the call before the next step; the same call continues from there.
    ///
    /// - `progress`: display of the progress, see `Progress`.
    ///
    /// Returns the figures of the evaluation, as in `metrics.json`.
    ///
    /// Raises `Error` for a run without recordings, and for presses on which no twin can be
    /// trained.
    #[pyo3(signature = (*, progress=None))]
    fn finish<'py>(
        &self,
        py: Python<'py>,
        progress: Option<Bound<'py, PyAny>>,
    ) -> PyResult<Bound<'py, PyAny>> {
        let metrics = self.work(py, progress.as_ref(), twintac::Run::finish)?;
        to_python(py, &metrics)
    }

    /// The recorded presses.
    ///
    /// Raises `Error` for a run without recordings.
    fn recording(&self, py: Python<'_>) -> PyResult<Recording> {
        let recording = py.detach(|| self.run.recording()).or_raise(py)?;
        Ok(recording.into())
    }

    /// The run's folder.
    #[getter]
    fn folder(&self) -> PathBuf {
        self.run.folder().to_owned()
    }

    /// The folder of the twin that was trained on all presses. `Twin.load` reads it.
    #[getter]
    fn model_folder(&self) -> PathBuf {
        self.run.model_folder()
    }

    /// Path of the report on the evaluation of the twin: `report.html` in the folder. It exists
    /// after `finish`.
    #[getter]
    fn report_path(&self) -> PathBuf {
        self.run.report_path()
    }
    /// Supports `pickle` and `copy`: returns the function that restores the object, and its state.
    fn __reduce__<'py>(&self, py: Python<'py>) -> PyResult<Reduced<'py>> {
        reduced(py, self)
    }

    fn __repr__(&self) -> String {
        format!("<Run in {:?}>", self.run.folder())
    }
}

impl Kept for Run {
    /// Its folder.
    type State = PathBuf;

    fn state(&self, _: Python<'_>) -> PyResult<PathBuf> {
        let folder = self.run.folder();
        Ok(std::path::absolute(folder).unwrap_or_else(|_| folder.to_owned()))
    }

    fn restored(py: Python<'_>, folder: PathBuf) -> PyResult<Self> {
        Self::open(py, folder)
    }
}
