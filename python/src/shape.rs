//! Rigid shapes.

use std::collections::BTreeMap;
use std::hash::{DefaultHasher, Hash, Hasher};
use std::path::PathBuf;
use std::sync::Arc;

use glam::DVec3;
use numpy::{PyArray1, PyArray2};
use pyo3::prelude::*;
use twintac::{LengthUnit, Part, SignedDistance, SurfaceFile, Surfaces, TriangleSurface};

use crate::array::rows;
use crate::error::{OrRaise, unreadable, unusable};
use crate::given::{Array, Given};
use crate::long_call::long_call;
use crate::pickle::{Kept, Reduced, reduced};
use crate::pose::Pose;

/// Smallest size of a surface along each axis, mm.
const SMALLEST_MM: f64 = 0.1;

/// A rigid shape that presses the gel. `edge_radius_mm` rounds every convex edge and moves no face.
/// Prismatic shapes have their profile in the xy plane and stand on z = 0. All lengths are in mm.
///
/// Each function that makes a shape raises `Error` for a length that is not allowed; its `field`
/// names the length.
#[pyclass(frozen, from_py_object, module = "twintac")]
#[derive(Clone)]
pub(crate) struct Shape {
    pub(crate) shape: twintac::Shape,
    /// The surfaces of the STL files that it names.
    pub(crate) surfaces: Surfaces,
}

impl Shape {
    fn of(py: Python<'_>, shape: twintac::Shape, surfaces: Surfaces) -> PyResult<Self> {
        shape.validate().or_raise(py)?;
        Ok(Self { shape, surfaces })
    }

    /// The signed distance field of the shape.
    fn distances(&self, py: Python<'_>) -> PyResult<Box<dyn SignedDistance>> {
        self.shape.signed_distance_field(&self.surfaces).or_raise(py)
    }

    /// A surface at its own position. A shape from a file would be moved so that its lowest point
    /// is at z = 0.
    fn of_surface(py: Python<'_>, surface: TriangleSurface) -> PyResult<Self> {
        let mut hasher = DefaultHasher::new();
        let corners_mm = surface.vertices_mm().iter().map(|corner| corner.to_array());
        for number in corners_mm.flatten() {
            number.to_bits().hash(&mut hasher);
        }
        surface.triangles().hash(&mut hasher);
        let path = format!("surface {:016x}", hasher.finish());
        let lowest_mm = surface.vertices_mm().iter().map(|corner| corner.z);
        let lowest_mm = lowest_mm.fold(f64::INFINITY, f64::min);
        let part = Part {
            shape: twintac::Shape::Stl(SurfaceFile::new(path.clone())),
            whole_from_part: twintac::Pose::from_position(lowest_mm * DVec3::Z),
        };
        let surfaces = Surfaces::from([(path, Arc::new(surface))]);
        Self::of(py, twintac::Shape::Union { parts: vec![part] }, surfaces)
    }
}

#[pymethods]
impl Shape {
    /// A ball that stands on its origin: its centre is `radius_mm` above the origin.
    #[staticmethod]
    fn sphere(py: Python<'_>, radius_mm: f64) -> PyResult<Self> {
        Self::of(py, twintac::Shape::Sphere { radius_mm }, Surfaces::new())
    }

    /// A flat-ended upright cylinder. Its rims are rounded with `edge_radius_mm`.
    #[staticmethod]
    fn cylinder(py: Python<'_>, radius_mm: f64, height_mm: f64, edge_radius_mm: f64) -> PyResult<Self> {
        let shape = twintac::Shape::Cylinder {
            radius_mm,
            height_mm,
            edge_radius_mm,
        };
        Self::of(py, shape, Surfaces::new())
    }

