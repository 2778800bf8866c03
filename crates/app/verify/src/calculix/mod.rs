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

use anyhow::{Context, Result, ensure};
use twintac_plot::{Ink, Scene};
use twintac_plot::{Panel, Panels};

use crate::rung::{Effort, Figure, Outcome, Plot, plots};
use case::{Case, LINE_Y_MM, Level, line_mm};
use compare::Compared;
use reference::Reference;

/// Where references come from.
#[derive(Clone, Copy)]
pub(crate) enum Source {
    /// The independent program.
    Calculix,
    /// This project's solver on meshes that are finer and of elements that bend everywhere.
    Finer,
}

impl Source {
    const ALL: [Self; 2] = [Self::Calculix, Self::Finer];

    /// The file that keeps them.
    fn file(self) -> &'static str {
        match self {
            Self::Calculix => "crates/app/verify/references/calculix.json",
            Self::Finer => "crates/app/verify/references/finer.json",
        }
    }

    fn name(self) -> &'static str {
        match self {
            Self::Calculix => "CalculiX",
            Self::Finer => "finer meshes",
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
    let [calculix, finer] = Source::ALL.map(|source| reference::read(Path::new(source.file())));
    let (calculix, finer) = (calculix?, finer?);
    let (mut compared, mut figures) = (Vec::new(), Vec::new());
    for case in case::all() {
        if let Some(theirs) = finest(&calculix, &case) {
            let is_whole = theirs.frames.len() == case.depths_mm.len();
            let ours = compare::compare(&case, theirs)?;
            figures.extend(figures_of(&ours, Source::Calculix, is_whole));
            figures.push(nodes_of(&case, Source::Calculix, theirs));
            let is_coarser = |other: &&Reference| other.case == case.name && other.n_nodes < theirs.n_nodes;
            for coarser in calculix.iter().filter(is_coarser) {
                figures.extend(uncertainty(&case, coarser, "CalculiX", theirs));
            }
            if is_whole {
                compared.push(ours);
                continue;
            }
        }
        let is_it = |reference: &&Reference| reference.case == case.name;
        let meshes: Vec<&Reference> = finer.iter().filter(is_it).collect();
        let theirs = Reference::mean(&meshes).with_context(|| {
            format!(
                "no reference of {0} is kept; `cargo xtask verify calculix --finer {0}` computes it",
                case.name
            )
        })?;
        let ours = compare::compare(&case, &theirs)?;
        figures.extend(figures_of(&ours, Source::Finer, true));
        for mesh in meshes {
            figures.extend(uncertainty(&case, mesh, "finer", &theirs));
        }
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
             sphere at ν = 0.49 alone, on a coarse and on a fine mesh. For the cylinder and the bar it \
             solves a coarse mesh (1,400 to 1,700 elements) to 1 mm, whose force has a limit, but whose \
             pressures far from the indenter are not accurate; at ν = 0.4999 it finds no equilibrium. For these cases the reference is TwinTac's own \
             solver with elements that are quadratic everywhere, on three meshes that are finer, also at \
             rims: the mean of the three. How far each mesh is from the reference shows how large its own \
             error may be.\n\nThe \
             references are stored in `{}` and `{}`; `cargo xtask verify calculix --ccx \
             CASE` (Debian package calculix-ccx, in `{}`) and `--finer CASE` compute them again for the \
             cases whose names start with CASE.",
            Source::Calculix.file(),
            Source::Finer.file(),
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
/// have none.
fn figures_of(compared: &Compared, source: Source, is_reference: bool) -> Vec<Figure> {
    let largest = |errors: &mut dyn Iterator<Item = f64>| errors.map(f64::abs).fold(0.0, f64::max);
    let case = match source {
        Source::Calculix => compared.case.clone(),
        Source::Finer => format!("{} beside {}", compared.case, source.name()),
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

/// The largest differences of a mesh of this kind from the reference.
fn uncertainty(case: &Case, mesh: &Reference, kind: &str, reference: &Reference) -> [Figure; 2] {
    let [force, pressure] = mesh.largest_difference_percent(reference);
    let about = format!(
        "{}: {kind} mesh of {} nodes from the reference",
        case.name, mesh.n_nodes
    );
    [
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
                        ..plots::dashes("CalculiX, or finer meshes", 0, points)
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

/// Computes the references of the cases whose names start with `prefix`, on several meshes each,
/// and keeps them.
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
        let found = match source {
            Source::Calculix => [Level::Coarse, Level::Fine]
                .map(|level| reference::compute(case, level))
                .into_iter()
                .collect::<Result<_>>()?,
            Source::Finer => compare::finer(case)?,
        };
        let mut kept = reference::read(file)?;
        kept.retain(|other| other.case != case.name);
        kept.extend(found);
        reference::write(file, &mut kept)?;
    }
    Ok(())
}
