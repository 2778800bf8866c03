//! A gel's mesh, written for other programs.

use std::path::Path;

use anyhow::Result;
use twintac_mesh::{Cuboid, MeshSettings, Quality, TetMesh, gel_volume_mm3, generate, gmsh, stl, vtk};
use twintac_sensor::Sensor;

use crate::cache::{write_file, write_json};

/// The mesh of a sensor's gel.
pub fn mesh_of(sensor: &Sensor, settings: &MeshSettings) -> Result<TetMesh> {
    Ok(generate(
        &sensor.gel.solid,
        &sensor.surfaces,
        &inclusions(sensor),
        settings,
    )?)
}

/// Writes a gel's mesh for Gmsh, ParaView and CAD, and its quality.
pub fn write_mesh(folder: &Path, sensor: &Sensor, mesh: &TetMesh) -> Result<Quality> {
    write_file(&folder.join("gel.msh"), gmsh::write(mesh).as_bytes())?;
    write_file(&folder.join("gel.vtu"), vtk::write(mesh, &[], &[])?.as_bytes())?;
    write_file(&folder.join("gel.stl"), &stl::write(mesh))?;
    let quality = quality(sensor, mesh)?;
    write_json(&folder.join("quality.json"), &quality)?;
    Ok(quality)
}

/// How good a gel's mesh is.
pub fn quality(sensor: &Sensor, mesh: &TetMesh) -> Result<Quality> {
    let volume_mm3 = gel_volume_mm3(&sensor.gel.solid, &sensor.surfaces, &inclusions(sensor));
    Ok(Quality::of(mesh, Some(volume_mm3)))
}

/// What stands in a gel.
pub fn inclusions(sensor: &Sensor) -> Vec<Cuboid> {
    sensor
        .inclusions
        .iter()
        .map(|i| Cuboid {
            min_mm: i.min_mm,
            max_mm: i.max_mm,
        })
        .collect()
}
