//! Recorded presses.

use std::path::PathBuf;

use numpy::PyArray1;
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyList};
use twintac::{Column, Recorded, import_files};

use crate::error::{OrRaise, unusable};
use crate::long_call::long_call;
use crate::sensor::Sensor;
use crate::settings::to_python;

/// Where numbers come from: `"real"`, `"emulated"` or `"simulated"`.
pub(crate) struct Provenance(twintac::Provenance);

impl std::fmt::Display for Provenance {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        self.0.fmt(f)
    }
}

impl<'py> FromPyObject<'_, 'py> for Provenance {
    type Error = PyErr;

    fn extract(word: Borrowed<'_, 'py, PyAny>) -> PyResult<Self> {
        let text: String = word.extract()?;
        serde_json::from_value(text.clone().into())
            .map(Self)
            .map_err(|_| {
                let problem = format!("is {text:?}, expected \"real\", \"emulated\" or \"simulated\"");
                unusable(word.py(), "provenance", &problem)
            })
    }
}

/// Recorded presses of one sensor.
#[pyclass(frozen, module = "twintac")]
pub(crate) struct Recording {
    pub(crate) recording: twintac::Recording,
}

#[pymethods]
impl Recording {
    /// Reads a Parquet file, as runs and `save` write it.
    #[staticmethod]
    fn load(py: Python<'_>, path: PathBuf) -> PyResult<Self> {
        let recording = long_call(py, move || twintac::Recording::read_parquet(&path))?.or_raise(py)?;
        Ok(Self { recording })
    }

    /// Reads CSV files of any laboratory, which the description (TOML) says how to read.
    #[staticmethod]
    #[pyo3(signature = (description, *paths))]
    fn import_csv(py: Python<'_>, description: PathBuf, paths: Vec<PathBuf>) -> PyResult<Self> {
        let (recording, _) = long_call(py, move || import_files(&description, &paths))?.or_raise(py)?;
        Ok(Self { recording })
    }

    /// Name of the sensor's description.
    #[getter]
    fn sensor(&self) -> &str {
        &self.recording.sensor
    }

    /// Where the numbers come from.
    #[getter]
    fn provenance(&self) -> String {
        self.recording.provenance.to_string()
    }

    /// Names of the taxels.
    #[getter]
    fn taxels(&self) -> Vec<String> {
        self.recording.taxels.clone()
    }

    /// Names of the presses.
    #[getter]
    fn presses(&self) -> Vec<&str> {
        self.recording.presses.iter().map(|press| &*press.name).collect()
    }

    /// A column for each name of the Parquet file, with a value for each frame; NaN where a force is not known.
    fn columns<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let columns = PyDict::new(py);
        for (name, column) in self.recording.columns() {
            columns.set_item(name, self.column(py, column)?)?;
        }
        Ok(columns)
    }

    /// The columns as a `pandas.DataFrame`.
    fn to_pandas<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        py.import("pandas")?
            .call_method1("DataFrame", (self.columns(py)?,))
    }

    /// The columns as a `polars.DataFrame`.
    fn to_polars<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        py.import("polars")?
            .call_method1("DataFrame", (self.columns(py)?,))
    }

    /// Writes a Parquet file.
    fn save(&self, py: Python<'_>, path: PathBuf) -> PyResult<()> {
        py.detach(|| self.recording.write_parquet(&path)).or_raise(py)
    }

    /// Writes a LeRobot data set, version 3.0, into a folder that is not there yet: presses are episodes, indenters are tasks. `how_made` is put into its data card.
    /// Returns the numbers of episodes, frames and tasks.
    #[pyo3(signature = (folder, *, how_made=""))]
    fn save_lerobot<'py>(
        &self,
        py: Python<'py>,
        folder: PathBuf,
        how_made: &str,
    ) -> PyResult<Bound<'py, PyAny>> {
        let written = py.detach(|| self.recording.write_lerobot(&folder, how_made));
        to_python(py, &written.or_raise(py)?)
    }

    /// What the sensor does, as far as the presses tell: sensitivity, noise, hysteresis and more, as `twintac characterize --json` says it.
    /// With a folder, the report and the data sheet are written into it.
    #[pyo3(signature = (sensor, folder=None))]
    fn characterize<'py>(
        &self,
        py: Python<'py>,
        sensor: &Sensor,
        folder: Option<PathBuf>,
    ) -> PyResult<Bound<'py, PyAny>> {
        let sensor = sensor.sensor.clone();
        let recorded = Recorded::from(self.recording.clone());
        let found = long_call(py, move || {
            let sensor = &sensor.file().sensor;
            let found = recorded.characterize(sensor)?;
            if let Some(folder) = folder {
                recorded.write(&found, sensor, &folder)?;
            }
            Ok::<_, twintac::RunError>(found)
        })?;
        to_python(py, &found.or_raise(py)?)
    }

    fn __len__(&self) -> usize {
        self.recording.presses.len()
    }

    fn __repr__(&self) -> String {
        let (sensor, provenance) = (self.sensor(), &self.recording.provenance);
        format!(
            "<Recording of {} presses of {sensor:?}, {provenance}>",
            self.__len__()
        )
    }
}

impl Recording {
    fn column<'py>(&self, py: Python<'py>, column: Column) -> PyResult<Bound<'py, PyAny>> {
        Ok(match column {
            Column::Index(numbers) => PyArray1::from_vec(py, numbers).into_any(),
            Column::Number(numbers) => PyArray1::from_vec(py, numbers).into_any(),
            Column::Flag(flags) => PyArray1::from_vec(py, flags).into_any(),
            Column::Known(numbers) => {
                let numbers = numbers.into_iter().map(|number| number.unwrap_or(f64::NAN));
                PyArray1::from_iter(py, numbers).into_any()
            }
            Column::Text(texts) => {
                let n_frames = self.recording.presses.iter().map(|press| press.time_s.len());
                let numpy = py.import("numpy")?;
                let texts = numpy.call_method1("array", (PyList::new(py, texts)?, "object"))?;
                numpy.call_method1("repeat", (texts, n_frames.collect::<Vec<_>>()))?
            }
        })
    }
}
