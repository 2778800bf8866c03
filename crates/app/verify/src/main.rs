//! What `cargo xtask bench` and `cargo xtask verify` run.

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

#[derive(Parser)]
#[command(about = "Benchmarks and verification of the soft body and of the bench")]
struct Arguments {
    #[command(subcommand)]
    task: Task,
}

#[derive(Subcommand)]
enum Task {
    /// How fast presses are followed, and how far the fast answers are from the same mesh solved tightly
    Softbody {
        /// Print one JSON line a case instead of a table
        #[arg(long)]
        json: bool,
    },
    /// How time and memory grow with the mesh: writes docs/benchmarks/scaling.*
    Scaling,
    /// One mesh of the above: one JSON line
    Size {
        /// Edges over the block's height
        edges_per_height: f64,
    },
    /// The verification ladder: closed forms, convergence, balance and robustness, each with a stated limit
    Ladder(ladder::Options),
    /// The block press on other engines and on ours: makes a Python environment, writes docs/benchmarks/peers.*
    Peers(peers::Options),
    /// Recording on the emulated bench, with faults and kills: writes docs/benchmarks/recording.*
    Recording(recording::Options),
    /// How long a CSV log of two million rows takes to import, and how much memory
    Import {
        /// Print one JSON line
        #[arg(long)]
        json: bool,
    },
    /// A thousand frames of sixteen taxels a second over a serial line: writes docs/benchmarks/serial.*
    #[cfg(unix)]
    Serial(serial::Options),
    /// Such a log: one JSON line
    ReadLog {
        /// The log
        log: PathBuf,
    },
    /// The block press on our engine alone: one JSON line with rate, forces and memory
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
