//! The same presses in CalculiX, an independent finite-element program.

mod bricks;
mod case;
mod compare;
mod deck;
mod difference;
mod face;
mod output;
mod plan;
mod reference;
mod rigid;

use std::path::Path;

use anyhow::{Result, ensure};
use twintac_plot::{Ink, Scene};
use twintac_plot::{Panel, Panels};

use crate::rung::{Effort, Figure, Outcome, Plot, plots};
use case::{Case, LINE_Y_MM, Level, line_mm};
use compare::Compared;
use reference::Reference;

/// The file of CalculiX's results.
const REFERENCES: &str = "crates/app/verify/references/calculix.json";

/// Largest accepted error of the force.
const FORCE_LIMIT_PERCENT: f64 = 3.0;
/// Largest accepted error of the pressure at a taxel.
const PRESSURE_LIMIT_PERCENT: f64 = 5.0;
/// Largest accepted root mean square difference of the pressure along the board.
const ROUGHNESS_LIMIT_PERCENT: f64 = 3.0;

/// Compares with the kept results of CalculiX.
pub(crate) fn run(_: Effort) -> Result<Outcome> {
    let references = reference::read(Path::new(REFERENCES))?;
    let (mut compared, mut figures) = (Vec::new(), Vec::new());
    for case in case::all() {
        let meshes = || references.iter().filter(|reference| reference.case == case.name);
        match meshes().max_by_key(|reference| reference.n_elements) {
            Some(finest) => {
                let ours = compare::compare(&case, finest)?;
                figures.extend(figures_of(&ours));
                let name = format!(
                    "{}: nodes of CalculiX, {}",
                    case.name,
                    if finest.is_fine {
                        "fine mesh"
                    } else {
                        "coarse mesh"
                    }
                );
                figures.push(Figure::told(name, finest.n_nodes as f64, ""));
                compared.push(ours);
            }
            None => {
                let ours = compare::compare_elements(&case)?;
                figures.extend(figures_of(&ours));
                figures.push(missing(&case, 0));
                compared.push(ours);
            }
        }
        let n_depths = meshes().map(|reference| reference.frames.len()).max();
        if let Some(n_depths) = n_depths.filter(|&n_depths| n_depths < case.depths_mm.len()) {
            figures.push(missing(&case, n_depths));
        }
        if let (Some(fine), Some(coarse)) = (meshes().find(|r| r.is_fine), meshes().find(|r| !r.is_fine)) {
            figures.extend(trust(&case, fine, coarse));
        }
    }
    Ok(Outcome {
        done: format!(
            "A block of gel, 34 × 18 × 8.5 mm, bonded below, E = 70 kPa, compressible neo-Hookean (`W = μ/2 \
             (J^(-2/3) I1 - 3) + K/2 (J - 1)²`), is pressed without friction by a sphere (R = 12.5 mm, in \
             the middle), a flat cylinder (R = 5 mm, rounded by 0.8 mm, at (3, 2)) and a bar (3 × 10 mm, \
             rounded by 0.5 mm, at (-5, 1)). CalculiX 2.20 solves it with 20-node hexahedra of reduced \
             integration (C3D20R) and surface-to-surface contact; TwinTac solves it as `twintac simulate \
             --sensor F --path F` does, with default settings. Pressure is `-tr(σ)/3` on the board, \
             averaged over a taxel's port with a radius of 1 mm; the taxels are at the positions of \
             `sensors/phystac.toml`. The error of a pressure is relative to that pressure, or, where it is \
             below a twentieth of the largest pressure at any taxel, to the largest. Along the board (y = \
             {LINE_Y_MM} mm) the error is the root mean square, relative to the largest pressure there; a \
             checkerboard pattern at ν = 0.4999 would increase it. Where CalculiX finds no equilibrium, as \
             at ν = 0.4999, the reference is TwinTac's quadratic elements on the same nodes, to a depth of \
             1 mm.\n\nThe results of CalculiX are stored in `{REFERENCES}`; `cargo xtask verify calculix \
             --ccx NAME` computes them again (Debian package calculix-ccx) for the cases whose names start \
             with NAME, on a coarse and on a fine mesh, in `{}`.",
            reference::FOLDER
        ),
        figures,
        plots: vec![Plot {
            name: "pressure",
            caption: format!(
                "From the top: {}.",
                compared
                    .iter()
                    .map(|compared| compared.case.as_str())
                    .collect::<Vec<_>>()
                    .join(", ")
            ),
            scene: plot(&compared),
        }],
    })
}

