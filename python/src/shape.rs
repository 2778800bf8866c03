//! Rigid shapes.

use std::path::PathBuf;
use std::sync::Arc;

use pyo3::prelude::*;
use twintac::{Part, Surfaces, TriangleSurface};

use crate::error::{OrRaise, unreadable};
use crate::long_call::long_call;
use crate::pose::Pose;

/// A rigid shape that presses. `edge_radius_mm` rounds every convex edge without moving any face. Prismatic shapes have their profile in the xy
/// plane and stand on z = 0.
#[pyclass(frozen, from_py_object, module = "twintac")]
#[derive(Clone)]
pub(crate) struct Shape {
    pub(crate) shape: twintac::Shape,
    /// What the STL files that it names have.
    pub(crate) surfaces: Surfaces,
}

impl Shape {
    fn of(py: Python<'_>, shape: twintac::Shape, surfaces: Surfaces) -> PyResult<Self> {
        shape.validate().or_raise(py)?;
        Ok(Self { shape, surfaces })
    }
}

#[pymethods]
impl Shape {
    /// A ball that stands on its origin.
    #[staticmethod]
    fn sphere(py: Python<'_>, radius_mm: f64) -> PyResult<Self> {
        Self::of(py, twintac::Shape::Sphere { radius_mm }, Surfaces::new())
    }

    /// A flat-ended upright cylinder.
    #[staticmethod]
    fn cylinder(py: Python<'_>, radius_mm: f64, height_mm: f64, edge_radius_mm: f64) -> PyResult<Self> {
        let shape = twintac::Shape::Cylinder {
            radius_mm,
            height_mm,
            edge_radius_mm,
        };
        Self::of(py, shape, Surfaces::new())
    }

    /// A box of this full size along x, y and z.
    #[staticmethod]
    fn r#box(py: Python<'_>, size_mm: [f64; 3], edge_radius_mm: f64) -> PyResult<Self> {
        let shape = twintac::Shape::Box {
            size_mm,
            edge_radius_mm,
        };
        Self::of(py, shape, Surfaces::new())
    }

    /// Two crossed bars in the shape of an X.
    #[staticmethod]
    fn x(
        py: Python<'_>,
        length_mm: f64,
        width_mm: f64,
        height_mm: f64,
        edge_radius_mm: f64,
    ) -> PyResult<Self> {
        let shape = twintac::Shape::X {
            length_mm,
            width_mm,
            height_mm,
            edge_radius_mm,
        };
        Self::of(py, shape, Surfaces::new())
    }

    /// An upright tube.
    #[staticmethod]
    fn ring(
        py: Python<'_>,
        outer_radius_mm: f64,
        inner_radius_mm: f64,
        height_mm: f64,
        edge_radius_mm: f64,
    ) -> PyResult<Self> {
        let shape = twintac::Shape::Ring {
            outer_radius_mm,
            inner_radius_mm,
            height_mm,
            edge_radius_mm,
        };
        Self::of(py, shape, Surfaces::new())
    }

    /// An upright equilateral prism, centroid at the origin, one corner towards +x.
    #[staticmethod]
    fn triangle(py: Python<'_>, side_mm: f64, height_mm: f64, edge_radius_mm: f64) -> PyResult<Self> {
        let shape = twintac::Shape::Triangle {
            side_mm,
            height_mm,
            edge_radius_mm,
        };
        Self::of(py, shape, Surfaces::new())
    }

    /// A roof-shaped wedge that touches with its ridge, which lies along y.
    #[staticmethod]
    fn wedge(
        py: Python<'_>,
        angle_rad: f64,
        length_mm: f64,
        height_mm: f64,
        edge_radius_mm: f64,
    ) -> PyResult<Self> {
        let shape = twintac::Shape::Wedge {
            angle_rad,
            length_mm,
            height_mm,
            edge_radius_mm,
        };
        Self::of(py, shape, Surfaces::new())
    }

    /// A closed triangle surface in an STL file, in mm; its lowest point is moved to the origin's z.
    #[staticmethod]
    fn stl(py: Python<'_>, path: PathBuf) -> PyResult<Self> {
        let bytes = std::fs::read(&path).map_err(|error| unreadable(py, &path, &error))?;
        let surface = TriangleSurface::from_stl(&bytes).map_err(|error| unreadable(py, &path, &error))?;
        let path = path.display().to_string();
        let surfaces = Surfaces::from([(path.clone(), Arc::new(surface))]);
        Self::of(py, twintac::Shape::Stl { path }, surfaces)
    }

    /// Several shapes held together, each where its pose in the whole says; they may overlap.
    #[staticmethod]
    fn union(py: Python<'_>, parts: Vec<(Self, Pose)>) -> PyResult<Self> {
        let surfaces = parts
            .iter()
            .flat_map(|(shape, _)| shape.surfaces.clone())
            .collect();
        let part = |(shape, pose): (Self, Pose)| Part {
            shape: shape.shape,
            whole_from_part: pose.pose,
        };
        let parts = parts.into_iter().map(part).collect();
        Self::of(py, twintac::Shape::Union { parts }, surfaces)
    }

    fn __repr__(&self) -> String {
        format!("<Shape {:?}>", self.shape)
    }
}

/// A shape whose distances are known at once: for the fast gel.
#[pyclass(frozen, from_py_object, module = "twintac")]
#[derive(Clone)]
pub(crate) struct Body {
    pub(crate) body: Arc<twintac::Body>,
}

#[pymethods]
impl Body {
    /// Samples a shape, which takes from a millisecond to a second for a surface of many triangles.
    #[new]
    fn new(py: Python<'_>, shape: Shape) -> PyResult<Self> {
        let body = long_call(py, move || twintac::Body::new(&shape.shape, &shape.surfaces))?.or_raise(py)?;
        Ok(Self { body: Arc::new(body) })
    }
}
