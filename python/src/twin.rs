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

/// The file of a twin's folder that identifies the twin.
const CHECKSUMS: &str = "checksums.json";

/// A trained twin: it predicts the readings of one sensor's barometers while its gel is pressed.
///
/// `predict` computes a whole press, `predict_along` a path, `at` one location frame by frame, and
/// `states` many sensors together from the pressures at their ports.
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
    /// Loads a twin. A pickle contains the path of the folder. Unpickling loads the same twin from
    /// there, or raises `Error`.
    ///
    /// - `folder`: the folder of a run's twin: `<run>/model` (`Run.model_folder`).
    ///
    /// Raises `Error` for a folder that holds no twin, or a damaged one.
    #[staticmethod]
    fn load(py: Python<'_>, folder: PathBuf) -> PyResult<Self> {
        Self::of(py, folder)
    }

    /// The sensor of the twin.
    #[getter]
    fn sensor(&self) -> Sensor {
        Sensor {
            sensor: self.twin.sensor().clone(),
        }
    }

    /// Provenance of the recordings on which the twin was trained: `"real"`, `"emulated"` or
    /// `"simulated"`. Its predictions are `"simulated"`.
    #[getter]
    fn trained_on(&self) -> String {
        self.twin.trained_on().to_string()
    }

    /// Predicts the readings along a press, at the frame rate of the sensor. Test setup and gel are
    /// as they were fitted in the training. The call takes a few seconds; Ctrl-C ends the wait.
    ///
    /// - `press`: the press.
    ///
    /// Raises `Error` for an indenter that the sensor does not have, and for a location that cannot
    /// be pressed.
    fn predict(&self, py: Python<'_>, press: &Press) -> PyResult<Prediction> {
        let (twin, press) = (Arc::clone(&self.twin), twintac::Press::from(press));
        let prediction = long_call(py, move || twin.predict(&press))?.or_raise(py)?;
        Ok(Prediction {
            n_taxels: self.twin.sensor().taxels().count(),
            prediction,
            failure: None,
        })
    }

    /// Predicts the readings along a path. The gel is computed by finite elements, frame by frame,
    /// with sliding and tilting; a frame takes from some milliseconds to seconds. Ctrl-C ends the
    /// call before the next frame. If the path cannot be followed to its end, `Prediction.failure`
    /// says why.
    ///
    /// - `path`: the path. Its points are not read.
    /// - `progress`: display of the progress, see `Progress`.
    ///
    /// Raises `Error` for an indenter that the sensor does not have, and for a path that misses the
    /// gel.
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

    /// The twin at the location of a press and down to its depth, to be stepped with depths as they
    /// come. The call takes a second; Ctrl-C ends the wait. A step then takes a microsecond.
    ///
    /// - `press`: the press.
    ///
    /// Raises `Error` as `predict` does.
    fn at(&self, py: Python<'_>, press: &Press) -> PyResult<TwinAtPlace> {
        let (twin, press) = (Arc::clone(&self.twin), twintac::Press::from(press));
        Ok(TwinAtPlace {
            n_taxels: self.twin.sensor().taxels().count(),
            twin: Shared::new(long_call(py, move || twin.at(&press))?.or_raise(py)?),
        })
    }

    /// Twins of many sensors, to be stepped together with the pressures at their ports: for
    /// programs that compute the gel themselves.
    ///
    /// - `n_sensors`: number of sensors, from 1 to as many as give ten million readings.
    ///
    /// Raises `Error` for a number out of this range.
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

    /// Supports `pickle` and `copy`: returns the function that restores the object, and its state.
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

/// Predicted readings along a press or a path: the result of `Twin.predict` and
/// `Twin.predict_along`. Every array has a row for each frame.
#[pyclass(frozen, module = "twintac")]
pub(crate) struct Prediction {
    prediction: twintac::Prediction,
    n_taxels: usize,
    failure: Option<String>,
}