fn missing(case: &Case, n_found: usize) -> Figure {
    let name = format!("{}: depths that CalculiX has not reached", case.name);
    Figure::at_most(0.0, name, (case.depths_mm.len() - n_found) as f64, "")
}

fn figures_of(compared: &Compared) -> Vec<Figure> {
    let largest = |errors: &mut dyn Iterator<Item = f64>| errors.map(f64::abs).fold(0.0, f64::max);
    let beside = if compared.is_calculix {
        ""
    } else {
        " beside quadratic elements"
    };
    let case = format!("{}{beside}", compared.case);
    let mut figures = vec![Figure::told(
        format!("{case}: nodes"),
        compared.n_nodes as f64,
        "",
    )];
    for frame in &compared.frames {
        let mut add = |limit: f64, what: &str, value: f64| {
            let name = format!("{case}, {} mm: {what}", frame.depth_mm);
            figures.push(Figure::at_most(limit, name, value, "%"));
        };
        add(FORCE_LIMIT_PERCENT, "force", frame.force_error_percent());
        let mut taxels = frame
            .pressure_kpa
            .keys()
            .map(|taxel| frame.pressure_error_percent(taxel));
        add(
            PRESSURE_LIMIT_PERCENT,
            "pressure at the worst taxel",
            largest(&mut taxels),
        );
        add(
            ROUGHNESS_LIMIT_PERCENT,
            "pressure along the board",
            frame.roughness_percent(),
        );
    }
    figures
}

/// The accuracy of CalculiX's results: the largest differences between two of its own meshes, and
/// the deepest node inside the indenter.
fn trust(case: &Case, fine: &Reference, coarse: &Reference) -> [Figure; 3] {
    let [force, pressure] = coarse.largest_difference_percent(fine);
    let penetrations_mm = fine.frames.iter().map(|frame| frame.penetration_mm);
    let about = format!(
        "{}: CalculiX, {} to {} nodes",
        case.name, coarse.n_nodes, fine.n_nodes
    );
    [
        Figure::told(format!("{about}: force"), force, "%"),
        Figure::told(format!("{about}: pressure"), pressure, "%"),
        Figure::told(
            format!("{}: CalculiX, deepest node inside the indenter", case.name),
            1e3 * penetrations_mm.fold(0.0, f64::max),
            "µm",
        ),
    ]
}

/// The plot of the pressure along the board.
fn plot(compared: &[Compared]) -> Scene {
    let panel = |compared: &Compared| {
        let series = |side: usize| {
            compared.frames.iter().map(move |frame| {
                let pressures = line_mm().into_iter().zip(&frame.line_kpa);
                let points = pressures.map(|(at, pair)| [at.x, pair[side]]).collect();
                match side {
                    0 => plots::line("TwinTac", 0, points),
                    _ => twintac_plot::Series {
                        ink: Ink::Text,
                        ..plots::dashes("CalculiX, or quadratic elements", 0, points)
                    },
                }
            })
        };
        Panel {
            name: compared.case.replace("-nu", ", ν 0."),
            y_label: "kPa".to_owned(),
            series: series(0).chain(series(1)).collect(),
            y_range: None,
        }
    };
    Panels {
        title: format!("Pressure on the board along y = {LINE_Y_MM} mm at each depth"),
        x_label: "x, mm".to_owned(),
        panels: compared.iter().map(panel).collect(),
        panel_height_px: 130.0,
        logarithmic: false,
    }
    .scene()
}

/// Runs CalculiX on the cases whose names start with `prefix`, on two meshes each, and keeps the
/// results.
pub(crate) fn compute_references(prefix: &str) -> Result<()> {
    let file = Path::new(REFERENCES);
    let cases = case::all();
    let chosen: Vec<&Case> = cases
        .iter()
        .filter(|case| case.name.starts_with(prefix))
        .collect();
    let names: Vec<&str> = cases.iter().map(|case| case.name.as_str()).collect();
    ensure!(
        !chosen.is_empty(),
        "no case is called `{prefix}`; there are {}",
        names.join(", ")
    );
    for case in chosen {
        for level in [Level::Coarse, Level::Fine] {
            let found = reference::compute(case, level)?;
            let is_same = |other: &Reference| other.case == found.case && other.is_fine == found.is_fine;
            let mut kept = reference::read(file)?;
            kept.retain(|other| !is_same(other));
            kept.push(found);
            reference::write(file, &mut kept)?;
        }
    }
    Ok(())
}
