//! Benchmark of the soft body: how fast presses are followed, and with what error.

use std::collections::BTreeMap;
use std::fmt::Write as _;
use std::io::Write;
use std::path::Path;
use std::time::Duration;

use anyhow::Result;
use serde::Serialize;
use twintac_simulate::{Followed, FollowedFrame};
use twintac_softbody::LinearSolver;

use crate::cases::{self, Case};
use crate::files;

/// Tolerance of the solver in real time.
pub(crate) const FAST: f64 = 2e-3;

/// Tolerance of the reference solution.
const TIGHT: f64 = 1e-7;

/// Fractions of the largest force, and of the largest pressure at any taxel. Errors of smaller
/// values are relative to this fraction.
const SMALLEST_FORCE: f64 = 0.01;
const SMALLEST_PRESSURE: f64 = 0.05;

/// Duration of a frame at 55 Hz, ms.
const BUDGET_MS: f64 = 1000.0 / 55.0;

/// Deadline of a frame, over the mean wall time of the same frames without one: most frames are in
/// time on any machine, and some are not.
const DEADLINE: f64 = 1.5;

/// Number of times that all presses are followed, in turns, because a machine has fast and slow
/// minutes. The median run of a press counts.
const N_ROUNDS: usize = 9;

/// Folder of the results.
const RESULTS: &str = "docs/benchmarks";

/// Fraction of the way down over which the linear solvers are compared.
const COMPARED: f64 = 0.25;

/// The result of a case.
#[derive(Serialize)]
struct Timed {
    case: &'static str,
    nodes: usize,
    tets: usize,
    nu: f64,
    /// Real-time factor: simulated time divided by wall time.
    rtf: f64,
    /// Force, N, at depths, mm.
    force_n: BTreeMap<String, f64>,
    mean_ms: f64,
    worst_ms: f64,
    /// Fraction of the frames that were solved within a frame's duration.
    in_time: f64,
    /// Time of a frame with [`LinearSolver::Direct`], which factorises the whole system for every
    /// direction on one thread, divided by the time of this project's solver. Both are measured in
    /// this run, over the first [`COMPARED`] of the way down.
    times_of_direct: f64,
    /// Largest error against the reference solution on the same mesh, %.
    force_error_percent: f64,
    pressure_error_percent: f64,
    /// The results with a deadline for each frame.
    within_deadline: Within,
}

/// The results of a case whose frames have a deadline.
#[derive(Serialize)]
struct Within {
    deadline_ms: f64,
    worst_ms: f64,
    /// Fraction of the frames that converged before the deadline.
    settled: f64,
    force_error_percent: f64,
    pressure_error_percent: f64,
    /// Largest residual: unbalanced forces, % of the load.
    residual_percent: f64,
    /// How far the indenter was behind its path at most, mm.
    behind_mm: f64,
}

/// Times all cases, prints the results and writes the page.
pub(crate) fn run(as_json: bool) -> Result<()> {
    let mut cases_timed = Vec::new();
    let mut out = std::io::stdout().lock();
    if !as_json {
        writeln!(
            out,
            "{:50} {:>5} {:>6} {:>5} {:>8} {:>8} {:>8} {:>8} {:>8} {:>8}",
            "case", "nodes", "nu", "RTF", "mean ms", "worst", "in time", "force", "pressure", "direct"
        )?;
    }
    let cases = cases::all()?;
    for (case, fast) in cases.iter().zip(median_runs(&cases)?) {
        let timed = time(case, &fast)?;
        if as_json {
            writeln!(out, "{}", serde_json::to_string(&timed)?)?;
        } else {
            writeln!(
                out,
                "{:50} {:>5} {:>6} {:>5.2} {:>8.2} {:>8.2} {:>6.1} % {:>6.2} % {:>6.2} % {:>6.1} x",
                timed.case,
                timed.nodes,
                timed.nu,
                timed.rtf,
                timed.mean_ms,
                timed.worst_ms,
                100.0 * timed.in_time,
                timed.force_error_percent,
                timed.pressure_error_percent,
                timed.times_of_direct
            )?;
            let within = &timed.within_deadline;
            writeln!(
                out,
                "{:>82} {:>8.2} {:>8} {:>6.2} % {:>6.2} %",
                format!(
                    "within {:.1} ms ({:.1} % settled, others to {:.1} % of the load, {:.2} mm behind):",
                    within.deadline_ms,
                    100.0 * within.settled,
                    within.residual_percent,
                    within.behind_mm
                ),
                within.worst_ms,
                "",
                within.force_error_percent,
                within.pressure_error_percent
            )?;
        }
        cases_timed.push(timed);
    }
    let folder = Path::new(RESULTS);
    let figures = serde_json::to_string_pretty(&cases_timed)? + "\n";
    files::write_whole(&folder.join("softbody.json"), figures.as_bytes())?;
    files::write_whole(&folder.join("softbody.md"), page(&cases_timed)?.as_bytes())
}