#[pymethods]
impl Prediction {
    /// Provenance of all numbers: `"simulated"`.
    #[getter]
    fn provenance(&self) -> &'static str {
        PROVENANCE
    }

    /// Why the frames end before the path does; `None` if they reach its end, and for a press.
    #[getter]
    fn failure(&self) -> Option<&str> {
        self.failure.as_deref()
    }

    /// Location of the indenter's origin in the gel's plane, x and y, mm; `[n_frames, 2]`.
    #[getter]
    fn place_mm<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray2<f64>>> {
        let places_mm = self.prediction.place_mm.as_flattened().to_vec();
        rows(py, places_mm, [self.prediction.place_mm.len(), 2])
    }

    /// Time since the start of the press or the path, s; `[n_frames]`.
    #[getter]
    fn time_s<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<f64>> {
        PyArray1::from_slice(py, &self.prediction.time_s)
    }

    /// Depth below first touch, which is at the contact height of the recordings' test setup, mm;
    /// negative above the gel; `[n_frames]`.
    #[getter]
    fn depth_mm<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<f64>> {
        PyArray1::from_slice(py, &self.prediction.depth_mm)
    }

    /// Force of the indenter into the gel, N; `[n_frames]`.
    #[getter]
    fn force_n<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<f64>> {
        PyArray1::from_slice(py, &self.prediction.force_n)
    }

    /// Predicted readings of the barometers above those of the untouched sensor, kPa;
    /// `[n_frames, n_taxels]`.
    #[getter]
    fn readings_kpa<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray2<f64>>> {
        of_rows(py, &self.prediction.readings_kpa, self.n_taxels)
    }

    /// Whether the frame was simulated; `[n_frames]`. A frame that is deeper than the gel could be
    /// pressed in the simulation was not: it has the last simulated pressures.
    #[getter]
    fn simulated<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<bool>> {
        PyArray1::from_slice(py, &self.prediction.simulated)
    }

    /// Half width of the 90 % interval around each reading, kPa; `[n_frames, n_taxels]`. `None` for
    /// a twin without intervals.
    #[getter]
    fn half_width_kpa<'py>(&self, py: Python<'py>) -> PyResult<Option<Bound<'py, PyArray2<f64>>>> {
        let certainty = self.prediction.certainty.as_ref();
        certainty
            .map(|certainty| of_rows(py, &certainty.half_width_kpa, self.n_taxels))
            .transpose()
    }

    /// Out-of-distribution (OOD) score of the contact: its distance from the training set, without
    /// unit; `[n_frames]`. `None` for a twin without intervals.
    #[getter]
    fn ood_score<'py>(&self, py: Python<'py>) -> Option<Bound<'py, PyArray1<f64>>> {
        let certainty = self.prediction.certainty.as_ref()?;
        Some(PyArray1::from_slice(py, &certainty.ood_score))
    }

    /// Whether the contact is so far out of distribution that readings and intervals cannot be
    /// trusted; `[n_frames]`. `None` for a twin without intervals.
    #[getter]
    fn is_out_of_distribution<'py>(&self, py: Python<'py>) -> Option<Bound<'py, PyArray1<bool>>> {
        let certainty = self.prediction.certainty.as_ref()?;
        Some(PyArray1::from_slice(py, &certainty.is_out_of_distribution))
    }

    /// Draws readings with their 90 % intervals, force and depth over time with Matplotlib. The
    /// background is grey where the prediction cannot be trusted: where it was not simulated, or is
    /// out of distribution.
    ///
    /// - `axes`: three axes to draw in; new ones unless given.
    ///
    /// Returns the axes, so that they can be restyled. Raises `ModuleNotFoundError` without
    /// Matplotlib, and `Error` for another number of axes.
    #[pyo3(signature = (axes=None))]
    fn plot<'py>(result: &Bound<'py, Self>, axes: Option<Bound<'py, PyAny>>) -> PyResult<Bound<'py, PyAny>> {
        plot(result.py(), "prediction", (result, axes))
    }

    /// Supports `pickle` and `copy`: returns the function that restores the object, and its state.
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

/// A twin whose sensor is pressed at one location, stepped with depths. `Twin.at` returns it.
#[pyclass(frozen, module = "twintac")]
pub(crate) struct TwinAtPlace {
    twin: Shared<twintac::TwinAtPlace>,
    n_taxels: usize,
}

