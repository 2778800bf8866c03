//! Random presses. Each has to converge, or to end in a typed error; none may return a wrong state.

use std::collections::BTreeSet;
use std::sync::Arc;

use anyhow::{Context, Result};
use glam::DVec3;
use indicatif::{ProgressBar, ProgressStyle};
use rayon::prelude::*;
use twintac_plot::Series;
use twintac_sensor::Sensor;
use twintac_shape::{Pose, SignedDistance};
use twintac_simulate::{FORCE_MAY_FALL_TO, Gel, SimulateSettings};
use twintac_softbody::{Frame, SoftBody, SolveError, State};

use super::random_press::{ENOUGH_N, RandomPress, draw, draw_thin};
use crate::rung::{Effort, Figure, Outcome, Plot, plots};

const SEED: u64 = 10;

/// Largest motion between two frames, mm.
const STEP_MM: f64 = 0.4;

/// Largest accepted imbalance of a frame, relative to the indenter's force: many times the solver's
/// tolerance.
const UNBALANCED: f64 = 0.01;

/// Presses with smaller forces are not compared, N.
const LEAST_N: f64 = 0.1;

/// Presses of one kind, on one kind of mesh.
struct Set {
    name: &'static str,
    settings: SimulateSettings,
    /// Settings of the finer mesh that decides about presses whose force falls.
    finer: SimulateSettings,
    draw: fn(&Sensor, u64, u64) -> Result<RandomPress>,
    n_presses: u64,
    /// Number of presses that are also solved on a finer mesh for comparison.
    n_compared: u64,
    /// Smallest accepted percentage of presses that reach their depth, meet something rigid, or end
    /// where their force falls.
    least_solved_percent: f64,
    /// Largest accepted percentage of presses whose force falls although that on a finer mesh does
    /// not.
    most_fell_percent: f64,
}

