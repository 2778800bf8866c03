//! Trained twins.

use std::path::PathBuf;
use std::sync::Arc;

use numpy::{PyArray1, PyArray2};
use pyo3::prelude::*;

use crate::array::{of_rows, rows};
use crate::error::{OrRaise, unreadable, unusable};
use crate::fast::PROVENANCE;
use crate::given::{Array, Given, since};
use crate::long_call::{followed, long_call};
use crate::path::PressPath;
use crate::pickle::{Kept, Reduced, reduced, refused};
use crate::plot::plot;
use crate::press::Press;
use crate::sensor::Sensor;
use crate::shared::Shared;

/// The file of a twin's folder that tells one twin from another.
const CHECKSUMS: &str = "checksums.json";

/// A trained twin: what the barometers of one sensor would read while its gel is pressed.
///
/// `predict` reads a whole press, `at` one place frame by frame, `states` many sensors together, from pressures at their ports.
#[pyclass(frozen, module = "twintac")]
pub(crate) struct Twin {
    pub(crate) twin: Arc<twintac::Twin>,
    folder: PathBuf,
    /// The checksums of the folder's files.
    checksums: String,
}

impl Twin {
    fn of(py: Python<'_>, folder: PathBuf) -> PyResult<Self> {
        let (twin, checksums) = py
            .detach(|| {
                let twin = twintac::Twin::load(&folder)?;
                Ok::<_, twintac::Error>((twin, std::fs::read_to_string(folder.join(CHECKSUMS))))
            })
            .or_raise(py)?;
        let folder = std::path::absolute(&folder).unwrap_or(folder);
        Ok(Self {
            twin: Arc::new(twin),
            checksums: checksums.map_err(|error| unreadable(py, &folder.join(CHECKSUMS), &error))?,
            folder,
        })
    }
}

#[pymethods]
impl Twin {
    /// Loads a twin from the folder that a run leaves it in: `<run>/model` (`Run.model_folder`). A pickle keeps where the folder is, and finds the same twin there or raises `Error`.
    ///
    /// Raises `Error` for a folder that holds no twin, or a damaged one.
    #[staticmethod]
    fn load(py: Python<'_>, folder: PathBuf) -> PyResult<Self> {
        Self::of(py, folder)
    }

    /// The sensor whose twin it is.
    #[getter]
    fn sensor(&self) -> Sensor {
        Sensor {
            sensor: self.twin.sensor().clone(),
        }
    }

    /// Where the recordings come from that it was trained with: `"real"`, `"emulated"` or `"simulated"`. What it predicts is simulated.
    #[getter]
    fn trained_on(&self) -> String {
        self.twin.trained_on().to_string()
    }

    /// What the barometers would read along a press, as many frames a second as the sensor gives. Bench and gel are as they were found at training. Takes a few
    /// seconds; Ctrl-C ends the wait.
    ///
    /// Raises `Error` for an indenter that the sensor does not have, and for a place that cannot be pressed.
    fn predict(&self, py: Python<'_>, press: &Press) -> PyResult<Prediction> {
        let (twin, press) = (Arc::clone(&self.twin), twintac::Press::from(press));
        let prediction = long_call(py, move || twin.predict(&press))?.or_raise(py)?;
        Ok(Prediction {
            n_taxels: self.twin.sensor().taxels().count(),
            prediction,
            failure: None,
        })
    }

    /// What the barometers would read along a path: the gel is solved frame by frame, sliding and tilting included; each frame takes from some milliseconds to seconds. Points of
    /// the path are not read. Ctrl-C ends it before its next frame. `Prediction.failure` says why a path ends before it should.
    ///
    /// Raises `Error` for an indenter that the sensor does not have, and for a path that misses the gel.
    #[pyo3(signature = (path, *, progress=None))]
    fn predict_along(
        &self,
        py: Python<'_>,
        path: PressPath,
        progress: Option<Bound<'_, PyAny>>,
    ) -> PyResult<Prediction> {
        let twin = Arc::clone(&self.twin);
        let predicted = followed(py, progress.as_ref(), move |progress| {
            twin.predict_along(&path.path, progress.as_ref())
        })?;
        let mut predicted = predicted.or_raise(py)?;
        Ok(Prediction {
            n_taxels: self.twin.sensor().taxels().count(),
            prediction: predicted.presses.swap_remove(0),
            failure: predicted.failure,
        })
    }

