//! The surrogate of a gel (the gel without finite elements).

use std::path::PathBuf;
use std::sync::Arc;

use numpy::{PyArray1, PyArray2};
use pyo3::prelude::*;
use pyo3::types::PyBytes;

use crate::array::rows;
use crate::error::{OrRaise, unreadable, unusable};
use crate::given::{Array, Given, threads};
use crate::pickle::{Kept, Reduced, reduced, refused};
use crate::pool::in_parallel;
use crate::pose::Pose;
use crate::sensor::Sensor;
use crate::shape::Body;
use crate::shared::Shared;
use crate::touches::{Touches, bodies};

/// Provenance of every reading of a surrogate.
pub(crate) const PROVENANCE: &str = "simulated";

/// Most ports of a gel.
const MOST_PORTS: usize = 1_000_000;

/// Most pressures of one call; they take a gigabyte.
const MOST_PRESSURES: usize = 250_000_000;

/// Pressures at the ports and wrenches of many sensors.
pub(crate) type Answers<'py> = (Bound<'py, PyArray2<f32>>, Bound<'py, PyArray2<f32>>);

/// The surrogate of a sensor's gel: neural networks instead of finite elements. A reading takes
/// microseconds. The gel may be touched by bodies of any shape.
///
/// `FastGel.phystac()` and `FastGel.phystac_tip()` are built in. `twintac fast train` makes the
/// surrogate of another sensor, and `FastGel.load` reads it. A surrogate has no viscoelastic
/// relaxation. It has no friction either, which `Friction` adds.
#[pyclass(frozen, from_py_object, module = "twintac")]
#[derive(Clone)]
pub(crate) struct FastGel {
    pub(crate) gel: Arc<twintac::FastGel>,
}

#[pymethods]
impl FastGel {
    /// The surrogate of PhysTac's gel, which is built in.
    #[staticmethod]
    fn phystac(py: Python<'_>) -> PyResult<Self> {
        let gel = py.detach(twintac::FastGel::phystac).or_raise(py)?;
        Ok(Self { gel: Arc::new(gel) })
    }

    /// The surrogate of the gel of PhysTac's fingertip, which is built in.
    #[staticmethod]
    fn phystac_tip(py: Python<'_>) -> PyResult<Self> {
        let gel = py.detach(twintac::FastGel::phystac_tip).or_raise(py)?;
        Ok(Self { gel: Arc::new(gel) })
    }

    /// Reads a surrogate from a file that `twintac fast train` has made.
    ///
    /// Raises `Error` with the file if it is not a surrogate, or cannot be read.
    #[staticmethod]
    fn load(py: Python<'_>, path: PathBuf) -> PyResult<Self> {
        let bytes = std::fs::read(&path).map_err(|error| unreadable(py, &path, &error))?;
        let gel = py.detach(|| twintac::FastGel::from_bytes(&bytes));
        let gel = gel.map_err(|error| unreadable(py, &path, &error))?;
        Ok(Self { gel: Arc::new(gel) })
    }

    /// The surrogate as the bytes of a file that `load` reads:
    /// `Path("gel.safetensors").write_bytes(gel.to_bytes())`.
    fn to_bytes<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyBytes>> {
        let bytes = py.detach(|| self.gel.to_bytes()).or_raise(py)?;
        Ok(PyBytes::new(py, &bytes))
    }

    /// Name of the sensor that the surrogate was trained for.
    #[getter]
    fn sensor(&self) -> &str {
        self.gel.sensor()
    }

    /// Checks that this is the surrogate of a sensor's gel: shape, material, shell and ports must
    /// be the same. Names, indenters, limits, the read-out, relaxation and friction may differ.
    ///
    /// Raises `Error` for another gel. The message says all that differs.
    fn check(&self, py: Python<'_>, sensor: &Sensor) -> PyResult<()> {
        self.gel.check(&sensor.sensor.file().sensor).or_raise(py)
    }

    /// Locations of the ports in the gel's plane, mm; `[n_taxels, 2]`.
    #[getter]
    fn ports_mm<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray2<f64>>> {
        let ports = self.gel.ports_mm();
        rows(
            py,
            ports.iter().flat_map(|place| place.to_array()).collect(),
            [ports.len(), 2],
        )
    }

