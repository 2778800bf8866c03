//! The gel's mesh, and its files for other programs.

use std::path::Path;

use twintac_mesh::{
    Cuboid, MeshSettings, Quality, TetMesh, gel_volume_mm3, generate, generate_with_node_count, gmsh, stl,
    vtk,
};
use twintac_sensor::Sensor;
use twintac_store::{write_file, write_json};
use twintac_work::{At, WorkError};

pub use twintac_shape::LengthUnit;

/// Edges over the gel's height with [`Fineness::Usual`].
const EDGES_PER_HEIGHT: f64 = 6.0;

/// How fine a mesh is.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum Fineness {
    /// Six edges over the gel's height.
    #[default]
    Usual,
    /// Edges of this length, mm.
    EdgeMm(f64),
    /// About this many nodes, within 10 %.
    Nodes(usize),
}

/// The meshed gel of a sensor.
#[derive(Clone, Debug)]
pub struct MeshedGel {
    /// The mesh; z = 0 at the board.
    pub mesh: TetMesh,
    /// The quality of the mesh.
    pub quality: Quality,
}

impl MeshedGel {
    /// Meshes the gel of a sensor around its inclusions.
    ///
    /// # Errors
    /// A fineness that gives no mesh.
    pub fn of(sensor: &Sensor, fineness: Fineness) -> Result<Self, WorkError> {
        let (solid, surfaces) = (&sensor.gel.solid, &sensor.surfaces);
        let inclusions = inclusions(sensor);
        let height_mm = solid.bounds_mm(surfaces).1.z;
        let usual_mm = height_mm / EDGES_PER_HEIGHT;
        let settings = |edge_mm: f64| MeshSettings {
            edge_mm,
            ..MeshSettings::default()
        };
        let mesh = match fineness {
            Fineness::Usual => generate(solid, surfaces, &inclusions, &settings(usual_mm))?,
            Fineness::EdgeMm(edge_mm) => generate(solid, surfaces, &inclusions, &settings(edge_mm))?,
            Fineness::Nodes(nodes) => {
                generate_with_node_count(solid, surfaces, &inclusions, &settings(usual_mm), nodes)?.0
            }
        };
        let volume_mm3 = gel_volume_mm3(solid, surfaces, &inclusions);
        let quality = Quality::of(&mesh, Some(volume_mm3));
        Ok(Self { mesh, quality })
    }

    /// Writes `gel.msh` for Gmsh, `gel.vtu` for ParaView, `gel.stl` for CAD, and `quality.json`.
    ///
    /// # Errors
    /// A file that cannot be written.
    pub fn write(&self, folder: &Path) -> Result<(), WorkError> {
        write_file(&folder.join("gel.msh"), gmsh::write(&self.mesh).as_bytes())?;
        write_file(
            &folder.join("gel.vtu"),
            vtk::write(&self.mesh, &[], &[])?.as_bytes(),
        )?;
        write_file(&folder.join("gel.stl"), &stl::write(&self.mesh))?;
        Ok(write_json(&folder.join("quality.json"), &self.quality)?)
    }
}

/// The quality of the mesh in a Gmsh file whose lengths have this unit.
///
/// # Errors
/// A file that cannot be read, that is no mesh of tetrahedra, or whose size does not fit the unit.
pub fn check_mesh(path: &Path, unit: LengthUnit) -> Result<Quality, WorkError> {
    let bytes = std::fs::read(path).map_err(WorkError::file("reading", path))?;
    let mesh = gmsh::read(&bytes, unit.in_mm()).at(|| path.display().to_string())?;
    Ok(Quality::of(&mesh, None))
}

fn inclusions(sensor: &Sensor) -> Vec<Cuboid> {
    let cuboid = |inclusion: &twintac_sensor::Inclusion| Cuboid {
        min_mm: inclusion.min_mm,
        max_mm: inclusion.max_mm,
    };
    sensor.inclusions.iter().map(cuboid).collect()
}