    /// The twin at the place of a press and down to its depth, to be stepped with depths as they come. Takes a second; Ctrl-C ends the wait. A step then takes a
    /// microsecond.
    ///
    /// Raises `Error` as `predict` does.
    fn at(&self, py: Python<'_>, press: &Press) -> PyResult<TwinAtPlace> {
        let (twin, press) = (Arc::clone(&self.twin), twintac::Press::from(press));
        Ok(TwinAtPlace {
            n_taxels: self.twin.sensor().taxels().count(),
            twin: Shared::new(long_call(py, move || twin.at(&press))?.or_raise(py)?),
        })
    }

    /// Twins of so many sensors, to be stepped together with pressures at their ports: for programs that solve the gel themselves.
    ///
    /// Raises `Error` for no sensor, and for more than make ten million readings.
    #[pyo3(signature = (n_sensors=None), text_signature = "($self, n_sensors=1)")]
    fn states(&self, n_sensors: Option<Given<'_>>) -> PyResult<TwinState> {
        let n_taxels = self.twin.sensor().taxels().count();
        let range = 1..=twintac::most_sensors(n_taxels);
        let n_sensors = n_sensors.map_or(Ok(1), |given| given.count("n_sensors", range))?;
        Ok(TwinState {
            shape: [n_sensors, n_taxels],
            state: Shared::new(self.twin.states(n_sensors)),
        })
    }

    /// What a pickle keeps.
    fn __reduce__<'py>(&self, py: Python<'py>) -> PyResult<Reduced<'py>> {
        reduced(py, self)
    }

    fn __repr__(&self) -> String {
        format!(
            "<Twin of {:?}, trained on {} presses>",
            self.twin.sensor().name(),
            self.trained_on()
        )
    }
}

/// What a twin would read along a press or a path: what `Twin.predict` and `Twin.predict_along` return. Every array has a row for each frame.
#[pyclass(frozen, module = "twintac")]
pub(crate) struct Prediction {
    prediction: twintac::Prediction,
    n_taxels: usize,
    failure: Option<String>,
}

#[pymethods]
impl Prediction {
    /// What every number here is: simulated.
    #[getter]
    fn provenance(&self) -> &'static str {
        PROVENANCE
    }

    /// Why the frames end before the path does; `None` if they do not, and of a press.
    #[getter]
    fn failure(&self) -> Option<&str> {
        self.failure.as_deref()
    }

    /// Place of the indenter's origin in the gel's plane, x and y, mm; `[n_frames, 2]`.
    #[getter]
    fn place_mm<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray2<f64>>> {
        let places_mm = self.prediction.place_mm.as_flattened().to_vec();
        rows(py, places_mm, [self.prediction.place_mm.len(), 2])
    }

    /// Time since the start of the press, or that of the path, s; `[n_frames]`.
    #[getter]
    fn time_s<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<f64>> {
        PyArray1::from_slice(py, &self.prediction.time_s)
    }

    /// Depth below first touch, mm, with the height at which the bench of the recordings touched; negative above the gel; `[n_frames]`.
    #[getter]
    fn depth_mm<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<f64>> {
        PyArray1::from_slice(py, &self.prediction.depth_mm)
    }

    /// Force of the indenter into the gel, N; `[n_frames]`.
    #[getter]
    fn force_n<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<f64>> {
        PyArray1::from_slice(py, &self.prediction.force_n)
    }

    /// What the barometers would read above what they read untouched, kPa; `[n_frames, n_taxels]`.
    #[getter]
    fn readings_kpa<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray2<f64>>> {
        of_rows(py, &self.prediction.readings_kpa, self.n_taxels)
    }

    /// Whether the frame was simulated; `[n_frames]`. It was not where it is deeper than the gel could be pressed: the last pressures stand there.
    #[getter]
    fn simulated<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<bool>> {
        PyArray1::from_slice(py, &self.prediction.simulated)
    }

    /// Half the width of the 90 % interval around each reading, kPa, `[n_frames, n_taxels]`; `None` of a twin that does not know.
    #[getter]
    fn half_width_kpa<'py>(&self, py: Python<'py>) -> PyResult<Option<Bound<'py, PyArray2<f64>>>> {
        let certainty = self.prediction.certainty.as_ref();
        certainty
            .map(|certainty| of_rows(py, &certainty.half_width_kpa, self.n_taxels))
            .transpose()
    }

    /// How unlike the contact is to what taught the twin, without unit, `[n_frames]`; `None` of a twin that does not know.
    #[getter]
    fn unlikeness<'py>(&self, py: Python<'py>) -> Option<Bound<'py, PyArray1<f64>>> {
        let certainty = self.prediction.certainty.as_ref()?;
        Some(PyArray1::from_slice(py, &certainty.unlikeness))
    }

    /// Whether the contact is too unlike for readings and intervals to be trusted, `[n_frames]`; `None` of a twin that does not know.
    #[getter]
    fn is_unlike<'py>(&self, py: Python<'py>) -> Option<Bound<'py, PyArray1<bool>>> {
        let certainty = self.prediction.certainty.as_ref()?;
        Some(PyArray1::from_slice(py, &certainty.is_unlike))
    }

    /// Draws readings with their 90 % intervals, force and depth over time; grey is where they are not to be trusted: not simulated, or unlike.
    ///
    /// With Matplotlib; its three axes are returned, to be restyled: new ones, or those given. Raises `ModuleNotFoundError` without it, and `Error` for another number of axes.
    #[pyo3(signature = (axes=None))]
    fn plot<'py>(result: &Bound<'py, Self>, axes: Option<Bound<'py, PyAny>>) -> PyResult<Bound<'py, PyAny>> {
        plot(result.py(), "prediction", (result, axes))
    }

    /// What a pickle keeps.
    fn __reduce__<'py>(&self, py: Python<'py>) -> PyResult<Reduced<'py>> {
        reduced(py, self)
    }

    fn __len__(&self) -> usize {
        self.prediction.time_s.len()
    }

    fn __repr__(&self) -> String {
        let (press, n_frames) = (&self.prediction.name, self.__len__());
        format!("<Prediction of {press:?}, {n_frames} frames, {PROVENANCE}>")
    }
}

