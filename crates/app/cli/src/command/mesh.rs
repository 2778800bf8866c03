//! `twintac mesh`.

use std::fs;

use anyhow::{Context, Result};
use twintac_mesh::{MeshSettings, Quality, generate_with_node_count, gmsh};
use twintac_run::mesh::{inclusions, mesh_of, quality, write_mesh};

use crate::arguments::Mesh;
use twintac_run::sensor_file::read_sensor;

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

fn print_quality(quality: &Quality) -> Result<()> {
    super::print(&serde_json::to_string_pretty(quality)?)
}
