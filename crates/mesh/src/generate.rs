//! From a solid to a mesh.

use std::collections::BTreeMap;
use std::sync::Arc;

use twintac_shape::{SignedDistance, Solid};

use crate::footprint::Footprint;
use crate::quality::check_volumes;
use crate::{Cuboid, MeshError, MeshSettings, TetMesh, grid};

/// Part of the volume of a regular tetrahedron with the same longest edge that every tetrahedron has.
const LEAST_VOLUME_SHARE: f64 = 1e-3;

/// Meshes a solid without its inclusions. Nodes on the board (z = 0) and on inclusions are bonded.
///
/// Blocks and domes are cut from a bent tensor grid and mirrored about the first focus. The same input gives the same mesh, bit for bit.
///
/// # Errors
/// Settings, solids or inclusions that make no sense; more than 20 million lattice points; a tetrahedron that came out flat.
pub fn generate<S: SignedDistance>(
    solid: &Solid,
    surfaces: &BTreeMap<String, Arc<S>>,
    inclusions: &[Cuboid],
    settings: &MeshSettings,
) -> Result<TetMesh, MeshError> {
    settings.check()?;
    let Some(footprint) = Footprint::of(solid)? else {
        let _ = surfaces;
        return Err(MeshError::Empty {
            reason: "triangle surfaces are not meshed yet".to_owned(),
        });
    };
    let lattice = grid::lattice(&footprint, inclusions, settings)?;
    let mesh = grid::mesh(&footprint, &lattice);
    check_volumes(&mesh, LEAST_VOLUME_SHARE)?;
    Ok(mesh)
}

/// Meshes a solid with about `n_nodes` nodes (± 10 %): all edge lengths of the settings are multiplied by one factor. Also returns the
/// settings with the edge lengths that were found.
///
/// # Errors
/// Those of [`generate`]; [`MeshError::NodeCount`] where no factor gives such a number.
pub fn generate_with_node_count<S: SignedDistance>(
    solid: &Solid,
    surfaces: &BTreeMap<String, Arc<S>>,
    inclusions: &[Cuboid],
    settings: &MeshSettings,
    n_nodes: usize,
) -> Result<(TetMesh, MeshSettings), MeshError> {
    settings.check()?;
    let footprint = Footprint::of(solid)?;
    let count = |settings: &MeshSettings| match &footprint {
        Some(footprint) => Ok(grid::number_nodes(&grid::lattice(footprint, inclusions, settings)?).0),
        None => Ok(generate(solid, surfaces, inclusions, settings)?.nodes_mm.len()),
    };
    let found = search(settings, n_nodes, count)?;
    Ok((generate(solid, surfaces, inclusions, &found)?, found))
}

/// The settings whose mesh has the number of nodes nearest to the wanted one.
fn search(
    settings: &MeshSettings,
    target: usize,
    count: impl Fn(&MeshSettings) -> Result<usize, MeshError>,
) -> Result<MeshSettings, MeshError> {
    let away = |n_nodes: usize| n_nodes.abs_diff(target);
    let mut factor = 1.0;
    let mut best: Option<(usize, f64)> = None;
    // The count goes roughly with the cube of the edge length, in jumps: follow that, with shorter and shorter steps.
    for step in 0..24 {
        let exponent = 0.4 / (1.0 + 0.1 * f64::from(step));
        let n_nodes = match count(&settings.scaled(factor)) {
            Ok(n_nodes) => n_nodes,
            Err(MeshError::TooFine { found, .. }) => found.max(2 * target),
            Err(other) => return Err(other),
        };
        if best.is_none_or(|(nearest, _)| away(n_nodes) < away(nearest)) {
            best = Some((n_nodes, factor));
        }
        if 100 * away(n_nodes) <= target {
            break;
        }
        factor *= (n_nodes as f64 / target.max(1) as f64).powf(exponent);
    }
    match best {
        Some((nearest, factor)) if 10 * away(nearest) <= target => Ok(settings.scaled(factor)),
        nearest => Err(MeshError::NodeCount {
            target,
            nearest: nearest.map_or(0, |(n_nodes, _)| n_nodes),
        }),
    }
}
