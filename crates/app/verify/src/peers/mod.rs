//! The same press on other engines, in one run: `cargo xtask bench peers`.
//!
//! Each press runs in a process of its own, which prints one row of figures. A press that fails or
//! takes too long becomes a row that says so.

#![allow(clippy::print_stderr)] // a tool for people at a terminal

mod chart;
mod ours;
mod page;
mod plan;
mod process;
mod row;

use std::fs;
use std::path::Path;

use anyhow::{Context, Result};

use crate::cases;
use crate::files::write_whole;
use page::Results;
use plan::Plan;
use process::Python;
use row::Row;

pub(crate) use ours::print_row;

/// Folder of the results.
const RESULTS: &str = "docs/benchmarks";

/// Working folder, kept between runs: the virtual environment, compiled kernels, meshes and logs.
const WORK: &str = "target/peers";

/// Command-line options.
#[derive(clap::Args)]
pub(crate) struct Options {
    /// Poisson's ratios of the block
    #[arg(long, value_delimiter = ',', default_values_t = plan::RATIOS)]
    poissons_ratios: Vec<f64>,
    /// Processor time after which a press of another engine is cut, s
    #[arg(long, default_value_t = 60.0)]
    limit_s: f64,
    /// Use the kernels that an earlier run compiled; the time of a first start is then not measured
    #[arg(long)]
    keep_kernels: bool,
    /// Measure nothing: write the page and the chart of the existing figures
    #[arg(long)]
    rewrite: bool,
}

/// Measures every engine and writes the page, the figures and the chart.
pub(crate) fn run(options: &Options) -> Result<()> {
    if options.rewrite {
        let figures =
            fs::read_to_string(Path::new(RESULTS).join("peers.json")).context("there are no figures yet")?;
        return write_results(&serde_json::from_str(&figures)?);
    }
    let ratios = &options.poissons_ratios;
    let work = Path::new(WORK);
    fs::create_dir_all(work).with_context(|| format!("creating {WORK}"))?;
    let plan = Plan::read()?;
    let mesh_file = Path::new("mesh.json"); // engines run in the working folder
    write_whole(
        &work.join(mesh_file),
        cases::block(plan::RATIOS[0])?.mesh_json()?.as_bytes(),
    )?;

    let mut rows = Vec::new();
    for &poissons_ratio in ratios {
        eprintln!("TwinTac, ν = {poissons_ratio}");
        rows.push(process::ours(work, poissons_ratio));
    }
    let python = Python::prepare(work, &plan.packages);
    for engine in &plan.engines {
        let runs = plan.runs(engine, mesh_file, ratios, options.limit_s);
        let first_start_s = match &python {
            Ok(python) if !options.keep_kernels => python.first_start(engine, &runs),
            _ => None,
        };
        for run in runs {
            eprintln!(
                "{}, {}, {} mesh, ν = {}",
                run.engine, run.setting, run.mesh, run.poissons_ratio
            );
            rows.push(match &python {
                Ok(python) => python.row(&run, first_start_s),
                Err(error) => Row::failed(&run, &format!("{error:#}")),
            });
        }
        // After an early stop, the results of the finished engines are kept.
        write_results(&Results {
            conditions: process::conditions(options.limit_s),
            rows: rows.clone(),
        })?;
    }
    Ok(())
}

fn write_results(results: &Results) -> Result<()> {
    let folder = Path::new(RESULTS);
    fs::create_dir_all(folder).with_context(|| format!("creating {RESULTS}"))?;
    let figures = serde_json::to_string_pretty(results)? + "\n";
    write_whole(&folder.join("peers.json"), figures.as_bytes())?;
    let chart = twintac_plot::png(&chart::scene(&results.rows), 2.0)?;
    write_whole(&folder.join("peers.png"), &chart)?;
    write_whole(&folder.join("peers.md"), page::markdown(results).as_bytes())?;
    eprintln!("wrote {RESULTS}/peers.md, peers.json and peers.png");
    Ok(())
}