fn page(cases: &[Timed]) -> Result<String> {
    let mut text = format!(
        "# Presses in real time\n\n\
         Made by `cargo xtask bench softbody`.\n\n\
         Presses are followed in frames of 55 Hz on two threads; of {N_ROUNDS} runs, the one with the median time \
         counts. The real-time factor is simulated time divided by wall time. A frame is in time if it takes no \
         longer than a frame lasts, {BUDGET_MS:.1} ms. Errors are the largest of all frames, beside the same \
         mesh solved to a residual of {TIGHT:e}. All figures are `simulated`.\n\n\
         | press | nodes | ν | real-time factor | mean, ms | worst, ms | in time | force error | pressure error | \
         time with the direct solver, relative to this one |\n\
         |---|---:|---:|---:|---:|---:|---:|---:|---:|---:|\n"
    );
    for timed in cases {
        writeln!(
            text,
            "| {} | {} | {} | {:.2} | {:.1} | {:.1} | {:.1} % | {:.2} % | {:.2} % | {:.0} |",
            timed.case,
            timed.nodes,
            timed.nu,
            timed.rtf,
            timed.mean_ms,
            timed.worst_ms,
            100.0 * timed.in_time,
            timed.force_error_percent,
            timed.pressure_error_percent,
            timed.times_of_direct
        )?;
    }
    write!(
        text,
        "\nIn the next table each frame has a deadline of {DEADLINE} times the mean. It ends at the deadline, converged or not.\n\n\
         | press | ν | deadline, ms | converged | worst, ms | force error | pressure error | largest residual | \
         farthest behind the path, mm |\n\
         |---|---:|---:|---:|---:|---:|---:|---:|---:|\n"
    )?;
    for timed in cases {
        let within = &timed.within_deadline;
        writeln!(
            text,
            "| {} | {} | {:.1} | {:.1} % | {:.1} | {:.2} % | {:.2} % | {:.1} % of the load | {:.2} |",
            timed.case,
            timed.nu,
            within.deadline_ms,
            100.0 * within.settled,
            within.worst_ms,
            within.force_error_percent,
            within.pressure_error_percent,
            within.residual_percent,
            within.behind_mm
        )?;
    }
    Ok(text)
}

/// Follows each press a few times; returns the runs with the median times.
fn median_runs(cases: &[Case]) -> Result<Vec<Followed>> {
    let mut runs: Vec<Vec<Followed>> = cases.iter().map(|_| Vec::new()).collect();
    for _ in 0..N_ROUNDS {
        for (case, runs) in cases.iter().zip(&mut runs) {
            runs.push(case.follow(FAST, &mut || ())?);
        }
    }
    let total_ms = |followed: &Followed| times_ms(followed).iter().sum::<f64>();
    let median = |mut runs: Vec<Followed>| {
        runs.sort_by(|a, b| total_ms(a).total_cmp(&total_ms(b)));
        runs.swap_remove(N_ROUNDS / 2)
    };
    Ok(runs.into_iter().map(median).collect())
}

fn time(case: &Case, fast: &Followed) -> Result<Timed> {
    let tight = &case.follow(TIGHT, &mut || ())?;
    let start = case.shortened(COMPARED);
    let [ours_s, direct_s] = [LinearSolver::TwoLevel, LinearSolver::Direct].map(|linear| {
        let followed = start.follow_by(linear, FAST, &mut || ())?;
        anyhow::Ok(
            followed.frames[1..]
                .iter()
                .map(|frame| frame.wall_time_s)
                .sum::<f64>(),
        )
    });
    let times_of_direct = direct_s? / ours_s?;
    let times_ms = times_ms(fast);
    let total_s = times_ms.iter().sum::<f64>() / 1e3;
    let last = fast.frames.len() - 1;
    let simulated_s = fast.frames[last].time_s - fast.frames[0].time_s;
    let [force_error_percent, pressure_error_percent] = errors_percent(fast, tight);
    Ok(Timed {
        case: case.name,
        nodes: fast.n_nodes,
        tets: fast.n_tets,
        nu: case.poissons_ratio,
        rtf: simulated_s / total_s,
        force_n: forces(fast),
        mean_ms: 1e3 * total_s / times_ms.len() as f64,
        worst_ms: worst(&times_ms),
        times_of_direct,
        in_time: part_in_time(&times_ms),
        force_error_percent,
        pressure_error_percent,
        within_deadline: within_deadline(case, DEADLINE * total_s / times_ms.len() as f64, tight)?,
    })
}

