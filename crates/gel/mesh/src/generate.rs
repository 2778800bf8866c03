//! Generates a mesh of a solid.

use twintac_shape::{SignedDistance, Solid, Surfaces, TriangleSurface};

use crate::footprint::Footprint;
use crate::lattice::Lattice;
use crate::quality::least_dihedral_deg;
use crate::region::Region;
use crate::{Cuboid, MeshError, MeshSettings, TetMesh, grid, stuffing};

/// Smallest dihedral angle of a stuffed mesh, degrees, that is good enough not to try another
/// lattice.
const GOOD_DIHEDRAL_DEG: f64 = 9.0;

/// Largest distance of the base of a triangle surface from z = 0, mm.
const OFF_BOARD_MM: f64 = 0.01;

/// Meshes a solid without its inclusions. Nodes on the board (z = 0) and on inclusions are bonded.
///
/// Blocks and domes are cut from a bent tensor grid, which is mirrored about the first focus.
/// Triangle surfaces are found in `surfaces` by their path. They must be closed and stand on z = 0,
/// and are meshed by isosurface stuffing. The same input gives the same mesh, bit for bit.
///
/// # Errors
/// Invalid settings, solids or inclusions; more than 20 million lattice points; a flat tetrahedron,
/// for example where faces of inclusions are almost aligned along two axes. (Faces closer than a
/// twentieth of the shortest edge are merged, others are not.)
pub fn generate(
    solid: &Solid,
    surfaces: &Surfaces,
    inclusions: &[Cuboid],
    settings: &MeshSettings,
) -> Result<TetMesh, MeshError> {
    let mesh = generate_unchecked(solid, surfaces, inclusions, settings)?;
    mesh.check_volumes()?;
    Ok(mesh)
}

/// Meshes like [`generate`], for callers that count nodes before they accept a mesh. Tetrahedra may
/// be flat, which [`TetMesh::check_volumes`] reports.
///
/// # Errors
/// Those of [`generate`], except for flat tetrahedra.
pub fn generate_unchecked(
    solid: &Solid,
    surfaces: &Surfaces,
    inclusions: &[Cuboid],
    settings: &MeshSettings,
) -> Result<TetMesh, MeshError> {
    settings.check()?;
    solid.validate()?;
    match (solid, Footprint::of(solid)) {
        (_, Some(footprint)) => Ok(grid::mesh(
            &footprint,
            &grid::lattice(&footprint, inclusions, settings)?,
        )),
        (Solid::Stl(file), None) => {
            let name = file.name();
            let missing = || MeshError::SurfaceMissing {
                path: name.clone().into_owned(),
            };
            let surface = surfaces.get(&*name).ok_or_else(missing)?;
            stuff(&name, surface, inclusions, settings)
        }
        (_, None) => Err(MeshError::Empty {
            reason: "this kind of solid has no surface".to_owned(),
        }),
    }
}

/// Meshes a triangle surface that stands on the board.
fn stuff(
    path: &str,
    surface: &TriangleSurface,
    inclusions: &[Cuboid],
    settings: &MeshSettings,
) -> Result<TetMesh, MeshError> {
    let (low_mm, high_mm) = surface.bounds_mm();
    if !(low_mm.is_finite()
        && high_mm.is_finite()
        && low_mm.cmplt(high_mm).all()
        && low_mm.z.abs() <= OFF_BOARD_MM)
    {
        return Err(MeshError::Surface {
            path: path.to_owned(),
            expected: format!("a surface that stands on z = 0, within {OFF_BOARD_MM} mm"),
            found: format!("one from {low_mm} to {high_mm}"),
        });
    }
    if let Some(at_mm) = surface.bodies_meet_at_mm() {
        return Err(MeshError::Surface {
            path: path.to_owned(),
            expected: "bodies apart from each other".to_owned(),
            found: format!("two that touch or overlap at {at_mm} mm"),
        });
    }
    let low_mm = low_mm.with_z(0.0);
    for (index, inclusion) in inclusions.iter().enumerate() {
        inclusion.check(index, [low_mm, high_mm], high_mm.z)?;
    }
    // Where a surface nearly touches lattice points, a slightly different lattice gives better
    // angles. Where narrow cells between inclusions lean over their neighbours, upright lines do.
    let mut best: Option<(f64, TetMesh)> = None;
    for factor in [1.0, 0.97, 1.03, 0.94, 1.06] {
        // The lattice has two points for each cell.
        let settings = settings.scaled(factor * 2_f64.cbrt());
        let mut lattice = Lattice::new([low_mm, high_mm], inclusions, &settings, 0.0)?;
        if best.is_some() {
            lattice = lattice.upright();
        }
        let tolerance_mm = 1e-4 * settings.smallest_edge_mm();
        let region = Region::new(surface, &lattice.inclusions(), 0.0, tolerance_mm);
        let mesh = stuffing::mesh(&lattice, &region)?;
        let least_deg = least_dihedral_deg(&mesh);
        if best.as_ref().is_none_or(|&(best_deg, _)| least_deg > best_deg) {
            best = Some((least_deg, mesh));
        }
        if least_deg > GOOD_DIHEDRAL_DEG {
            break;
        }
    }
    best.map(|(_, mesh)| mesh).ok_or_else(|| MeshError::Empty {
        reason: "no lattice fits".to_owned(),
    })
}