/// How a press ended.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord)]
enum End {
    /// At its depth, or at a force that is large enough.
    Converged,
    /// The indenter met the shell or the board, which bear any load.
    Stopped,
    /// The force fell as the depth increased, on a finer mesh too: the indenter slid off the gel.
    SlidOff,
    /// The force fell as the depth increased, on this mesh alone.
    Fell,
    /// With a typed error; the last good state is kept.
    Failed(&'static str),
    /// With a result that no solver may return.
    Wrong(&'static str),
}

impl End {
    /// Whether the press ended as expected, as far as the mesh shows.
    fn is_well(&self) -> bool {
        matches!(self, Self::Converged | Self::Stopped | Self::SlidOff)
    }

    /// Whether the solver found all requested equilibria.
    fn is_solved(&self) -> bool {
        self.is_well() || *self == Self::Fell
    }
}

/// The result of a press.
struct Pressed {
    index: u64,
    indenter: String,
    end: End,
    wanted_mm: f64,
    depth_mm: f64,
    force_n: f64,
    /// Forces of all frames, N.
    forces_n: Vec<f64>,
    /// Newton iterations of each frame.
    iterations: Vec<u32>,
    smallest_volume_ratio: f64,
    n_nodes: usize,
    error: String,
}

// long: each figure of the record in its turn
pub(super) fn run(effort: Effort) -> Result<Outcome> {
    let sensor = Sensor::read("sensors/phystac.toml").context("run this where the folder `sensors` is")?;
    let bare = Sensor {
        shell: None,
        ..sensor.clone()
    };
    let sensors = [Arc::new(sensor), Arc::new(bare)];
    let coarse = SimulateSettings {
        edges_per_height: 4.0,
        edges_per_contact_radius: 2.0,
        max_nodes: 900,
        ..SimulateSettings::fine()
    };
    let fine = SimulateSettings {
        max_nodes: 7300,
        ..SimulateSettings::fine()
    };
    let finest = SimulateSettings {
        edges_per_contact_radius: 12.0,
        max_nodes: 30_000,
        ..SimulateSettings::fine()
    };
    let sets = [
        Set {
            name: "a coarse mesh",
            settings: coarse.clone(),
            finer: fine.clone(),
            draw,
            n_presses: effort.choose(300, 10_000),
            n_compared: 0,
            least_solved_percent: 99.5,
            most_fell_percent: 5.0,
        },
        Set {
            name: "the paper's mesh",
            settings: fine.clone(),
            finer: finest.clone(),
            draw,
            n_presses: effort.choose(4, 200),
            n_compared: 0,
            least_solved_percent: 99.5,
            most_fell_percent: 0.5,
        },
        Set {
            name: "thin bodies, a coarse mesh",
            settings: coarse,
            finer: fine.clone(),
            draw: draw_thin,
            n_presses: effort.choose(60, 1000),
            n_compared: 0,
            least_solved_percent: 40.0,
            most_fell_percent: 5.0,
        },
        Set {
            name: "thin bodies, the paper's mesh",
            settings: fine,
            finer: finest,
            draw: draw_thin,
            n_presses: effort.choose(8, 100),
            n_compared: effort.choose(0, 20),
            least_solved_percent: 40.0,
            most_fell_percent: 2.0,
        },
    ];
    let mut figures = Vec::new();
    let mut histograms = Histograms::default();
    let mut done = format!(
        "Every other press is on the sensor with its shell, the others on its gel alone. Half of the \
         presses use an indenter of the sensor, the other half a random sphere, cylinder, box or cone with \
         rounded edges. Each indenter starts anywhere above the gel, tilted by up to 20°, and moves from \
         first touch in frames of at most {STEP_MM} mm to a depth of 10 to 70 % of the gel's thickness, to \
         {ENOUGH_N} N, or until it meets the shell or the board. A frame counts as wrong, whatever the \
         solver reports, if a number is not finite, a tetrahedron is inside out, a node is too deep inside \
         a shape, or the forces do not balance within {} %. An error after which the state differs from the \
         state before it counts as wrong, too. A press ends where its force falls by more than {:.0} % \
         while the depth increases, as a table over depth does; it counts as slid off the gel if it ends in \
         the same way on a finer mesh, otherwise as failed. Thin bodies are plates, rings, blades and pins \
         of 0.2 to 3 mm, wedges, cups, brackets and crosses of several bodies, pressed to a third of the \
         thickness at most; those that are too thin for the mesh must end in an error that says so. Seed \
         {SEED}.\n",
        100.0 * UNBALANCED,
        100.0 * (1.0 - FORCE_MAY_FALL_TO)
    );
    for (color, set) in sets.iter().enumerate() {
        let gels_of = |settings: &SimulateSettings| {
            let gel = |sensor: &Arc<Sensor>| Gel::new(Arc::clone(sensor), settings.clone());
            sensors.each_ref().map(gel)
        };
        let (gels, finer) = (gels_of(&set.settings), gels_of(&set.finer));
        let all = press_all(set, &gels, &finer, set.n_presses)?;
        figures.extend(figures_of(set, &all));
        if set.n_compared > 0 {
            let compared = (0..set.n_compared)
                .into_par_iter()
                .map(|index| press_drawn(set, &finer, index))
                .collect::<Result<Vec<_>>>()?;
            figures.extend(differences(set, &all, &compared));
        }
        done.push_str(&failures(set.name, &all));
        histograms.add(set.name, color, &all);
    }
    Ok(Outcome {
        done,
        figures,
        plots: histograms.plots(),
    })
}

/// Numbers of presses of a set by how they ended.
fn figures_of(set: &Set, all: &[Pressed]) -> Vec<Figure> {
    let name = set.name;
    let percent_of = |is_it: &dyn Fn(&End) -> bool| {
        100.0 * all.iter().filter(|press| is_it(&press.end)).count() as f64 / all.len() as f64
    };
    let n_nodes = all.iter().map(|press| press.n_nodes).sum::<usize>() / all.len();
    let told =
        |what: &str, end: &End| Figure::told(format!("{name}: {what}"), percent_of(&|it| it == end), "%");
    let mut figures = vec![
        Figure::at_least(
            set.least_solved_percent,
            format!(
                "{name}: {} presses, {n_nodes} nodes: solved to their end",
                all.len()
            ),
            percent_of(&End::is_solved),
            "%",
        ),
        told("of these stopped by the shell or the board", &End::Stopped),
        told("of these slid off the gel, as on a finer mesh", &End::SlidOff),
        Figure::at_most(
            set.most_fell_percent,
            format!("{name}: force fell on this mesh alone"),
            percent_of(&|end| *end == End::Fell),
            "%",
        ),
    ];
    let kinds: BTreeSet<&End> = all.iter().map(|press| &press.end).collect();
    for end in kinds {
        if let End::Failed(kind) = end {
            figures.push(told(kind, end));
        }
    }
    let wrong = percent_of(&|end| matches!(end, End::Wrong(_)));
    figures.push(Figure::at_most(0.0, format!("{name}: wrong answers"), wrong, "%"));
    figures
}

/// Differences of forces from those on a finer mesh, at the last depth that both reach.
fn differences(set: &Set, all: &[Pressed], finer: &[Pressed]) -> Vec<Figure> {
    let difference = |(coarse, fine): (&Pressed, &Pressed)| {
        let frame = coarse.forces_n.len().min(fine.forces_n.len()).checked_sub(1)?;
        let [coarse_n, fine_n] = [coarse.forces_n[frame], fine.forces_n[frame]];
        (fine_n > LEAST_N).then_some(100.0 * (coarse_n / fine_n - 1.0).abs())
    };
    let mut percent: Vec<f64> = all.iter().zip(finer).filter_map(difference).collect();
    percent.sort_by(f64::total_cmp);
    let at = |part: f64| percent.get((part * percent.len() as f64) as usize).copied();
    let figure = |limit, what: &str, value: Option<f64>| {
        let name = format!(
            "{}: force beside that of a finer mesh, {what} of {}",
            set.name,
            percent.len()
        );
        Figure::at_most(limit, name, value.unwrap_or(f64::NAN), "%")
    };
    vec![
        figure(6.0, "the median", at(0.5)),
        figure(25.0, "nine of ten", at(0.9)),
    ]
}

/// Histograms, with a line for each set of presses.
#[derive(Default)]
struct Histograms {
    iterations: Vec<Series>,
    volume_ratios: Vec<Series>,
    depths: Vec<Series>,
}

impl Histograms {
    fn add(&mut self, set: &str, color: usize, all: &[Pressed]) {
        let frames = all.iter().flat_map(|press| &press.iterations);
        let per_frame: Vec<f64> = frames.map(|count| f64::from(*count)).collect();
        let smallest: Vec<f64> = all.iter().map(|press| press.smallest_volume_ratio).collect();
        let reached: Vec<f64> = all.iter().map(|press| press.depth_mm).collect();
        let histogram = |values: &[f64], range, n_bins| plots::histogram(set, color, values, range, n_bins);
        self.iterations.push(histogram(&per_frame, [0.0, 60.0], 30));
        self.volume_ratios.push(histogram(&smallest, [0.0, 1.0], 25));
        self.depths.push(histogram(&reached, [0.0, 6.0], 24));
    }

    fn plots(self) -> Vec<Plot> {
        let plot = |name, title, x_label, caption: &str, series| Plot {
            name,
            caption: caption.into(),
            scene: plots::lines(title, [x_label, "number"], true, series),
        };
        vec![
            plot(
                "iterations",
                "Newton iterations of a frame",
                "iterations; the last bin includes more",
                "All frames of all presses.",
                self.iterations,
            ),
            plot(
                "volume-ratio",
                "Smallest volume ratio of a press",
                "J",
                "Of any tetrahedron in any frame of a press; 0 would be flat.",
                self.volume_ratios,
            ),
            plot(
                "depth",
                "Depth reached",
                "depth, mm",
                "Depths at which presses ended: at their random depth, at 200 N, or with an error.",
                self.depths,
            ),
        ]
    }
}

fn press_all(set: &Set, gels: &[Gel; 2], finer: &[Gel; 2], n_presses: u64) -> Result<Vec<Pressed>> {
    let style = ProgressStyle::with_template("{prefix:>16} [{bar:30}] {pos}/{len} {elapsed}, {eta} left")?;
    let bar = ProgressBar::new(n_presses)
        .with_style(style)
        .with_prefix(set.name);
    let all = (0..n_presses)
        .into_par_iter()
        .map(|index| {
            let mut pressed = press_drawn(set, gels, index)?;
            if pressed.end == End::Fell {
                let on_finer = press_drawn(set, finer, index)?;
                pressed.error = format!(
                    "forces {:.2?} N, on a finer mesh {:.2?} N",
                    pressed.forces_n, on_finer.forces_n
                );
                if on_finer.end == End::Fell {
                    pressed.end = End::SlidOff;
                }
            }
            bar.inc(1);
            Ok(pressed)
        })
        .collect();
    bar.finish_and_clear();
    all
}

fn press_drawn(set: &Set, gels: &[Gel; 2], index: u64) -> Result<Pressed> {
    let gel = &gels[index as usize % 2];
    (set.draw)(gel.sensor(), SEED, index)
        .and_then(|drawn| press(gel, &drawn, index))
        .with_context(|| format!("press {index} of seed {SEED}"))
}

fn press(gel: &Gel, press: &RandomPress, index: u64) -> Result<Pressed> {
    let (place, indenter) = (&press.place, press.indenter.as_ref());
    let mesh = gel.mesh(place)?;
    let body = mesh.body();
    let above = Pose {
        position_mm: DVec3::new(place.x_mm, place.y_mm, 2.0 * gel.height_mm()),
        rotation: place.rotation,
    };
    let touch = lowered(body, indenter, above);
    let mut pressed = Pressed {
        index,
        indenter: place.indenter.clone(),
        end: End::Converged,
        wanted_mm: place.depth_mm,
        depth_mm: 0.0,
        force_n: 0.0,
        forces_n: Vec::new(),
        iterations: Vec::new(),
        smallest_volume_ratio: 1.0,
        n_nodes: body.mesh().nodes_mm.len(),
        error: String::new(),
    };
    let mut state = body.rest();
    let n_frames = (place.depth_mm / STEP_MM).ceil() as u32;
    for frame in 1..=n_frames {
        let depth_mm = place.depth_mm * f64::from(frame) / f64::from(n_frames);
        let pose = Pose {
            position_mm: touch.position_mm - DVec3::Z * depth_mm,
            ..touch
        };
        let before = state.displacements_mm().to_vec();
        match body.advance(&mut state, indenter, &pose, 0.0) {
            Ok(frame) => {
                pressed.iterations.push(frame.iterations);
                match check(body, &state, &frame) {
                    Ok(smallest) => {
                        pressed.smallest_volume_ratio = pressed.smallest_volume_ratio.min(smallest);
                    }
                    Err(what) => {
                        pressed.end = End::Wrong(what);
                        return Ok(pressed);
                    }
                }
                let most_n = pressed.forces_n.iter().copied().fold(0.0, f64::max);
                (pressed.depth_mm, pressed.force_n) = (depth_mm, -frame.indenter_force_n.z);
                pressed.forces_n.push(pressed.force_n);
                if pressed.force_n < FORCE_MAY_FALL_TO * most_n {
                    pressed.end = End::Fell;
                    return Ok(pressed);
                }
                if pressed.force_n >= ENOUGH_N {
                    return Ok(pressed);
                }
            }
            Err(error) => {
                pressed.error = error.to_string();
                pressed.end = if state.displacements_mm() != before {
                    End::Wrong("an error that changed the state")
                } else if matches!(error, SolveError::Blocked { .. }) {
                    End::Stopped
                } else {
                    End::Failed(kind(&error))
                };
                return Ok(pressed);
            }
        }
    }
    Ok(pressed)
}

/// Lowers an indenter until it touches a node of the body at rest.
fn lowered(body: &SoftBody, indenter: &dyn SignedDistance, mut pose: Pose) -> Pose {
    let mesh = body.mesh();
    for _ in 0..200 {
        let gap_mm = mesh
            .sets
            .free
            .iter()
            .map(|&node| pose.inverse_transform_point(mesh.nodes_mm[node as usize]))
            .map(|at_mm| indenter.signed_distance(at_mm).distance_mm)
            .fold(f64::INFINITY, f64::min);
        if gap_mm < 1e-3 {
            break;
        }
        pose.position_mm.z -= gap_mm;
    }
    pose
}

fn kind(error: &SolveError) -> &'static str {
    match error {
        SolveError::NotConverged { .. } => "not converged",
        SolveError::Inverted { .. } => "inside out",
        SolveError::Singular { .. } => "singular",
        SolveError::PassedThrough { .. } => "passed through",
        SolveError::Pulled { .. } => "slipped around",
        SolveError::Blocked { .. } => "blocked",
        SolveError::ForceNotReached { .. } => "force not reached",
        SolveError::Input { .. } => "refused",
    }
}

/// The smallest volume ratio, recomputed from the displacements; or what is wrong with a frame.
fn check(body: &SoftBody, state: &State, frame: &Frame) -> Result<f64, &'static str> {
    let rest = body.mesh();
    let mut now = rest.clone();
    for (at, moved) in now.nodes_mm.iter_mut().zip(state.displacements_mm()) {
        *at += *moved;
    }
    let is_finite = frame.indenter_force_n.is_finite()
        && now.nodes_mm.iter().all(|at| at.is_finite())
        && body
            .pressure_kpa(state)
            .iter()
            .all(|pressure| pressure.is_finite());
    if !is_finite {
        return Err("not a number");
    }
    let smallest = (0..rest.tets.len())
        .map(|tet| now.tet_volume_mm3(tet) / rest.tet_volume_mm3(tet))
        .fold(f64::INFINITY, f64::min);
    if smallest <= 0.0 {
        return Err("inside out");
    }
    if frame.penetration_mm > 0.0051 {
        return Err("a node too deep");
    }
    let sum = frame.indenter_force_n + frame.board_reaction_n + frame.obstacle_reaction_n;
    let load_n = frame.indenter_force_n.length();
    if sum.length() > UNBALANCED * load_n.max(1e-3) {
        return Err("out of balance");
    }
    Ok(smallest)
}

/// A list of the first presses that did not converge.
fn failures(set: &str, all: &[Pressed]) -> String {
    let failed: Vec<&Pressed> = all.iter().filter(|press| !press.end.is_well()).collect();
    let mut text = String::new();
    if !failed.is_empty() {
        text = format!("\nOf the presses on {set}, {} did not converge", failed.len());
        text.push_str(if failed.len() > 12 {
            "; the first are\n\n"
        } else {
            ":\n\n"
        });
    }
    for press in failed.into_iter().take(12) {
        let what = match &press.end {
            End::Wrong(what) => what,
            _ => press.error.as_str(),
        };
        text.push_str(&format!(
            "- press {}, {}, beyond {:.2} of {:.2} mm and {:.1} N: {what}\n",
            press.index, press.indenter, press.depth_mm, press.wanted_mm, press.force_n
        ));
    }
    text
}