#[pymethods]
impl TwinAtPlace {
    /// Provenance of all numbers: `"simulated"`.
    #[getter]
    fn provenance(&self) -> &'static str {
        PROVENANCE
    }

    /// Computes one more frame.
    ///
    /// - `since_previous_s`: time since the last frame, s. The first frame ignores it.
    /// - `depth_mm`: depth below first touch, mm; negative above the gel.
    ///
    /// Returns the predicted readings of the barometers above their zero, kPa; `[n_taxels]`.
    ///
    /// Raises `Error` for a time below 0, and for a depth that is not finite.
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

    /// Half widths of the 90 % intervals around the last readings, kPa; `[n_taxels]`. `None` for a
    /// twin without intervals.
    #[getter]
    fn half_width_kpa<'py>(&self, py: Python<'py>) -> PyResult<Option<Bound<'py, PyArray1<f64>>>> {
        self.twin.look(py, |twin| {
            let widths = twin.half_width_kpa();
            widths.map(|widths| PyArray1::from_slice(py, widths))
        })
    }

    /// Out-of-distribution (OOD) score of the last contact, without unit, and whether the contact
    /// is so far out of distribution that readings and intervals cannot be trusted. `None` for a
    /// twin without intervals.
    #[getter]
    fn ood_score(&self, py: Python<'_>) -> PyResult<Option<(f64, bool)>> {
        self.twin.look(py, |twin| twin.ood_score())
    }

    /// Depth below first touch at which the table over depth ends, mm. At larger depths, its last
    /// pressures are used.
    #[getter]
    fn max_depth_mm(&self, py: Python<'_>) -> PyResult<f64> {
        self.twin.look(py, |twin| twin.max_depth_mm())
    }

    /// Sets the present readings to zero, as a tare of a real sensor does.
    fn tare(&self, py: Python<'_>) -> PyResult<()> {
        self.twin.look(py, twintac::TwinAtPlace::tare)
    }

    /// Resets the gel to rest until the next frame: readings no longer depend on earlier presses.
    /// The zero stays.
    fn rest(&self, py: Python<'_>) -> PyResult<()> {
        self.twin.look(py, twintac::TwinAtPlace::rest)
    }

    /// Raises `TypeError`: a `TwinAtPlace` cannot be pickled or copied.
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

/// Twins of many sensors, stepped together with the pressures at their ports. `Twin.states` returns
/// them. `len()` is the number of sensors.
#[pyclass(frozen, module = "twintac")]
pub(crate) struct TwinState {
    state: Shared<twintac::TwinState>,
    /// Numbers of sensors and taxels.
    shape: [usize; 2],
}

#[pymethods]
impl TwinState {
    /// Provenance of all numbers: `"simulated"`.
    #[getter]
    fn provenance(&self) -> &'static str {
        PROVENANCE
    }

    /// Computes one more frame of every sensor.
    ///
    /// - `since_previous_s`: time since the last frame, s. Sensors whose gel has rested ignore it.
    /// - `pressure_kpa`: pressures at the ports, kPa; `[n_sensors, n_taxels]`.
    ///
    /// Returns the predicted readings of the barometers above the zero that `tare` or
    /// `tare_untouched` has set, else above the twin's own zero, kPa; `[n_sensors, n_taxels]`.
    ///
    /// Raises `Error` for a time below 0, and for pressures of another shape or that are not
    /// finite.
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

    /// Sets the present readings to zero, as a tare of a real sensor does.
    fn tare(&self, py: Python<'_>) -> PyResult<()> {
        self.state.look(py, twintac::TwinState::tare)
    }

    /// Sets the readings of an untouched sensor to zero.
    fn tare_untouched(&self, py: Python<'_>) -> PyResult<()> {
        self.state.look(py, twintac::TwinState::tare_untouched)
    }

    /// Resets the gel of one sensor to rest until its next frame: readings no longer depend on
    /// earlier presses. The zero stays.
    ///
    /// - `sensor`: index of the sensor, from 0.
    ///
    /// Raises `Error` for an index out of range.
    fn rest(&self, py: Python<'_>, sensor: Given<'_>) -> PyResult<()> {
        let sensor = sensor.count("sensor", 0..=self.shape[0] - 1)?;
        self.state.look(py, |state| state.rest(sensor))
    }

    /// Raises `TypeError`: a `TwinState` cannot be pickled or copied.
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