    /// A box with the full size `size_mm` along x, y and z, mm. Its edges are rounded with
    /// `edge_radius_mm`.
    #[staticmethod]
    fn r#box(py: Python<'_>, size_mm: Given<'_>, edge_radius_mm: f64) -> PyResult<Self> {
        let shape = twintac::Shape::Box {
            size_mm: size_mm.few("size_mm", ", mm")?,
            edge_radius_mm,
        };
        Self::of(py, shape, Surfaces::new())
    }

    /// Two crossed bars in the shape of an X (a plus, rotated by 45°). Each bar is `length_mm` long
    /// and `width_mm` wide.
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

    /// An upright equilateral prism, with its centroid at the origin and one corner towards +x.
    #[staticmethod]
    fn triangle(py: Python<'_>, side_mm: f64, height_mm: f64, edge_radius_mm: f64) -> PyResult<Self> {
        let shape = twintac::Shape::Triangle {
            side_mm,
            height_mm,
            edge_radius_mm,
        };
        Self::of(py, shape, Surfaces::new())
    }

    /// A wedge like a roof upside down. It touches with its ridge, which lies along y. `angle_rad`
    /// is the full angle between its two faces, `length_mm` the length of the ridge, and
    /// `height_mm` the height from the ridge to the base.
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

    /// A closed triangle surface from an STL file. Its lowest point is moved to the height of the
    /// origin.
    ///
    /// - `path`: path of the file.
    /// - `unit`: unit of lengths in the file: `"mm"`, `"cm"`, `"m"` or `"inch"`; mm unless given.
    /// - `scale`: the length in mm of 1 in the file, instead of a `unit`.
    ///
    /// Raises `Error` with the file if it cannot be read, if its surface is not closed, or if its
    /// size is impossible in that unit.
    #[staticmethod]
    #[pyo3(signature = (path, *, unit=None, scale=None))]
    fn stl(py: Python<'_>, path: PathBuf, unit: Option<&str>, scale: Option<f64>) -> PyResult<Self> {
        let named = |unit: &str| {
            let known = unit.parse::<LengthUnit>();
            known.map_err(|problem| unusable(py, "unit", &format!("is `{unit}`, {problem}")))
        };
        let file = SurfaceFile {
            path: path.display().to_string(),
            unit: unit.map(named).transpose()?,
            scale,
        };
        file.validate().or_raise(py)?;
        let bytes = std::fs::read(&path).map_err(|error| unreadable(py, &path, &error))?;
        let surface = TriangleSurface::from_stl(&bytes, file.mm_per_unit());
        let surface = surface.map_err(|error| unreadable(py, &path, &error))?;
        let surfaces = Surfaces::from([(file.name().into_owned(), Arc::new(surface))]);
        Self::of(py, twintac::Shape::Stl(file), surfaces)
    }

    /// A closed surface of triangles, which keeps its position.
    ///
    /// - `vertices_mm`: positions of the vertices, mm; `[n_vertices, 3]`.
    /// - `triangles`: indices of the three vertices of each triangle, counter-clockwise seen from
    ///   outside; `[n_triangles, 3]`.
    ///
    /// Raises `Error` for arrays of another shape, for an index without a vertex, for a surface
    /// that is not closed, and for one of less than 0.1 mm along an axis, as lengths in metres make
    /// it.
    #[staticmethod]
    fn surface(py: Python<'_>, vertices_mm: Given<'_>, triangles: Given<'_>) -> PyResult<Self> {
        let vertices_mm: Array<2> = vertices_mm.numbers("vertices_mm", "[n_vertices, 3], mm")?;
        let (shape, triangles) = triangles.integers::<2>("triangles", "[n_triangles, 3]")?;
        let [n_vertices, _] = vertices_mm.shape;
        for (name, [_, n_columns]) in [("vertices_mm", vertices_mm.shape), ("triangles", shape)] {
            if n_columns != 3 {
                let problem = format!("has {n_columns} columns, expected 3");
                return Err(unusable(py, name, &problem));
            }
        }
        let corner = |number: i64| {
            let row = usize::try_from(number).ok().filter(|row| *row < n_vertices);
            let row = row.ok_or_else(|| {
                let n = n_vertices;
                unusable(
                    py,
                    "triangles",
                    &format!("has a corner {number}, expected 0 to {}", n.saturating_sub(1)),
                )
            })?;
            PyResult::Ok(DVec3::from_slice(&vertices_mm.values[3 * row..][..3]))
        };
        let triangle = |row: &[i64]| Ok([corner(row[0])?, corner(row[1])?, corner(row[2])?]);
        let triangles = triangles.chunks_exact(3).map(triangle);
        let triangles = triangles.collect::<PyResult<Vec<[DVec3; 3]>>>()?;
        let surface = TriangleSurface::from_triangles(&triangles);
        let surface = surface.map_err(|error| unusable(py, "triangles", &error.to_string()))?;
        let corners = surface.vertices_mm().iter();
        let high_mm = corners
            .clone()
            .fold(DVec3::NEG_INFINITY, |high, at| high.max(*at));
        let size_mm = high_mm - corners.fold(DVec3::INFINITY, |low, at| low.min(*at));
        if size_mm.min_element() < SMALLEST_MM * (1.0 - 1e-6) {
            let [x, y, z] = size_mm.to_array();
            let problem = format!(
                "make a surface of {x:.3e} × {y:.3e} × {z:.3e} mm, expected {SMALLEST_MM} mm or more along each \
                 axis; if they are in metres, multiply them by 1000"
            );
            return Err(unusable(py, "vertices_mm", &problem));
        }
        Self::of_surface(py, surface)
    }

    /// Several shapes, joined rigidly. They may overlap.
    ///
    /// - `parts`: each shape with its pose in the frame of the whole.
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

    /// Lowest and highest corner of the smallest box along the shape's axes that contains the
    /// shape, mm; `[2, 3]`.
    #[getter]
    fn bounds_mm<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray2<f64>>> {
        let (low, high) = self.distances(py)?.bounds_mm();
        rows(py, [low.to_array(), high.to_array()].concat(), [2, 3])
    }

    /// Signed distances of points to the surface, negative inside. Ctrl-C ends the wait.
    ///
    /// - `points_mm`: points in the shape's own frame, mm; `[n_points, 3]`.
    ///
    /// Returns the distances, mm; `[n_points]`.
    ///
    /// Raises `Error` for an array of another shape, and for a point that is not finite.
    fn signed_distance_mm<'py>(
        &self,
        py: Python<'py>,
        points_mm: Given<'_>,
    ) -> PyResult<Bound<'py, PyArray1<f64>>> {
        let expected = "[n_points, 3], mm";
        let points_mm: Array<2> = points_mm.numbers("points_mm", expected)?;
        if points_mm.shape[1] != 3 {
            let problem = format!("has the shape {:?}, expected {expected}", points_mm.shape);
            return Err(unusable(py, "points_mm", &problem));
        }
        if !points_mm.values.iter().all(|number| number.is_finite()) {
            let problem = format!("has a number that is not finite, expected {expected}");
            return Err(unusable(py, "points_mm", &problem));
        }
        let distances = self.distances(py)?;
        let distances_mm = long_call(py, move || -> Vec<f64> {
            let points = points_mm.rows().map(DVec3::from_slice);
            points
                .map(|point| distances.signed_distance(point).distance_mm)
                .collect()
        })?;
        Ok(PyArray1::from_vec(py, distances_mm))
    }

    /// Supports `pickle` and `copy`: returns the function that restores the object, and its state.
    fn __reduce__<'py>(&self, py: Python<'py>) -> PyResult<Reduced<'py>> {
        reduced(py, self)
    }

    fn __repr__(&self) -> String {
        format!("<Shape {:?}>", self.shape)
    }
}