/// Meshes a solid with about `n_nodes` nodes (± 10 %), by multiplying all edge lengths of the
/// settings with one factor. Also returns the settings with the edge lengths that were found.
///
/// # Errors
/// Those of [`generate`], and [`MeshError::NodeCount`] if no factor gives such a number. Lines are
/// added as a whole, often two at a time or along several axes at once, which is a large step in a
/// mesh of few lines.
pub fn generate_with_node_count(
    solid: &Solid,
    surfaces: &Surfaces,
    inclusions: &[Cuboid],
    settings: &MeshSettings,
    n_nodes: usize,
) -> Result<(TetMesh, MeshSettings), MeshError> {
    settings.check()?;
    solid.validate()?;
    let footprint = Footprint::of(solid);
    let count = |settings: &MeshSettings| match &footprint {
        Some(footprint) => Ok(grid::number_nodes(&grid::lattice(footprint, inclusions, settings)?).0),
        None => Ok(generate(solid, surfaces, inclusions, settings)?.nodes_mm.len()),
    };
    let found = search(settings, n_nodes, count)?;
    Ok((generate(solid, surfaces, inclusions, &found)?, found))
}

/// The settings whose mesh has the number of nodes nearest to the requested one.
fn search(
    settings: &MeshSettings,
    target: usize,
    count: impl Fn(&MeshSettings) -> Result<usize, MeshError>,
) -> Result<MeshSettings, MeshError> {
    let away = |n_nodes: usize| n_nodes.abs_diff(target);
    // Nearest number of nodes so far, and its factor.
    let mut best = (usize::MAX, 1.0);
    let mut attempt = |factor: f64| {
        let n_nodes = match count(&settings.scaled(factor)) {
            Err(MeshError::TooFine { found, .. }) => found.max(2 * target),
            counted => counted?,
        };
        if away(n_nodes) < away(best.0) {
            best = (n_nodes, factor);
        }
        Ok::<_, MeshError>((n_nodes, best))
    };
    // The count is roughly proportional to the inverse cube of the edge length, with jumps. The
    // factor follows this rule, in steps that become shorter.
    let (mut too_fine, mut too_coarse) = (0.0_f64, f64::INFINITY);
    let mut factor = 1.0;
    for step in 0..24 {
        let exponent = 0.4 / (1.0 + 0.1 * f64::from(step));
        let (n_nodes, best) = attempt(factor)?;
        if 100 * away(best.0) <= target {
            return Ok(settings.scaled(best.1));
        }
        if n_nodes > target {
            too_fine = too_fine.max(factor);
        } else {
            too_coarse = too_coarse.min(factor);
        }
        factor *= (n_nodes as f64 / target.max(1) as f64).powf(exponent);
    }
    // The requested count may be in too narrow a range for these steps: bisect until a single jump
    // remains.
    while too_fine > 0.0 && too_coarse < f64::INFINITY && (too_coarse / too_fine - 1.0).abs() > 1e-9 {
        factor = (too_fine * too_coarse).sqrt();
        let (n_nodes, best) = attempt(factor)?;
        if 10 * away(best.0) <= target {
            break;
        }
        if n_nodes > target {
            too_fine = factor;
        } else {
            too_coarse = factor;
        }
    }
    match best {
        (nearest, factor) if 10 * away(nearest) <= target => Ok(settings.scaled(factor)),
        (nearest, _) => Err(MeshError::NodeCount { target, nearest }),
    }
}
