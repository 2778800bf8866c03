//! Runs: from recordings to a judged twin.

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

/// A folder in which recordings become a judged twin and a report. What is done is kept: the same again does only what is missing.
///
/// `start`, `import_csv` and `finish` make one, `demo` makes one without data, `open` opens one that is there.
#[pyclass(frozen, module = "twintac")]
pub(crate) struct Run {
    run: twintac::Run,
}

impl Run {
    /// Does something with the run while `progress` follows.
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
    /// Starts a run, or takes up the one that the folder holds with new settings. `source` says in words where the presses come from. `settings`
    /// has those that differ from the usual ones, with a dictionary for each stage: `{"train": {"epochs": 40}}`. The same recordings, settings and `seed` give the
    /// same twin.
    ///
    /// Raises `Error`, whose `field` is the setting that cannot be, and for a folder that cannot be written.
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

    /// Opens a run that was started.
    ///
    /// Raises `Error` for a folder that is no run.
    #[staticmethod]
    fn open(py: Python<'_>, folder: PathBuf) -> PyResult<Self> {
        let run = twintac::Run::open(&folder, caller(py)?).or_raise(py)?;
        Ok(Self { run })
    }

    /// Starts the demo, and has its recordings made: PhysTac, pressed on the emulated bench. `finish` does the rest. All of it takes a minute. Ctrl-C stops it.
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

    /// Makes the run's recordings of CSV files of any laboratory, which the description (TOML) says how to read, as `Recording.import_csv` does.
    ///
    /// Raises `Error` with file, line and field: of the description, or of the cell that cannot be read.
    #[pyo3(signature = (description, *paths))]
    fn import_csv(&self, py: Python<'_>, description: PathBuf, paths: Vec<PathBuf>) -> PyResult<()> {
        self.work(py, None, move |run| run.import(&description, &paths))
    }

    /// Runs all stages after the recordings: simulates, aligns, trains, judges, reports. Returns how well the twin does, as `metrics.json` has it.
    /// Ctrl-C stops before the next step; the same call goes on from there.
    ///
    /// Raises `Error` for a run that has no recordings, and for presses that no twin can be trained with.
    #[pyo3(signature = (*, progress=None))]
    fn finish<'py>(
        &self,
        py: Python<'py>,
        progress: Option<Bound<'py, PyAny>>,
    ) -> PyResult<Bound<'py, PyAny>> {
        let metrics = self.work(py, progress.as_ref(), twintac::Run::finish)?;
        to_python(py, &metrics)
    }

    /// The presses, as recorded.
    ///
    /// Raises `Error` for a run that has none yet.
    fn recording(&self, py: Python<'_>) -> PyResult<Recording> {
        let recording = py.detach(|| self.run.recording()).or_raise(py)?;
        Ok(recording.into())
    }

    /// The run's folder.
    #[getter]
    fn folder(&self) -> PathBuf {
        self.run.folder().to_owned()
    }

    /// The folder of the twin of all presses, which `Twin.load` reads.
    #[getter]
    fn model_folder(&self) -> PathBuf {
        self.run.model_folder()
    }

    /// The page that says how well the twin does: `report.html` in the folder. It is there after `finish`.
    #[getter]
    fn report_path(&self) -> PathBuf {
        self.run.report_path()
    }
    /// What a pickle keeps.
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
