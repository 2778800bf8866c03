//! The gel without finite elements.

use std::path::PathBuf;
use std::sync::Arc;

use numpy::ndarray::Ix2;
use numpy::{PyArray1, PyArray2};
use pyo3::prelude::*;

use crate::array::{Numbers, rows};
use crate::error::{OrRaise, unreadable};
use crate::pose::Pose;
use crate::sensor::Sensor;
use crate::shape::Body;
use crate::touches::{Counts, Touches, bodies};

/// What every reading of a fast gel is.
pub(crate) const PROVENANCE: &str = "simulated";

/// Pressures at the ports and wrenches of many sensors.
pub(crate) type Answers<'py> = (Bound<'py, PyArray2<f32>>, Bound<'py, PyArray2<f32>>);

/// A sensor's gel without finite elements: microseconds a reading, of bodies of any shape.
///
/// `FastGel.phystac()` and `FastGel.phystac_tip()` are built in; `twintac fast train` makes that of another sensor, which `FastGel.load` reads. It does not relax; `Friction` adds friction.
#[pyclass(frozen, from_py_object, module = "twintac")]
#[derive(Clone)]
pub(crate) struct FastGel {
    pub(crate) gel: Arc<twintac::FastGel>,
}

#[pymethods]
impl FastGel {
    /// The fast gel of PhysTac, which is built in.
    #[staticmethod]
    fn phystac(py: Python<'_>) -> PyResult<Self> {
        let gel = py.detach(twintac::FastGel::phystac).or_raise(py)?;
        Ok(Self { gel: Arc::new(gel) })
    }

    /// The fast gel of PhysTac's fingertip, which is built in.
    #[staticmethod]
    fn phystac_tip(py: Python<'_>) -> PyResult<Self> {
        let gel = py.detach(twintac::FastGel::phystac_tip).or_raise(py)?;
        Ok(Self { gel: Arc::new(gel) })
    }

    /// Reads a file that `twintac fast train` has made.
    ///
    /// Raises `Error` with the file if it is none, or cannot be read.
    #[staticmethod]
    fn load(py: Python<'_>, path: PathBuf) -> PyResult<Self> {
        let bytes = std::fs::read(&path).map_err(|error| unreadable(py, &path, &error))?;
        let gel = py.detach(|| twintac::FastGel::from_bytes(&bytes));
        let gel = gel.map_err(|error| unreadable(py, &path, &error))?;
        Ok(Self { gel: Arc::new(gel) })
    }

    /// Name of the sensor whose gel it is.
    #[getter]
    fn sensor(&self) -> &str {
        self.gel.sensor()
    }

    /// Refuses a sensor whose gel it is not: whose shape, material, shell or ports are others.
    /// Names do not count, nor do indenters, limits and the read-out.
    ///
    /// Raises `Error`, which says all that differs.
    fn check(&self, py: Python<'_>, sensor: &Sensor) -> PyResult<()> {
        self.gel.check(&sensor.sensor.file().sensor).or_raise(py)
    }

    /// Where the ports are in the gel's plane, mm; `[n_taxels, 2]`.
    #[getter]
    fn ports_mm<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray2<f64>>> {
        let ports = self.gel.ports_mm();
        rows(
            py,
            ports.iter().flat_map(|place| place.to_array()).collect(),
            [ports.len(), 2],
        )
    }

    /// The same gel with its ports at other places of the floor, x and y, mm, `[n_ports, 2]`: finer than taxels are.
    ///
    /// Raises `Error` for an array of another shape.
    fn with_ports(&self, py: Python<'_>, places_mm: Numbers<'_, Ix2>) -> PyResult<Self> {
        if places_mm.as_array().ncols() != 2 {
            return Err(crate::error::unusable(
                py,
                "places_mm",
                "has another shape than [n_ports, 2]",
            ));
        }
        let places: Vec<glam::DVec2> = places_mm
            .as_array()
            .rows()
            .into_iter()
            .map(|row| [row[0], row[1]].into())
            .collect();
        Ok(Self {
            gel: Arc::new(self.gel.with_ports(&places)),
        })
    }

    /// Prepares one sensor to be read. Each thread needs a reader of its own.
    fn reader(&self, py: Python<'_>) -> FastReader {
        FastReader {
            reader: py.detach(|| self.gel.reader()),
        }
    }

    /// Prepares many sensors to be read in one call, which these bodies touch. It uses all cores, or `n_threads`.
    ///
    /// Raises `Error` if there is no body.
    #[pyo3(signature = (bodies, n_threads=None))]
    fn batch(&self, py: Python<'_>, bodies: Vec<Body>, n_threads: Option<usize>) -> PyResult<FastBatch> {
        let bodies = self::bodies(py, bodies)?;
        let n_threads = n_threads.unwrap_or_else(n_cores);
        Ok(FastBatch {
            batch: py.detach(|| self.gel.batch(n_threads)),
            n_taxels: self.gel.n_taxels(),
            bodies,
        })
    }
}

