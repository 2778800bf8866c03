//! `twintac mesh`.

use anyhow::{Context, Result};
use twintac_gel::mesh::{Fineness, MeshedGel, check_mesh};
use twintac_sensor::SensorFile;

use crate::arguments::Mesh;
use crate::output::print;

/// Meshes a gel or checks a mesh, and prints its quality as JSON.
pub(crate) fn run(arguments: &Mesh) -> Result<()> {
    let quality = match &arguments.check {
        Some(path) => check_mesh(path, arguments.unit)?,
        None => {
            let path = arguments.sensor.as_ref();
            let path = path.context("give a sensor description with --sensor")?;
            let fineness = match (arguments.nodes, arguments.edge_mm) {
                (Some(nodes), _) => Fineness::Nodes(nodes),
                (None, Some(edge_mm)) => Fineness::EdgeMm(edge_mm),
                (None, None) => Fineness::Usual,
            };
            let gel = MeshedGel::of(&SensorFile::read(path)?.sensor, fineness)?;
            if let Some(folder) = &arguments.out {
                gel.write(folder)?;
            }
            gel.quality
        }
    };
    print(&serde_json::to_string_pretty(&quality)?)
}
