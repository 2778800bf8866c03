//! Errors of this crate.

use glam::DVec3;

/// A mesh that cannot be made or read.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum MeshError {
    /// An invalid setting.
    #[error("`{field}` is {found}, expected {expected}")]
    Setting {
        /// Name of the field.
        field: String,
        /// What was expected.
        expected: String,
        /// What was found.
        found: String,
    },
    /// An invalid solid.
    #[error("the gel's {0}")]
    Solid(#[from] twintac_shape::ShapeError),
    /// An inclusion that is not a box inside the solid.
    #[error("inclusion {index} {found}, expected {expected}")]
    Inclusion {
        /// Position in the list of inclusions, from 0.
        index: usize,
        /// What was expected.
        expected: String,
        /// What was found.
        found: String,
    },
    /// The surface that the solid names was not passed.
    #[error("the surface `{path}` is not among those loaded")]
    SurfaceMissing {
        /// Path of the surface, as in the solid.
        path: String,
    },
    /// A triangle surface that cannot be meshed.
    #[error("the surface `{path}`: expected {expected}, found {found}")]
    Surface {
        /// Path of the surface, as in the solid.
        path: String,
        /// What was expected.
        expected: String,
        /// What was found.
        found: String,
    },
    /// The mesh would be larger than the limit of the generator.
    #[error("the mesh would have {found} lattice points, at most {most} are allowed; increase `edge_mm`")]
    TooFine {
        /// Number of lattice points of the requested mesh.
        found: usize,
        /// The limit.
        most: usize,
    },
    /// No edge length gives the requested number of nodes.
    #[error("no mesh with {target} nodes ± 10 %, the nearest has {nearest}")]
    NodeCount {
        /// Requested number of nodes.
        target: usize,
        /// Nearest number of nodes that was found.
        nearest: usize,
    },
    /// A tetrahedron without volume, or too flat for computations.
    #[error(
        "tetrahedron {tet} at {center_mm} has a volume of {volume_mm3:.3e} mm³, expected at least {least_mm3:.3e}"
    )]
    Degenerate {
        /// Its index.
        tet: usize,
        /// Its centre, mm.
        center_mm: DVec3,
        /// Its volume, mm³.
        volume_mm3: f64,
        /// The smallest volume that is accepted for its size, mm³.
        least_mm3: f64,
    },
    /// Nothing of the solid remains to be meshed.
    #[error("the mesh is empty: {reason}")]
    Empty {
        /// Why.
        reason: String,
    },
    /// A mesh file that cannot be understood.
    #[error("mesh file, {place}: expected {expected}, found {found}")]
    File {
        /// Where: a line (text) or a byte offset (binary).
        place: String,
        /// What was expected.
        expected: String,
        /// What was found.
        found: String,
    },
    /// A mesh in a file whose lengths are not in mm.
    #[error("the mesh {0}")]
    Extent(#[from] twintac_shape::ExtentError),
    /// Bodies in a mesh file that touch without sharing nodes.
    #[error(
        "nodes {} and {} are both at {at_mm} mm: bodies that touch have to share nodes (in Gmsh, `Coherence;` before meshing or `Coherence Mesh;` \
         after it)",
        tags[0],
        tags[1]
    )]
    NodesTwice {
        /// The nodes' tags in the file.
        tags: [u64; 2],
        /// Their position, mm.
        at_mm: DVec3,
    },
    /// Tetrahedra in a mesh file that overlap, or bodies that touch without common nodes.
    #[error(
        "tetrahedra overlap or touch without common nodes at {at_mm} mm: unite the bodies and mesh them again (in Gmsh, `BooleanFragments`)"
    )]
    Overlap {
        /// A point there, mm.
        at_mm: DVec3,
    },
    /// The boundary of a mesh in a file encloses nothing.
    #[error("the boundary of the mesh {0}")]
    Boundary(#[source] twintac_shape::SurfaceError),
    /// A field that does not fit the mesh that it is to be written with.
    #[error("the field `{name}` has {found} values, expected {expected} finite ones")]
    Field {
        /// Name of the field.
        name: String,
        /// Number of values that are required.
        expected: usize,
        /// Number of values that were given.
        found: String,
    },
}
