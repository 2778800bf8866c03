//! `twintac mesh`.

use std::fs;
use std::path::Path;

use anyhow::{Context, Result};
use twintac_mesh::{
    Cuboid, MeshSettings, Quality, TetMesh, gel_volume_mm3, generate, generate_with_node_count, gmsh, stl,
    vtk,
};
use twintac_sensor::Sensor;

use crate::arguments::Mesh;
use crate::sensor_file::read_sensor;
use crate::stage::{write_file, write_json};

/// Edges over the gel's height, unless asked otherwise.
const EDGES_PER_HEIGHT: f64 = 6.0;

/// Meshes a gel or checks a mesh, and prints its quality as JSON.
pub(crate) fn run(arguments: &Mesh) -> Result<()> {
    if let Some(path) = &arguments.check {
        let bytes = fs::read(path).with_context(|| format!("reading {}", path.display()))?;
        let mesh = gmsh::read(&bytes).with_context(|| path.display().to_string())?;
        return print_quality(&Quality::of(&mesh, None));
    }
    let path = arguments
        .sensor
        .as_ref()
        .context("give a sensor description with --sensor")?;
    let sensor = read_sensor(path)?.sensor;
    let height_mm = sensor.gel.solid.bounds_mm(&sensor.surfaces).1.z;
    let edge_mm = arguments.edge_mm.unwrap_or(height_mm / EDGES_PER_HEIGHT);
    let settings = MeshSettings {
        edge_mm,
        ..MeshSettings::default()
    };
    let mesh = match arguments.nodes {
        Some(nodes) => {
            generate_with_node_count(
                &sensor.gel.solid,
                &sensor.surfaces,
                &inclusions(&sensor),
                &settings,
                nodes,
            )?
            .0
        }
        None => mesh_of(&sensor, &settings)?,
    };
    let quality = match &arguments.out {
        Some(folder) => write_mesh(folder, &sensor, &mesh)?,
        None => quality(&sensor, &mesh)?,
    };
    print_quality(&quality)
}

/// The mesh of a sensor's gel.
pub(crate) fn mesh_of(sensor: &Sensor, settings: &MeshSettings) -> Result<TetMesh> {
    Ok(generate(
        &sensor.gel.solid,
        &sensor.surfaces,
        &inclusions(sensor),
        settings,
    )?)
}

/// Writes a gel's mesh for Gmsh, ParaView and CAD, and its quality.
pub(crate) fn write_mesh(folder: &Path, sensor: &Sensor, mesh: &TetMesh) -> Result<Quality> {
    write_file(&folder.join("gel.msh"), gmsh::write(mesh).as_bytes())?;
    write_file(&folder.join("gel.vtu"), vtk::write(mesh, &[], &[])?.as_bytes())?;
    write_file(&folder.join("gel.stl"), &stl::write(mesh))?;
    let quality = quality(sensor, mesh)?;
    write_json(&folder.join("quality.json"), &quality)?;
    Ok(quality)
}

fn quality(sensor: &Sensor, mesh: &TetMesh) -> Result<Quality> {
    let volume_mm3 = gel_volume_mm3(&sensor.gel.solid, &sensor.surfaces, &inclusions(sensor));
    Ok(Quality::of(mesh, Some(volume_mm3)))
}

fn inclusions(sensor: &Sensor) -> Vec<Cuboid> {
    sensor
        .inclusions
        .iter()
        .map(|i| Cuboid {
            min_mm: i.min_mm,
            max_mm: i.max_mm,
        })
        .collect()
}

fn print_quality(quality: &Quality) -> Result<()> {
    super::print(&serde_json::to_string_pretty(quality)?)
}