    /// The same surrogate with its ports at other locations, for example closer together than the
    /// taxels.
    ///
    /// - `places_mm`: locations on the base of the gel, x and y, mm; `[n_ports, 2]`. A port has to
    ///   be within the gel there. With boxes cast into the gel, the taxels are the only locations.
    ///
    /// Raises `Error` for an array of another shape, for no location or more than a million, and
    /// for a location where the surrogate was not trained.
    fn with_ports(&self, py: Python<'_>, places_mm: Given<'_>) -> PyResult<Self> {
        let expected = "[n_ports, 2], mm";
        let refused = |problem: String| unusable(py, "places_mm", &format!("{problem}, expected {expected}"));
        let places_mm: Array<2> = places_mm.numbers("places_mm", expected)?;
        let [n_ports, n_columns] = places_mm.shape;
        if n_columns != 2 || !(1..=MOST_PORTS).contains(&n_ports) {
            let problem = format!("has the shape {:?}", places_mm.shape);
            return Err(refused(format!("{problem}, at most {MOST_PORTS} ports")));
        }
        let places: Vec<glam::DVec2> = places_mm.rows().map(|row| [row[0], row[1]].into()).collect();
        let moved = self.gel.with_ports(&places);
        let moved = moved.map_err(|error| unusable(py, "places_mm", &error.to_string()))?;
        Ok(Self { gel: Arc::new(moved) })
    }

    /// Returns a reader for one sensor. Each thread needs its own reader.
    fn reader(&self, py: Python<'_>) -> FastReader {
        let reader = py.detach(|| self.gel.reader());
        FastReader {
            n_taxels: reader.n_taxels(),
            reader: Shared::new(reader),
        }
    }

    /// Returns a reader for many sensors in one call.
    ///
    /// - `bodies`: the bodies that may touch the sensors, at least one.
    /// - `n_threads`: number of threads, 1 to 1024; as many as there are cores unless given.
    ///
    /// Raises `Error` if there is no body, and for a number of threads out of this range.
    #[pyo3(signature = (bodies, n_threads=None))]
    fn batch(&self, py: Python<'_>, bodies: Vec<Body>, n_threads: Option<Given<'_>>) -> PyResult<FastBatch> {
        let bodies = self::bodies(py, bodies)?;
        let n_threads = threads(n_threads)?;
        Ok(FastBatch {
            batch: Shared::new(py.detach(|| self.gel.batch(n_threads))),
            n_taxels: self.gel.n_taxels(),
            n_threads,
            bodies,
        })
    }

    /// Supports `pickle` and `copy`: returns the function that restores the object, and its state.
    fn __reduce__<'py>(&self, py: Python<'py>) -> PyResult<Reduced<'py>> {
        reduced(py, self)
    }

    fn __repr__(&self) -> String {
        format!(
            "<FastGel of {:?} with {} ports>",
            self.gel.sensor(),
            self.gel.n_taxels()
        )
    }
}

impl Kept for FastGel {
    /// The bytes of its file.
    type State = Vec<u8>;

    fn state(&self, py: Python<'_>) -> PyResult<Vec<u8>> {
        self.gel.to_bytes().or_raise(py)
    }

    fn restored(py: Python<'_>, bytes: Vec<u8>) -> PyResult<Self> {
        let gel = twintac::FastGel::from_bytes(&bytes).or_raise(py)?;
        Ok(Self { gel: Arc::new(gel) })
    }
}

/// Evaluates the surrogate for one sensor. `FastGel.reader` returns it.
#[pyclass(frozen, module = "twintac")]
pub(crate) struct FastReader {
    reader: Shared<twintac::FastReader>,
    n_taxels: usize,
}

#[pymethods]
impl FastReader {
    /// Provenance of all numbers: `"simulated"`.
    #[getter]
    fn provenance(&self) -> &'static str {
        PROVENANCE
    }

    /// Computes the pressures at the ports, and force and torque on the gel, under bodies.
    ///
    /// - `bodies`: each body with its pose in the gel's frame (`gel_from_body`).
    ///
    /// Returns the pressure at each port, kPa, `[n_taxels]`, and the wrench, `[6]`: force on the
    /// gel, N, and torque about the centre of the top of the gel's bounding box, N mm.
    fn read<'py>(&self, py: Python<'py>, bodies: Vec<(Body, Pose)>) -> PyResult<Reading<'py>> {
        self.answer(py, |reader, pressure_kpa, wrench| {
            reader.read(&placed(&bodies), pressure_kpa, wrench);
        })
    }

    /// The out-of-distribution (OOD) score of a contact, without unit. It is 0 if nothing is near
    /// the gel. Above 1, readings and force may be wrong: the shape is unlike those of the training
    /// set, the contact is deeper than the training presses, or too few training presses were
    /// there.
    ///
    /// - `bodies`: each body with its pose in the gel's frame (`gel_from_body`).
    fn ood_score(&self, py: Python<'_>, bodies: Vec<(Body, Pose)>) -> PyResult<f32> {
        self.reader.work(py, |reader| reader.ood_score(&placed(&bodies)))
    }

    /// Raises `TypeError`: a `FastReader` cannot be pickled or copied.
    fn __reduce__(&self) -> PyResult<()> {
        refused(
            "FastReader",
            "pickle the FastGel, and take a reader of it in each process, with FastGel.reader",
        )
    }

    fn __repr__(&self) -> String {
        format!("<FastReader of {} ports, {PROVENANCE}>", self.n_taxels)
    }
}

