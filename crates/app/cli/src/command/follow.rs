//! `twintac simulate --path`: force and pressures along a path.

use std::io::Write;
use std::path::Path;

use anyhow::Result;
use twintac_run::simulated::SimulatedPath;
use twintac_simulate::{Followed, FollowedFrame, Gel};

use crate::progress::Bars;

/// Follows a path and prints what came of it.
pub(super) fn run(gel: &Gel, path: &Path, as_json: bool, with_profile: bool) -> Result<()> {
    let simulated = SimulatedPath::follow(gel, path, &Bars::default())?;
    let followed = &simulated.followed;
    let mut out = std::io::stdout().lock();
    if as_json {
        serde_json::to_writer_pretty(&mut out, &simulated)?;
        writeln!(out)?;
    } else {
        write_table(&mut out, followed)?;
    }
    if with_profile {
        write_profile(&mut std::io::stderr().lock(), followed)?;
    }
    match &followed.failure {
        Some(failure) => anyhow::bail!(
            "{}: the path could not be followed to its end: {failure}; the {} frames printed are good",
            path.display(),
            followed.frames.len()
        ),
        None => Ok(()),
    }
}

/// Comma-separated columns with their units.
fn write_table(out: &mut dyn Write, followed: &Followed) -> Result<()> {
    let names = followed.frames.first().map(|frame| frame.pressure_kpa.keys());
    write!(
        out,
        "provenance,time_s,x_mm,y_mm,z_mm,force_x_n,force_y_n,force_z_n"
    )?;
    for name in names.into_iter().flatten() {
        write!(out, ",{name}_kpa")?;
    }
    writeln!(out)?;
    for frame in &followed.frames {
        let (at, force) = (frame.position_mm, frame.force_n);
        write!(out, "simulated,{},{},{},{}", frame.time_s, at.x, at.y, at.z)?;
        write!(out, ",{:.6},{:.6},{:.6}", force.x, force.y, force.z)?;
        for pressure_kpa in frame.pressure_kpa.values() {
            write!(out, ",{pressure_kpa:.5}")?;
        }
        writeln!(out)?;
    }
    Ok(())
}

/// What frames spend their time on, a line each.
fn write_profile(out: &mut dyn Write, followed: &Followed) -> Result<()> {
    let sum = |of: &dyn Fn(&FollowedFrame) -> f64| followed.frames.iter().map(of).sum::<f64>();
    let total_s = sum(&|frame| frame.wall_time_s);
    let parts = [
        ("forces", sum(&|frame| frame.cost.forces_s)),
        ("contact", sum(&|frame| frame.cost.contact_s)),
        ("assembly", sum(&|frame| frame.cost.assembly_s)),
        ("factors", sum(&|frame| frame.cost.factorisation_s)),
        ("linear solve", sum(&|frame| frame.cost.linear_solve_s)),
    ];
    let rest_s = total_s - parts.iter().map(|(_, part_s)| part_s).sum::<f64>();
    let n_frames = followed.frames.len().max(1) as f64;
    let lines = parts.into_iter().chain([("the rest", rest_s), ("all", total_s)]);
    for (name, part_s) in lines {
        let share = 100.0 * part_s / total_s.max(f64::MIN_POSITIVE);
        writeln!(
            out,
            "{name:<13} {:>8.3} ms a frame {share:>6.1} %",
            1e3 * part_s / n_frames
        )?;
    }
    let iterations = sum(&|frame| f64::from(frame.quality.iterations));
    let linear = sum(&|frame| f64::from(frame.cost.linear_iterations));
    writeln!(
        out,
        "{} nodes, {} tetrahedra; {:.2} Newton iterations a frame, {:.2} of conjugate gradients",
        followed.n_nodes,
        followed.n_tets,
        iterations / n_frames,
        linear / n_frames
    )?;
    Ok(())
}
