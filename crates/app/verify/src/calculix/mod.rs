//! The same presses in CalculiX, an independent finite-element program.

mod bricks;
mod case;
mod deck;
mod face;
mod ours;
mod output;
mod plan;
mod pressed;
mod reference;
mod rigid;

use std::path::Path;

use anyhow::{Context, Result, ensure};
use twintac_plot::{Ink, Scene};
use twintac_plot::{Panel, Panels};

use crate::rung::{Effort, Figure, Outcome, Plot, plots};
use case::{Case, LINE_Y_MM, Level, line_mm};
use pressed::{Difference, Pressed};

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
    let (mut plotted, mut figures) = (Vec::new(), Vec::new());
    for case in case::all() {
        let ours = ours::solve(&case)?;
        figures.push(Figure::told(
            format!("{}: nodes", case.name),
            ours.n_nodes as f64,
            "",
        ));
        let of_case = |all: &[Pressed]| -> Vec<Pressed> {
            let meshes = all.iter().filter(|mesh| mesh.case == case.name);
            meshes.cloned().collect()
        };
        let mut calculix = of_case(&calculix);
        calculix.sort_by_key(|mesh| mesh.n_elements);
        let independent = calculix.pop();
        if let Some(reference) = &independent {
            figures.extend(figures_of(&case.name, &ours, reference, Some(&calculix))?);
            let name = format!("{}: nodes of CalculiX", case.name);
            figures.push(Figure::told(name, reference.n_nodes as f64, ""));
            figures.extend(uncertainty("CalculiX", reference, &calculix));
        }
        let finer = of_case(&finer);
        let reference = Pressed::mean(&finer.iter().collect::<Vec<_>>()).with_context(|| {
            format!(
                "no reference of {0} is kept; `cargo xtask verify calculix --finer {0}` computes it",
                case.name
            )
        })?;
        let title = format!("{} beside {}", case.name, Source::Finer.name());
        figures.extend(figures_of(&title, &ours, &reference, None)?);
        figures.extend(uncertainty("finer", &reference, &finer));
        let whole = independent.filter(|reference| reference.frames.len() == ours.frames.len());
        plotted.push([ours, whole.unwrap_or(reference)]);
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
             solves a coarse mesh (1,400 to 1,700 elements) to 1 mm; at ν = 0.4999 it finds no \
             equilibrium. Its force has a limit in all cases. A pressure has one where its two meshes \
             differ by less than that limit.\n\nThe second reference, of all cases, is TwinTac's own \
             solver with elements that are quadratic everywhere, on three meshes that are finer, also at \
             rims: the mean of the three. How far each mesh is from a reference shows how large its own \
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
                plotted
                    .iter()
                    .map(|[ours, _]| ours.case.as_str())
                    .collect::<Vec<_>>()
                    .join(", ")
            ),
            scene: plot(&plotted),
        }],
    })
}

/// The differences from a reference. If other meshes of it are given, pressures have limits only
/// where these differ from it by less.
fn figures_of(
    title: &str,
    ours: &Pressed,
    reference: &Pressed,
    others: Option<&[Pressed]>,
) -> Result<Vec<Figure>> {
    let mut figures = Vec::new();
    for (index, (frame, theirs)) in ours.frames.iter().zip(&reference.frames).enumerate() {
        ensure!(
            frame.depth_mm == theirs.depth_mm && frame.line_kpa.len() == theirs.line_kpa.len(),
            "{title}: the reference has other depths or points; compute it again"
        );
        let name = |what: &str| format!("{title}, {} mm: {what}", frame.depth_mm);
        let error = frame.difference(theirs);
        let doubts = others.map(|others| -> Vec<Difference> {
            let frames = others.iter().filter_map(|other| other.frames.get(index));
            frames.map(|other| other.difference(theirs)).collect()
        });
        let force = name("force");
        figures.push(Figure::at_most(FORCE_LIMIT_PERCENT, force, error.force, "%"));
        type Part = fn(&Difference) -> f64;
        let pressures: [(&str, Part, f64); 2] = [
            (
                "pressure at the worst taxel",
                |of| of.worst_taxel,
                PRESSURE_LIMIT_PERCENT,
            ),
            (
                "pressure along the board",
                |of| of.along_board,
                ROUGHNESS_LIMIT_PERCENT,
            ),
        ];
        figures.extend(pressures.map(|(what, part, limit)| {
            let is_known = |doubts: &Vec<Difference>| {
                !doubts.is_empty() && doubts.iter().all(|doubt| part(doubt) < limit)
            };
            match doubts.as_ref().is_none_or(is_known) {
                true => Figure::at_most(limit, name(what), part(&error), "%"),
                false => Figure::told(name(what), part(&error), "%"),
            }
        }));
    }
    Ok(figures)
}

/// The largest differences of the other meshes from a reference.
fn uncertainty<'a>(
    kind: &'a str,
    reference: &'a Pressed,
    others: &'a [Pressed],
) -> impl Iterator<Item = Figure> + 'a {
    others.iter().flat_map(move |mesh| {
        let largest = mesh.largest_difference(reference);
        let (case, n_nodes) = (&mesh.case, mesh.n_nodes);
        let about = format!("{case}: {kind} mesh of {n_nodes} nodes from the reference");
        [
            ("force", largest.force),
            ("pressure at the worst taxel", largest.worst_taxel),
            ("pressure along the board", largest.along_board),
        ]
        .map(|(what, percent)| Figure::told(format!("{about}: {what}"), percent, "%"))
    })
}

/// The plot of the pressure along the board in this project's solver and the reference.
fn plot(plotted: &[[Pressed; 2]]) -> Scene {
    let panel = |both: &[Pressed; 2]| {
        let series = |side: usize| {
            both[side].frames.iter().map(move |frame| {
                let pressures = line_mm().into_iter().zip(&frame.line_kpa);
                let points = pressures.map(|(at, &kpa)| [at.x, kpa]).collect();
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
            name: both[0].case.replace("-nu", ", ν 0."),
            y_label: "kPa".to_owned(),
            series: series(0).chain(series(1)).collect(),
            y_range: None,
        }
    };
    Panels {
        title: format!("Pressure on the board along y = {LINE_Y_MM} mm at each depth"),
        x_label: "x, mm".to_owned(),
        panels: plotted.iter().map(panel).collect(),
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
            Source::Finer => ours::finer(case)?,
        };
        let mut kept = reference::read(file)?;
        kept.retain(|other| other.case != case.name);
        kept.extend(found);
        reference::write(file, &mut kept)?;
    }
    Ok(())
}
