//! What `cargo xtask bench` runs.

use std::process::ExitCode;

use clap::{Parser, Subcommand};

mod bench;
mod cases;

#[derive(Parser)]
#[command(about = "Benchmarks of the soft body")]
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
}

fn main() -> ExitCode {
    let result = match Arguments::parse().task {
        Task::Softbody { json } => bench::run(json),
    };
    match result {
        Ok(()) => ExitCode::SUCCESS,
        #[allow(clippy::print_stderr)] // a tool for people at a terminal
        Err(error) => {
            eprintln!("error: {error:#}");
            ExitCode::from(2)
        }
    }
}
