//! `twintac simulate --path`: force and pressures along a path.

use std::io::Write;
use std::path::Path;

use anyhow::Result;
use twintac_gel::simulated::SimulatedPath;
use twintac_recording::Provenance;
use twintac_sensor::Sensor;
use twintac_simulate::{Followed, FollowedFrame, Gel};
use twintac_work::Progress;

use crate::arguments::Simulate;
use crate::output::{print, print_csv};
use crate::progress::Bars;

/// Follows a path and prints the result.
pub(super) fn run(gel: &Gel, path: &Path, arguments: &Simulate) -> Result<()> {
    let simulated = SimulatedPath::follow(gel, path, &Bars::default())?;
    let followed = &simulated.followed;
    if arguments.json {
        print(&serde_json::to_string_pretty(&simulated)?)?;
    } else {
        print_csv(table(&simulated, gel.sensor(), arguments.deadline_ms.is_some()))?;
    }
    if let Some(note) = beyond_limits(followed, gel.sensor()) {
        Bars::default().note(&format!("{}: {note}", path.display()));
    }
    if arguments.profile {
        write_profile(&mut std::io::stderr().lock(), followed)?;
    }
    match &followed.failure {
        Some(failure) => anyhow::bail!(
            "{}: the path could not be followed to its end: {failure}; the {} printed frames are valid",
            path.display(),
            followed.frames.len()
        ),
        None => Ok(()),
    }
}

/// Says where a path goes beyond what the sensor withstands. The gel is computed there as well.
fn beyond_limits(followed: &Followed, sensor: &Sensor) -> Option<String> {
    let limits = sensor.limits?;
    let is_beyond =
        |frame: &&FollowedFrame| frame.depth_mm > limits.depth_mm || frame.force_n.length() > limits.force_n;
    let first = followed.frames.iter().find(is_beyond)?;
    Some(format!(
        "from {} s on ({:.2} mm, {:.2} N) it goes beyond the `limits` of `{}`, {} mm and {} N: a real sensor would not withstand it",
        first.time_s,
        first.depth_mm,
        first.force_n.length(),
        sensor.name,
        limits.depth_mm,
        limits.force_n
    ))
}

/// Columns with their units, and rows. With a deadline, three more columns: whether each frame has
/// converged, its residual, and how far its indenter is behind the path.
fn table(
    simulated: &SimulatedPath,
    sensor: &Sensor,
    with_deadline: bool,
) -> impl Iterator<Item = Vec<String>> {
    const HEAD: [&str; 8] = [
        "provenance",
        "time_s",
        "x_mm",
        "y_mm",
        "z_mm",
        "force_x_n",
        "force_y_n",
        "force_z_n",
    ];
    let taxels = sensor.taxels.iter().map(|taxel| taxel.name.clone());
    let points = simulated.path.points.iter().map(|point| point.name.clone());
    let names: Vec<String> = taxels.chain(points).collect();
    let mut head = HEAD.map(str::to_owned).to_vec();
    head.extend(names.iter().map(|name| format!("{name}_kpa")));
    if with_deadline {
        head.extend(["converged", "residual", "behind_mm"].map(str::to_owned));
    }
    let with_quality = move |frame: &FollowedFrame| {
        let mut row = row(frame, &names);
        if with_deadline {
            row.extend([
                frame.converged.to_string(),
                format!("{:.2e}", frame.quality.residual),
                format!("{:.4}", frame.behind_mm),
            ]);
        }
        row
    };
    std::iter::once(head).chain(simulated.followed.frames.iter().map(with_quality))
}

fn row(frame: &FollowedFrame, names: &[String]) -> Vec<String> {
    let (at, force) = (frame.position_mm, frame.force_n);
    let mut row = vec![Provenance::Simulated.to_string()];
    row.extend([frame.time_s, at.x, at.y, at.z].map(|number| number.to_string()));
    row.extend([force.x, force.y, force.z].map(|force_n| format!("{force_n:.6}")));
    row.extend(
        names
            .iter()
            .map(|name| format!("{:.5}", frame.pressure_kpa[name])),
    );
    row
}

/// Writes how the frames' computing time is divided, one part a line.
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