impl Kept for Twin {
    /// Its folder, and the checksums there.
    type State = (PathBuf, String);

    fn state(&self, _: Python<'_>) -> PyResult<Self::State> {
        Ok((self.folder.clone(), self.checksums.clone()))
    }

    fn restored(py: Python<'_>, (folder, checksums): Self::State) -> PyResult<Self> {
        let twin = Self::of(py, folder)?;
        if twin.checksums == checksums {
            return Ok(twin);
        }
        let problem = format!(
            "in {} is another one than was pickled: load it again",
            twin.folder.display()
        );
        Err(unusable(py, "Twin", &problem))
    }
}

impl Kept for Prediction {
    type State = (twintac::Prediction, usize, Option<String>);

    fn state(&self, _: Python<'_>) -> PyResult<Self::State> {
        Ok((self.prediction.clone(), self.n_taxels, self.failure.clone()))
    }

    fn restored(_: Python<'_>, (prediction, n_taxels, failure): Self::State) -> PyResult<Self> {
        Ok(Self {
            prediction,
            n_taxels,
            failure,
        })
    }
}

/// A twin whose sensor is pressed at one place, stepped with depths: what `Twin.at` returns.
#[pyclass(frozen, module = "twintac")]
pub(crate) struct TwinAtPlace {
    twin: Shared<twintac::TwinAtPlace>,
    n_taxels: usize,
}

#[pymethods]
impl TwinAtPlace {
    /// What every reading is: simulated.
    #[getter]
    fn provenance(&self) -> &'static str {
        PROVENANCE
    }

    /// One more frame, `since_previous_s` after the last, at a depth below first touch, mm, negative above the gel. Returns what the barometers would read above
    /// their zero, kPa; `[n_taxels]`.
    ///
    /// Raises `Error` for a time below 0 or a depth that is not finite.
    fn step<'py>(
        &self,
        py: Python<'py>,
        since_previous_s: f64,
        depth_mm: f64,
    ) -> PyResult<Bound<'py, PyArray1<f64>>> {
        since(py, since_previous_s)?;
        if !depth_mm.is_finite() {
            return Err(unusable(py, "depth_mm", "is not finite"));
        }
        let mut readings_kpa = vec![0.0; self.n_taxels];
        self.twin.look(py, |twin| {
            twin.step(since_previous_s, depth_mm, &mut readings_kpa)
        })?;
        Ok(PyArray1::from_vec(py, readings_kpa))
    }

    /// Force of the indenter into the gel at the last frame, N.
    #[getter]
    fn force_n(&self, py: Python<'_>) -> PyResult<f64> {
        self.twin.look(py, |twin| twin.force_n())
    }

    /// Half the widths of the 90 % intervals around the last readings, kPa, `[n_taxels]`; `None` of a twin that does not know.
    #[getter]
    fn half_width_kpa<'py>(&self, py: Python<'py>) -> PyResult<Option<Bound<'py, PyArray1<f64>>>> {
        self.twin.look(py, |twin| {
            let widths = twin.half_width_kpa();
            widths.map(|widths| PyArray1::from_slice(py, widths))
        })
    }

    /// How unlike the last contact is to what taught the twin, without unit, and whether it is too unlike for readings and intervals to be trusted; `None` of a
    /// twin that does not know.
    #[getter]
    fn unlikeness(&self, py: Python<'_>) -> PyResult<Option<(f64, bool)>> {
        self.twin.look(py, |twin| twin.unlikeness())
    }

    /// Depth below first touch at which the table ends, mm; deeper, its last pressures stand.
    #[getter]
    fn max_depth_mm(&self, py: Python<'_>) -> PyResult<f64> {
        self.twin.look(py, |twin| twin.max_depth_mm())
    }

    /// Takes what is read now as zero, as a tare of a real sensor does.
    fn tare(&self, py: Python<'_>) -> PyResult<()> {
        self.twin.look(py, twintac::TwinAtPlace::tare)
    }

    /// Lets the gel rest until the next frame: it forgets the presses before. The zero stays.
    fn rest(&self, py: Python<'_>) -> PyResult<()> {
        self.twin.look(py, twintac::TwinAtPlace::rest)
    }

    /// What is pressed is no value.
    fn __reduce__(&self) -> PyResult<()> {
        refused(
            "TwinAtPlace",
            "pickle the Twin, and make one in each process, with Twin.at",
        )
    }

    fn __repr__(&self, py: Python<'_>) -> PyResult<String> {
        let deepest_mm = self.max_depth_mm(py)?;
        let n_taxels = self.n_taxels;
        Ok(format!(
            "<TwinAtPlace of {n_taxels} taxels, down to {deepest_mm:.2} mm, {PROVENANCE}>"
        ))
    }
}

