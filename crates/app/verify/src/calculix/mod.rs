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
use compare::{Compared, FINER};
use reference::Reference;

/// Where references come from.
#[derive(Clone, Copy)]
pub(crate) enum Source {
    /// The independent program.
    Calculix,
    /// This project's quadratic elements, on meshes that are fine at rims.
    Quadratic,
}

impl Source {
    const ALL: [Self; 2] = [Self::Calculix, Self::Quadratic];

    /// The file that keeps them.
    fn file(self) -> &'static str {
        match self {
            Self::Calculix => "crates/app/verify/references/calculix.json",
            Self::Quadratic => "crates/app/verify/references/quadratic.json",
        }
    }

    fn name(self) -> &'static str {
        match self {
            Self::Calculix => "CalculiX",
            Self::Quadratic => "quadratic elements",
        }
    }
}

/// Largest accepted error of the force.
const FORCE_LIMIT_PERCENT: f64 = 3.0;
/// Largest accepted error of the pressure at a taxel.
const PRESSURE_LIMIT_PERCENT: f64 = 5.0;
/// Largest accepted root mean square difference of the pressure along the board.
const ROUGHNESS_LIMIT_PERCENT: f64 = 3.0;

/// Compares with the kept references.
pub(crate) fn run(_: Effort) -> Result<Outcome> {
    let [calculix, quadratic] = Source::ALL.map(|source| reference::read(Path::new(source.file())));
    let (calculix, quadratic) = (calculix?, quadratic?);
    let (mut compared, mut figures) = (Vec::new(), Vec::new());
    for case in case::all() {
        let is_whole = |reference: &&Reference| reference.frames.len() == case.depths_mm.len();
        let theirs = finest(&calculix, &case);
        if let Some(theirs) = theirs {
            let ours = compare::compare(&case, theirs)?;
            // Its limits stay until a better reference is kept.
            let is_reference = is_whole(&theirs) || finest(&quadratic, &case).is_none();
            figures.extend(figures_of(&ours, Source::Calculix, is_reference));
            figures.push(nodes_of(&case, Source::Calculix, theirs));
            if is_whole(&theirs) {
                compared.push(ours);
                continue;
            }
        }
        let theirs = match finest(&quadratic, &case) {
            Some(kept) => kept.clone(),
            None => compare::quadratic(&case, Level::Coarse)?,
        };
        let ours = compare::compare(&case, &theirs)?;
        figures.extend(figures_of(&ours, Source::Quadratic, true));
        figures.push(nodes_of(&case, Source::Quadratic, &theirs));
        figures.extend(uncertainty(&quadratic, &case));
        let n_missing = (case.depths_mm.len() - theirs.frames.len()) as f64;
        let name = format!("{}: depths without a reference", case.name);
        figures.push(Figure::at_most(0.0, name, n_missing, ""));
        compared.push(ours);
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
             checkerboard pattern at ν = 0.4999 would increase it.\n\nCalculiX reaches all depths for the \
             sphere at ν = 0.49 alone. For the cylinder and the bar it solves a coarse mesh (1,400 to 1,700 \
             elements) to 1 mm, whose pressures far from the indenter are not accurate; at ν = 0.4999 it finds no \
             equilibrium. For these cases the reference is TwinTac's \
             10-node elements with a pressure field of their own, on a mesh that is {FINER} times finer and \
             fine at rims. Their difference from a coarser mesh is stated as the uncertainty of the \
             reference. Where none is stored, as now, the mesh is that of the comparison, its uncertainty is not \
             known, and the limits beside CalculiX stay.\n\nThe \
             references are stored in `{}` and `{}`; `cargo xtask verify calculix --ccx \
             CASE` (Debian package calculix-ccx, in `{}`) and `--quadratic CASE` compute them again for the \
             cases whose names start with CASE, on a coarse and on a fine mesh.",
            Source::Calculix.file(),
            Source::Quadratic.file(),
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

/// The reference of a case on its finest mesh.
fn finest<'a>(references: &'a [Reference], case: &Case) -> Option<&'a Reference> {
    let of_case = references.iter().filter(|reference| reference.case == case.name);
    of_case.max_by_key(|reference| reference.n_elements)
}

fn nodes_of(case: &Case, source: Source, reference: &Reference) -> Figure {
    let name = format!("{}: nodes of {}", case.name, source.name());
    Figure::told(name, reference.n_nodes as f64, "")
}

/// The errors of a case. Pressures have limits if `is_reference`: those of CalculiX's coarse meshes
/// have none where quadratic elements on a finer mesh are kept as the reference.
fn figures_of(compared: &Compared, source: Source, is_reference: bool) -> Vec<Figure> {
    let largest = |errors: &mut dyn Iterator<Item = f64>| errors.map(f64::abs).fold(0.0, f64::max);
    let case = match source {
        Source::Calculix => compared.case.clone(),
        Source::Quadratic => format!("{} beside {}", compared.case, source.name()),
    };
    let mut figures = vec![Figure::told(
        format!("{case}: nodes"),
        compared.n_nodes as f64,
        "",
    )];
    for frame in &compared.frames {
        let name = |what: &str| format!("{case}, {} mm: {what}", frame.depth_mm);
        figures.push(Figure::at_most(
            FORCE_LIMIT_PERCENT,
            name("force"),
            frame.force_error_percent(),
            "%",
        ));
        let mut taxels = frame
            .pressure_kpa
            .keys()
            .map(|taxel| frame.pressure_error_percent(taxel));
        let worst = largest(&mut taxels);
        let pressures = [
            ("pressure at the worst taxel", worst, PRESSURE_LIMIT_PERCENT),
            (
                "pressure along the board",
                frame.roughness_percent(),
                ROUGHNESS_LIMIT_PERCENT,
            ),
        ];
        figures.extend(pressures.map(|(what, percent, limit)| {
            if is_reference {
                Figure::at_most(limit, name(what), percent, "%")
            } else {
                Figure::told(name(what), percent, "%")
            }
        }));
    }
    figures
}

/// The uncertainty of a reference by quadratic elements: its largest differences from a coarser
/// mesh.
fn uncertainty(references: &[Reference], case: &Case) -> Vec<Figure> {
    let of = |is_fine: bool| {
        let is_it = |reference: &&Reference| reference.case == case.name && reference.is_fine == is_fine;
        references.iter().find(is_it)
    };
    let (Some(fine), Some(coarse)) = (of(true), of(false)) else {
        return Vec::new();
    };
    let [force, pressure] = coarse.largest_difference_percent(fine);
    let about = format!(
        "{}: quadratic elements, {} beside {} nodes",
        case.name, coarse.n_nodes, fine.n_nodes
    );
    vec![
        Figure::told(format!("{about}: force"), force, "%"),
        Figure::told(format!("{about}: pressure at the worst taxel"), pressure, "%"),
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

/// Computes the references of the cases whose names start with `prefix`, on two meshes each, and
/// keeps them.
pub(crate) fn compute_references(source: Source, prefix: &str) -> Result<()> {
    let file = Path::new(source.file());
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
            let found = match source {
                Source::Calculix => reference::compute(case, level)?,
                Source::Quadratic => compare::quadratic(case, level)?,
            };
            let is_same = |other: &Reference| other.case == found.case && other.is_fine == found.is_fine;
            let mut kept = reference::read(file)?;
            kept.retain(|other| !is_same(other));
            kept.push(found);
            reference::write(file, &mut kept)?;
        }
    }
    Ok(())
}