/// Threads unless another number is asked for.
pub(crate) fn n_cores() -> usize {
    std::thread::available_parallelism().map_or(1, usize::from)
}

/// A fast gel of one sensor, ready to be read: what `FastGel.reader` returns.
#[pyclass(module = "twintac")]
pub(crate) struct FastReader {
    reader: twintac::FastReader,
}

#[pymethods]
impl FastReader {
    /// What every reading is: simulated.
    #[getter]
    fn provenance(&self) -> &'static str {
        PROVENANCE
    }

    /// What the gel does under bodies at these poses in its frame (`gel_from_body`). Returns the pressure at each port, kPa, `[n_taxels]`; and force on the gel, N,
    /// and torque about the top of its middle, N mm, `[6]`.
    fn read<'py>(&mut self, py: Python<'py>, bodies: Vec<(Body, Pose)>) -> Reading<'py> {
        self.answer(py, |reader, pressure_kpa, wrench| {
            reader.read(&placed(&bodies), pressure_kpa, wrench);
        })
    }

    /// How unlike what was taught a contact is, without unit: 0 where nothing is near the gel;
    /// above 1 readings and force may be wrong: its shape is new, it is deeper than lessons
    /// pressed, or too few pressed there.
    fn novelty(&mut self, py: Python<'_>, bodies: Vec<(Body, Pose)>) -> f32 {
        py.detach(|| self.reader.novelty(&placed(&bodies)))
    }
}

impl FastReader {
    /// What it reads with.
    pub(crate) fn reader(&self) -> &twintac::FastReader {
        &self.reader
    }

    /// What a reading of this gel gives.
    pub(crate) fn answer<'py>(
        &mut self,
        py: Python<'py>,
        read: impl FnOnce(&mut twintac::FastReader, &mut [f32], &mut [f32; 6]) + Send,
    ) -> Reading<'py> {
        let (mut pressure_kpa, mut wrench) = (vec![0.0; self.reader.n_taxels()], [0.0; 6]);
        py.detach(|| read(&mut self.reader, &mut pressure_kpa, &mut wrench));
        (
            PyArray1::from_vec(py, pressure_kpa),
            PyArray1::from_slice(py, &wrench),
        )
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

/// Fast gels of many sensors of one kind, read in one call: what `FastGel.batch` returns.
#[pyclass(module = "twintac")]
pub(crate) struct FastBatch {
    batch: twintac::FastBatch,
    bodies: Vec<twintac::Body>,
    n_taxels: usize,
}

#[pymethods]
impl FastBatch {
    /// What every reading is: simulated.
    #[getter]
    fn provenance(&self) -> &'static str {
        PROVENANCE
    }

    /// What the gels do under what touches each of them. A sensor's numbers do not depend on the others.
    ///
    /// `gel_from_body` has a row for each touch, the first sensor's first: place in mm and quaternion (x, y, z, w), or the place alone. `body` has
    /// the numbers of the bodies, the first body unless given. `ends` says where each sensor's touches end; unless given, each has one.
    ///
    /// Returns pressures at the ports, kPa, `[n_sensors, n_taxels]`, and force on each gel, N, and torque about the top of its middle, N mm, `[n_sensors, 6]`.
    ///
    /// Raises `Error`, whose `field` is the array that has another shape, or numbers that cannot be.
    #[pyo3(signature = (gel_from_body, body=None, ends=None))]
    fn read<'py>(
        &mut self,
        py: Python<'py>,
        gel_from_body: Numbers<'_, Ix2>,
        body: Option<Counts<'_>>,
        ends: Option<Counts<'_>>,
    ) -> PyResult<Answers<'py>> {
        let Touches { touches, ends } = Touches::checked(
            py,
            &gel_from_body,
            body.as_ref(),
            ends.as_ref(),
            self.bodies.len(),
        )?;
        let n_sensors = ends.len();
        let mut pressure_kpa = vec![0.0; n_sensors * self.n_taxels];
        let mut wrench = vec![[0.0; 6]; n_sensors];
        py.detach(|| {
            self.batch
                .read(&self.bodies, &touches, &ends, &mut pressure_kpa, &mut wrench)
        });
        Ok((
            rows(py, pressure_kpa, [n_sensors, self.n_taxels])?,
            rows(py, wrench.into_flattened(), [n_sensors, 6])?,
        ))
    }
}