/// Twins of many sensors, stepped together with pressures at their ports: what `Twin.states` returns. `len()` is the number of sensors.
#[pyclass(frozen, module = "twintac")]
pub(crate) struct TwinState {
    state: Shared<twintac::TwinState>,
    /// Sensors and taxels.
    shape: [usize; 2],
}

#[pymethods]
impl TwinState {
    /// What every reading is: simulated.
    #[getter]
    fn provenance(&self) -> &'static str {
        PROVENANCE
    }

    /// One more frame of every sensor, `since_previous_s` after the last: from pressures at the ports to what the barometers would read, kPa; both
    /// `[n_sensors, n_taxels]`.
    ///
    /// Raises `Error` for a time below 0, and for pressures of another shape or that are not finite.
    fn step<'py>(
        &self,
        py: Python<'py>,
        since_previous_s: f64,
        pressure_kpa: Given<'_>,
    ) -> PyResult<Bound<'py, PyArray2<f64>>> {
        since(py, since_previous_s)?;
        let expected = format!("{:?}, kPa", self.shape);
        let pressure_kpa: Array<2> = pressure_kpa.numbers("pressure_kpa", &expected)?;
        if pressure_kpa.shape != self.shape {
            let problem = format!("has the shape {:?}, expected {expected}", pressure_kpa.shape);
            return Err(unusable(py, "pressure_kpa", &problem));
        }
        let seen = pressure_kpa.values;
        if !seen.iter().all(|kpa| kpa.is_finite()) {
            let problem = "has a number that is not finite: the gel would remember it for ever";
            return Err(unusable(py, "pressure_kpa", problem));
        }
        let mut readings_kpa = vec![0.0; seen.len()];
        self.state
            .work(py, |state| state.step(since_previous_s, &seen, &mut readings_kpa))?;
        rows(py, readings_kpa, self.shape)
    }

    /// Takes what is read now as zero, as a tare of a real sensor does.
    fn tare(&self, py: Python<'_>) -> PyResult<()> {
        self.state.look(py, twintac::TwinState::tare)
    }

    /// Takes what a sensor that nothing touches reads as zero.
    fn tare_untouched(&self, py: Python<'_>) -> PyResult<()> {
        self.state.look(py, twintac::TwinState::tare_untouched)
    }

    /// Lets the gel of one sensor, counted from 0, rest until its next frame: it forgets the presses before. Its zero stays.
    fn rest(&self, py: Python<'_>, sensor: Given<'_>) -> PyResult<()> {
        let sensor = sensor.count("sensor", 0..=self.shape[0] - 1)?;
        self.state.look(py, |state| state.rest(sensor))
    }

    /// What is stepped is no value.
    fn __reduce__(&self) -> PyResult<()> {
        refused(
            "TwinState",
            "pickle the Twin, and make one in each process, with Twin.states",
        )
    }

    fn __repr__(&self) -> String {
        let [n_sensors, n_taxels] = self.shape;
        format!("<TwinState of {n_sensors} sensors of {n_taxels} taxels, {PROVENANCE}>")
    }

    fn __len__(&self) -> usize {
        self.shape[0]
    }
}