impl FastReader {
    /// The library's reader.
    pub(crate) fn reader(&self) -> &Shared<twintac::FastReader> {
        &self.reader
    }

    /// The arrays of one reading.
    pub(crate) fn answer<'py>(
        &self,
        py: Python<'py>,
        read: impl FnOnce(&mut twintac::FastReader, &mut [f32], &mut [f32; 6]) + Send,
    ) -> PyResult<Reading<'py>> {
        let (mut pressure_kpa, mut wrench) = (vec![0.0; self.n_taxels], [0.0; 6]);
        self.reader
            .work(py, |reader| read(reader, &mut pressure_kpa, &mut wrench))?;
        Ok((
            PyArray1::from_vec(py, pressure_kpa),
            PyArray1::from_slice(py, &wrench),
        ))
    }
}

fn placed(bodies: &[(Body, Pose)]) -> Vec<(&twintac::Body, twintac::Pose)> {
    bodies
        .iter()
        .map(|(body, pose)| (&*body.body, pose.pose))
        .collect()
}

/// Pressures at the ports, kPa, and force and torque, N and N mm.
pub(crate) type Reading<'py> = (Bound<'py, PyArray1<f32>>, Bound<'py, PyArray1<f32>>);

/// Evaluates the surrogate for many sensors of one kind in one call. `FastGel.batch` returns it.
#[pyclass(frozen, module = "twintac")]
pub(crate) struct FastBatch {
    batch: Shared<twintac::FastBatch>,
    bodies: Vec<twintac::Body>,
    n_taxels: usize,
    n_threads: usize,
}

#[pymethods]
impl FastBatch {
    /// Provenance of all numbers: `"simulated"`.
    #[getter]
    fn provenance(&self) -> &'static str {
        PROVENANCE
    }

    /// Computes the pressures at the ports, and force and torque on each gel, under the bodies that
    /// touch it. The numbers of a sensor do not depend on the other sensors.
    ///
    /// - `gel_from_body`: poses of the bodies in the gel's frame, one row for each touch, those of
    ///   the first sensor first: position, mm, and quaternion (x, y, z, w), `[n_touches, 7]`; or
    ///   the position alone, `[n_touches, 3]`.
    /// - `body`: indices of the bodies, `[n_touches]`; the first body unless given.
    /// - `ends`: the end of each sensor's touches in the list, `[n_sensors]`; one touch for each
    ///   sensor unless given.
    ///
    /// Returns the pressures at the ports, kPa, `[n_sensors, n_taxels]`, and the wrenches,
    /// `[n_sensors, 6]`: force on each gel, N, and torque about the centre of the top of its
    /// bounding box, N mm.
    ///
    /// Raises `Error` for an array with another shape or with numbers that are not allowed; its
    /// `field` names the array.
    #[pyo3(signature = (gel_from_body, body=None, ends=None))]
    fn read<'py>(
        &self,
        py: Python<'py>,
        gel_from_body: Given<'_>,
        body: Option<Given<'_>>,
        ends: Option<Given<'_>>,
    ) -> PyResult<Answers<'py>> {
        let Touches { touches, ends } = Touches::checked(
            py,
            &gel_from_body,
            body.as_ref(),
            ends.as_ref(),
            self.bodies.len(),
        )?;
        let n_sensors = ends.len();
        let most = MOST_PRESSURES / self.n_taxels;
        if n_sensors > most {
            let problem = format!(
                "makes {n_sensors} sensors of {} ports, expected at most {most}",
                self.n_taxels
            );
            return Err(unusable(py, "ends", &problem));
        }
        let mut pressure_kpa = vec![0.0; n_sensors * self.n_taxels];
        let mut wrench = vec![[0.0; 6]; n_sensors];
        self.batch.work(py, |batch| {
            let (pressure_kpa, wrench) = (&mut pressure_kpa[..], &mut wrench[..]);
            let mut read = || batch.read(&self.bodies, &touches, &ends, pressure_kpa, wrench);
            // A single thread needs no pool.
            if self.n_threads > 1 {
                in_parallel(read)
            } else {
                read()
            }
        })?;
        Ok((
            rows(py, pressure_kpa, [n_sensors, self.n_taxels])?,
            rows(py, wrench.into_flattened(), [n_sensors, 6])?,
        ))
    }
    /// Raises `TypeError`: a `FastBatch` cannot be pickled or copied.
    fn __reduce__(&self) -> PyResult<()> {
        refused(
            "FastBatch",
            "pickle the FastGel and the bodies, and make one in each process, with FastGel.batch",
        )
    }

    fn __repr__(&self) -> String {
        let (n_bodies, n_taxels) = (self.bodies.len(), self.n_taxels);
        format!("<FastBatch of {n_taxels} ports, {n_bodies} bodies, {PROVENANCE}>")
    }
}
