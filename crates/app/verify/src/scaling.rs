//! Time and memory over the size of the mesh: `cargo xtask bench scaling`.

#![allow(clippy::print_stderr)] // a tool for people at a terminal

use std::fmt::Write as _;
use std::io::Write;
use std::path::Path;
use std::process::Command;

use anyhow::{Context, Result, ensure};
use serde::{Deserialize, Serialize};

use crate::rung::plots;
use crate::{bench, cases, files};

/// Folder of the results.
const RESULTS: &str = "docs/benchmarks";

/// Requested edges over the block's height: about 1,000 to 300,000 tetrahedra.
const EDGES_PER_HEIGHT: [f64; 7] = [0.9, 1.4, 2.0, 3.0, 4.5, 6.5, 8.5];

/// The cost of a press on one mesh.
#[derive(Serialize, Deserialize)]
pub(crate) struct Size {
    nodes: usize,
    tets: usize,
    mean_ms: f64,
    newton_iterations_per_frame: f64,
    factorisations: u32,
    /// Peak memory of the whole process, MiB.
    peak_mib: f64,
}

/// Cost over the number of tetrahedra.
#[derive(Serialize)]
struct Scaling {
    command: &'static str,
    /// Exponent of the number of tetrahedra in a frame's time, fitted to all sizes.
    time_power: f64,
    /// The same for the time of a Newton iteration.
    iteration_power: f64,
    /// Difference of memory divided by the difference of tetrahedra, of the smallest and the
    /// largest mesh.
    bytes_per_tet: f64,
    sizes: Vec<Size>,
}

/// Presses one mesh, and prints the cost as one JSON line.
pub(crate) fn print_size(edges_per_height: f64) -> Result<()> {
    let followed = cases::block_of(edges_per_height)?.follow(bench::FAST, &mut || ())?;
    let frames = &followed.frames[1..];
    let mean = |of: &dyn Fn(usize) -> f64| (0..frames.len()).map(of).sum::<f64>() / frames.len() as f64;
    let size = Size {
        nodes: followed.n_nodes,
        tets: followed.n_tets,
        mean_ms: 1e3 * mean(&|frame| frames[frame].wall_time_s),
        newton_iterations_per_frame: mean(&|frame| f64::from(frames[frame].quality.iterations)),
        factorisations: frames.iter().map(|frame| frame.cost.factorisations).sum(),
        peak_mib: files::peak_memory_mib()?,
    };
    writeln!(std::io::stdout().lock(), "{}", serde_json::to_string(&size)?)?;
    Ok(())
}

/// Presses meshes of all sizes, each in a process of its own, and writes the page.
pub(crate) fn run() -> Result<()> {
    let program = std::env::current_exe()?;
    let mut sizes = Vec::new();
    for edges in EDGES_PER_HEIGHT {
        let output = Command::new(&program)
            .args(["size", &edges.to_string()])
            .output()?;
        ensure!(
            output.status.success(),
            "{}",
            String::from_utf8_lossy(&output.stderr)
        );
        let size: Size = serde_json::from_slice(&output.stdout)?;
        eprintln!("{} tetrahedra: {:.2} ms a frame", size.tets, size.mean_ms);
        sizes.push(size);
    }
    let (first, last) = (
        sizes.first().context("no sizes")?,
        sizes.last().context("no sizes")?,
    );
    let scaling = Scaling {
        command: "cargo xtask bench scaling",
        time_power: power(&sizes, &|size| size.mean_ms),
        iteration_power: power(&sizes, &|size| size.mean_ms / size.newton_iterations_per_frame),
        bytes_per_tet: (last.peak_mib - first.peak_mib) * 1024.0 * 1024.0 / (last.tets - first.tets) as f64,
        sizes,
    };
    let folder = Path::new(RESULTS);
    let figures = serde_json::to_string_pretty(&scaling)? + "\n";
    files::write_whole(&folder.join("scaling.json"), figures.as_bytes())?;
    let points = |of: &dyn Fn(&Size) -> f64| -> Vec<[f64; 2]> {
        let sizes = scaling.sizes.iter();
        sizes.map(|size| [(size.tets as f64).log10(), of(size)]).collect()
    };
    let series = vec![
        plots::line("time of a frame, ms", 0, points(&|size| size.mean_ms)),
        plots::dashes("peak memory, MiB", 1, points(&|size| size.peak_mib)),
    ];
    let labels = ["tetrahedra, power of ten", "ms, MiB"];
    let scene = plots::lines("Time and memory over the size of the mesh", labels, true, series);
    let chart = twintac_plot::png(&scene, 2.0)?;
    files::write_whole(&folder.join("scaling.png"), &chart)?;
    files::write_whole(&folder.join("scaling.md"), page(&scaling)?.as_bytes())?;
    eprintln!("wrote {RESULTS}/scaling.md, scaling.json and scaling.png");
    Ok(())
}

/// Slope of a line through the logarithms, by least squares.
fn power(sizes: &[Size], of: &dyn Fn(&Size) -> f64) -> f64 {
    let points: Vec<[f64; 2]> = sizes
        .iter()
        .map(|size| [(size.tets as f64).ln(), of(size).ln()])
        .collect();
    let mean = |axis: usize| points.iter().map(|point| point[axis]).sum::<f64>() / points.len() as f64;
    let (x, y) = (mean(0), mean(1));
    let (mut over, mut under) = (0.0, 0.0);
    for point in &points {
        over += (point[0] - x) * (point[1] - y);
        under += (point[0] - x) * (point[0] - x);
    }
    over / under
}

fn page(scaling: &Scaling) -> Result<String> {
    let mut text = format!(
        "# Time and memory over the size of the mesh\n\nMade by `{}`.\n\n\
         A ball with a diameter of 25 mm is pressed 1 mm deep into a bonded block, 30 × 20 × 8 mm, ν = 0.49, in frames of 55 Hz, on two threads. Each mesh \
         is pressed by its own process, whose peak memory is given.\n\n\
         The time of a frame grows with the number of tetrahedra to the power of **{:.2}**. The time of an iteration of Newton's \
         method grows to the power of **{:.2}**; a finer mesh needs more iterations. Memory grows by **{:.0} bytes** per tetrahedron.\n\n\
         | tetrahedra | nodes | ms a frame | Newton iterations a frame | factorisations | peak memory, MiB |\n|---:|---:|---:|---:|---:|---:|\n",
        scaling.command, scaling.time_power, scaling.iteration_power, scaling.bytes_per_tet
    );
    for size in &scaling.sizes {
        writeln!(
            text,
            "| {} | {} | {:.2} | {:.2} | {} | {:.0} |",
            size.tets,
            size.nodes,
            size.mean_ms,
            size.newton_iterations_per_frame,
            size.factorisations,
            size.peak_mib
        )?;
    }
    text += "\n![Time and memory over the number of tetrahedra](scaling.png)\n";
    Ok(text)
}
