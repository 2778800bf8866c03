//! Tetrahedral meshes of gels: generated from a solid, imported from Gmsh, exported to VTK and STL.
//!
//! Input: a [`twintac_shape::Solid`], boxes of rigid parts in it (sensor chips) and
//! [`MeshSettings`], or the bytes of a mesh file. Output: a [`TetMesh`], with lengths in mm.
//!
//! The gel stands on a board, the plane z = 0, and may enclose chips. It is glued to both: the
//! nodes there are [`NodeSets::bonded`]. It is pressed from above, on [`NodeSets::top`].
//!
//! - [`generate`] meshes a solid. A [`Focus`] makes the mesh fine where a press and the taxels need
//!   it. The pattern of nodes around the first focus does not depend on its position, so that
//!   presses at different positions are discretized in the same way. Inclusions are cut out
//!   exactly.
//! - [`generate_with_node_count`] finds the edge length that gives a number of nodes.
//! - [`TetMesh::refined`] cuts every tetrahedron into eight. The solver has displacements on the
//!   refined mesh and pressures on the coarse one.
//! - [`gmsh::read`] imports files of Gmsh and fTetWild; [`gmsh::write`] writes a mesh for later
//!   use.
//! - [`vtk::write`] writes a mesh with fields on it for ParaView, [`stl::write`] its surface for
//!   any viewer.
//! - [`Quality`] has measures of the quality of a mesh.
//!
//! The same input gives the same mesh on every run, bit for bit.
//!
//! # Example
//! A strip of gel over two chips, with a fine mesh where a tip of 2 mm radius will press it:
//! ```
//! use glam::DVec3;
//! use twintac_mesh::{Cuboid, Focus, MeshSettings, Quality, gel_volume_mm3, generate, gmsh};
//! use twintac_shape::{Solid, Surfaces};
//!
//! let strip = Solid::Block { size_mm: [40.0, 6.0, 6.0], center_mm: [0.0, 0.0], edge_radius_mm: 0.0 };
//! let chips = [-8.0, 8.0].map(|x_mm| Cuboid {
//!     min_mm: DVec3::new(x_mm - 1.0, -1.25, 0.0),
//!     max_mm: DVec3::new(x_mm + 1.0, 1.25, 1.1),
//! });
//! let tip = Focus {
//!     center_mm: DVec3::new(3.0, 0.5, 6.0),
//!     radius_mm: 2.0,
//!     edge_mm: 0.5,
//!     stretches: Default::default(),
//!     lines_mm: Default::default(),
//! };
//! let settings = MeshSettings { edge_mm: 1.5, focuses: vec![tip], ..MeshSettings::default() };
//!
//! let mesh = generate(&strip, &Surfaces::new(), &chips, &settings)?;
//!
//! let expected_mm3 = gel_volume_mm3(&strip, &Surfaces::new(), &chips);
//! let quality = Quality::of(&mesh, Some(expected_mm3));
//! assert!(quality.volume_error.is_some_and(|error| error.abs() < 1e-12));
//! assert!(quality.dihedral_deg.min > 10.0);
//!
//! // The pressure at a chip's port is that of the tetrahedron above it.
//! let port_mm = DVec3::new(8.0, 0.0, 1.1);
//! let (tet, weights) = mesh.locate(port_mm, 0.01).expect("the port touches the gel");
//! assert!(mesh.tets[tet].iter().zip(weights).any(|(node, weight)| {
//!     weight > 0.0 && mesh.sets.bonded.contains(node)
//! }));
//!
//! assert_eq!(gmsh::read(gmsh::write(&mesh).as_bytes(), 1.0)?, mesh);
//! # Ok::<(), twintac_mesh::MeshError>(())
//! ```
//!
//! # How it works
//!
//! Blocks and domes are meshed by a graded tensor grid, which is bent into the solid; each cell is
//! cut into six tetrahedra (`grid.rs` explains why six). At the board the lines of the grid follow
//! the inclusions, at the top they follow the contact, and between the two they lean. Triangle
//! surfaces are meshed by isosurface stuffing on the body-centred version of the same lattice
//! (`stuffing.rs`).
//!
//! The reader and writer of Gmsh files are code of our own, because the crate `mshio` reads version
//! 4.1 only, names no line in its errors, brings twenty crates of old versions (`nom` 5, `num`,
//! `syn` 1), and writes nothing.
//!
//! This crate knows no sensors, materials or solvers: it depends on the crate of shapes alone.

mod axis;
mod boundary;
pub mod bricks;
mod error;
mod footprint;
mod generate;
pub mod gmsh;
mod grid;
mod lattice;
mod locate;
mod quality;
mod refine;
mod region;
mod settings;
mod size;
mod stencil;
pub mod stl;
mod stuffing;
mod tet_mesh;
mod volume;
pub mod vtk;

pub use error::MeshError;
pub use generate::{generate, generate_unchecked, generate_with_node_count};
pub use locate::Neighbourhood;
pub use quality::{Quality, Spread};
pub use refine::Refinement;
pub use settings::{Cuboid, Focus, MeshSettings, Stretch};
pub use tet_mesh::{NodeSets, TetMesh};
pub use volume::gel_volume_mm3;
