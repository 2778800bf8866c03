//! Benchmarks and verification of the soft body and of the emulated bench. `cargo xtask bench` and
//! `cargo xtask verify` run this program.
//!
//! # How it works
//!
//! ```text
//! ladder/     the verification tests ("rungs"): closed forms, convergence, balance, robustness; a
//!             page and a record each in docs/verification
//! calculix/   the same presses in CalculiX, an independent finite-element program, whose results
//!             are kept in references/
//! rung/       a test's outcome: numbers (mm, N, kPa, %) with limits, and plots
//! cases, bench      presses at 55 Hz: real-time factor, and errors against a tightly converged
//!                   solution
//! scaling     time and memory over the size of the mesh
//! peers/      the same press in MuJoCo, Newton and rapier, by the Python scripts in peers/
//! recording/  recordings on the emulated bench: frame rate, twenty faults, random kills
//! import, serial    import of a large CSV log; frames over a serial line
//! view        many clients of `twintac view` for minutes
//! ```
//!
//! Each benchmark prints a table, or writes a page and a JSON file to `docs/benchmarks`. A
//! verification test fails if a number exceeds its limit; the exit code is then 1. All numbers are
//! `simulated` or `emulated`.
//!
//! The program does not depend on learning.

use std::path::PathBuf;
use std::process::ExitCode;

use clap::{Parser, Subcommand};

mod bench;
mod calculix;
mod cases;
mod files;
mod import;
mod ladder;
mod peers;
mod recording;
mod rung;
mod scaling;
#[cfg(unix)]
mod serial;
mod view;

#[derive(Parser)]
#[command(about = "Benchmarks and verification of the soft body and of the bench")]
struct Arguments {
    #[command(subcommand)]
    task: Task,
}

#[derive(Subcommand)]
enum Task {
    /// Measure how fast presses are followed, and the error against a tightly converged solution on
    /// the same mesh; writes docs/benchmarks/softbody.*
    Softbody {
        /// Print one JSON line for each case instead of a table
        #[arg(long)]
        json: bool,
    },
    /// Measure time and memory over the size of the mesh; writes docs/benchmarks/scaling.*
    Scaling,
    /// Measure one mesh of `scaling`, and print one JSON line
    Size {
        /// Edges over the block's height
        edges_per_height: f64,
    },
    /// Run the verification tests: closed forms, convergence, balance and robustness, each with a
    /// stated limit
    Ladder(ladder::Options),
    /// Run the block press on other engines and on this project's; makes a Python environment,
    /// writes docs/benchmarks/peers.*
    Peers(peers::Options),
    /// Record on the emulated bench, with faults and kills; writes docs/benchmarks/recording.*
    Recording(recording::Options),
    /// Measure time and memory of importing a CSV log of two million rows
    Import {
        /// Print one JSON line
        #[arg(long)]
        json: bool,
    },
    /// Read a thousand frames of sixteen taxels a second over a serial line; writes
    /// docs/benchmarks/serial.*
    #[cfg(unix)]
    Serial(serial::Options),
    /// Press many gels through one `twintac view`, and measure its memory; writes
    /// docs/benchmarks/view.*
    View(view::Options),
    /// Import such a log, and print one JSON line
    ReadLog {
        /// The log
        log: PathBuf,
    },
    /// Run the block press on this project's engine alone, and print one JSON line with rate,
    /// forces and memory
    Press {
        /// Poisson's ratio of the block
        #[arg(long)]
        poissons_ratio: f64,
    },
}

fn main() -> ExitCode {
    let result = match Arguments::parse().task {
        Task::Softbody { json } => bench::run(json).map(|()| true),
        Task::Scaling => scaling::run().map(|()| true),
        Task::Size { edges_per_height } => scaling::print_size(edges_per_height).map(|()| true),
        Task::Ladder(options) => ladder::run(&options),
        Task::Peers(options) => peers::run(&options).map(|()| true),
        Task::Recording(options) => recording::run(&options).map(|()| true),
        Task::Import { json } => import::run(json).map(|()| true),
        #[cfg(unix)]
        Task::Serial(options) => serial::run(&options).map(|()| true),
        Task::View(options) => view::run(&options).map(|()| true),
        Task::ReadLog { log } => import::print_imported(&log).map(|()| true),
        Task::Press { poissons_ratio } => peers::print_row(poissons_ratio).map(|()| true),
    };
    match result {
        Ok(true) => ExitCode::SUCCESS,
        Ok(false) => ExitCode::FAILURE,
        #[allow(clippy::print_stderr)] // a tool for people at a terminal
        Err(error) => {
            eprintln!("error: {error:#}");
            ExitCode::from(2)
        }
    }
}