impl Kept for Shape {
    /// The shape, and the corners of the triangles of each surface that it names, mm.
    type State = (twintac::Shape, BTreeMap<String, Vec<[[f64; 3]; 3]>>);

    fn state(&self, _: Python<'_>) -> PyResult<Self::State> {
        let surfaces = self.surfaces.iter();
        let surfaces = surfaces.map(|(name, surface)| (name.clone(), corners_mm(surface)));
        Ok((self.shape.clone(), surfaces.collect()))
    }

    fn restored(py: Python<'_>, (shape, surfaces): Self::State) -> PyResult<Self> {
        let surface = |(name, triangles): (String, Vec<[[f64; 3]; 3]>)| {
            let triangles: Vec<[DVec3; 3]> =
                triangles.iter().map(|corners| corners.map(DVec3::from)).collect();
            let surface = TriangleSurface::from_triangles(&triangles);
            let surface = surface.map_err(|error| unusable(py, "Shape", &error.to_string()))?;
            PyResult::Ok((name, Arc::new(surface)))
        };
        Ok(Self {
            shape,
            surfaces: surfaces.into_iter().map(surface).collect::<PyResult<_>>()?,
        })
    }
}

/// The corners of a surface's triangles, mm.
pub(crate) fn corners_mm(surface: &TriangleSurface) -> Vec<[[f64; 3]; 3]> {
    let corner = |number: u32| surface.vertices_mm()[number as usize].to_array();
    surface
        .triangles()
        .iter()
        .map(|triangle| triangle.map(corner))
        .collect()
}

/// A shape in the form in which the surrogate of the gel can press it: its signed distances are
/// sampled once.
///
/// - `shape`: the shape. Sampling takes from a millisecond to a second, for a surface of many
///   triangles.
#[pyclass(frozen, from_py_object, module = "twintac")]
#[derive(Clone)]
pub(crate) struct Body {
    pub(crate) body: Arc<twintac::Body>,
    shape: Shape,
}

#[pymethods]
impl Body {
    #[new]
    fn new(py: Python<'_>, shape: Shape) -> PyResult<Self> {
        let own = shape.clone();
        let body = long_call(py, move || twintac::Body::new(&own.shape, &own.surfaces))?.or_raise(py)?;
        let body = Arc::new(body);
        Ok(Self { body, shape })
    }

    /// Supports `pickle` and `copy`: returns the function that restores the object, and its state.
    fn __reduce__<'py>(&self, py: Python<'py>) -> PyResult<Reduced<'py>> {
        reduced(py, self)
    }

    fn __repr__(&self) -> String {
        format!("<Body of {:?}>", self.shape.shape)
    }
}

impl Kept for Body {
    /// The state of its shape, which is sampled again.
    type State = <Shape as Kept>::State;

    fn state(&self, py: Python<'_>) -> PyResult<Self::State> {
        self.shape.state(py)
    }

    fn restored(py: Python<'_>, shape: Self::State) -> PyResult<Self> {
        Self::new(py, Shape::restored(py, shape)?)
    }
}