fn within_deadline(case: &Case, deadline_s: f64, tight: &Followed) -> Result<Within> {
    let followed = case.follow_within(Duration::from_secs_f64(deadline_s), FAST)?;
    let times_ms = times_ms(&followed);
    let [force_error_percent, pressure_error_percent] = errors_percent(&followed, tight);
    let largest = |of: &dyn Fn(&FollowedFrame) -> f64| followed.frames.iter().map(of).fold(0.0, f64::max);
    let settled = followed.frames.iter().filter(|frame| frame.converged).count();
    Ok(Within {
        deadline_ms: 1e3 * deadline_s,
        worst_ms: worst(&times_ms),
        settled: settled as f64 / times_ms.len() as f64,
        force_error_percent,
        pressure_error_percent,
        residual_percent: 100.0 * largest(&|frame| frame.quality.residual),
        behind_mm: largest(&|frame| frame.behind_mm),
    })
}

/// Wall times of all frames, ms.
fn times_ms(followed: &Followed) -> Vec<f64> {
    followed
        .frames
        .iter()
        .map(|frame| 1e3 * frame.wall_time_s)
        .collect()
}

fn worst(values: &[f64]) -> f64 {
    values.iter().copied().fold(0.0, f64::max)
}

/// Fraction of the frames that were solved within a frame's duration.
fn part_in_time(times_ms: &[f64]) -> f64 {
    let in_time = times_ms.iter().filter(|time| **time <= BUDGET_MS).count();
    in_time as f64 / times_ms.len() as f64
}

/// Largest errors of force and pressure against the reference solution, %.
fn errors_percent(fast: &Followed, tight: &Followed) -> [f64; 2] {
    let force = |followed: &Followed, frame: usize| vec![followed.frames[frame].force_n.length()];
    let pressures = |followed: &Followed, frame: usize| -> Vec<f64> {
        followed.frames[frame].pressure_kpa.values().copied().collect()
    };
    [
        100.0 * largest_error(fast, tight, SMALLEST_FORCE, force),
        100.0 * largest_error(fast, tight, SMALLEST_PRESSURE, pressures),
    ]
}

/// Largest relative error over all frames. Errors of small values are relative to a fraction of the
/// largest value.
fn largest_error(
    fast: &Followed,
    tight: &Followed,
    smallest: f64,
    values: impl Fn(&Followed, usize) -> Vec<f64>,
) -> f64 {
    let n_frames = fast.frames.len();
    let largest = |found: f64, value: f64| found.max(value.abs());
    let peak = (0..n_frames)
        .flat_map(|frame| values(tight, frame))
        .fold(0.0, largest);
    (0..n_frames)
        .flat_map(|frame| values(fast, frame).into_iter().zip(values(tight, frame)))
        .map(|(fast, tight)| (fast - tight) / tight.abs().max(smallest * peak))
        .fold(0.0, largest)
}

/// Forces at 0.5, 1 and 2 mm on the way down, interpolated linearly between frames.
pub(crate) fn forces(followed: &Followed) -> BTreeMap<String, f64> {
    let start_mm = followed.frames[0].position_mm.z;
    let depth_mm = |frame: usize| start_mm - followed.frames[frame].position_mm.z;
    let mut found = BTreeMap::new();
    for wanted_mm in [0.5, 1.0, 2.0] {
        let pair = (1..followed.frames.len()).find(|&frame| depth_mm(frame) >= wanted_mm - 1e-9);
        if let Some(after) = pair {
            let (from, to) = (depth_mm(after - 1), depth_mm(after));
            let part = (wanted_mm - from) / (to - from);
            let force = |frame: usize| -followed.frames[frame].force_n.z;
            let between = force(after - 1) + part * (force(after) - force(after - 1));
            found.insert(format!("{wanted_mm:.1}"), between);
        }
    }
    found
}
