//! What must hold whatever bytes come from a wire or a file: one function each, which panics where it does not.
//!
//! The package `fuzz/`, beside the workspace, runs them with libFuzzer (`cargo xtask fuzz`); a test of this crate runs them on the
//! [`seeds`](Target::seeds) and on the corpus that fuzzing found, so that it needs no fuzzer.

#![allow(clippy::unwrap_used)] // a property that does not hold is a panic

mod line;
mod log;
mod netft;
mod seeds;
mod taxels;
mod text;
mod xarm;

/// A kind of bytes.
#[derive(Clone, Copy, Debug)]
pub struct Target {
    /// Its name, and that of the folder of its corpus.
    pub name: &'static str,
    /// Panics if a property does not hold for these bytes.
    pub run: fn(&[u8]),
    /// Right bytes to begin with, such as the makers' documents have.
    pub seeds: fn() -> Vec<Vec<u8>>,
}

/// All kinds.
pub const TARGETS: [Target; 9] = [
    Target {
        name: "xarm_frames",
        run: xarm::frames,
        seeds: seeds::xarm_frames,
    },
    Target {
        name: "xarm_controller",
        run: xarm::controller,
        seeds: seeds::xarm_requests,
    },
    Target {
        name: "xarm_reports",
        run: xarm::reports,
        seeds: seeds::xarm_reports,
    },
    Target {
        name: "netft_datagrams",
        run: netft::datagrams,
        seeds: seeds::netft_datagrams,
    },
    Target {
        name: "bench_texts",
        run: text::texts,
        seeds: seeds::texts,
    },
    Target {
        name: "line_bytes",
        run: line::bytes,
        seeds: seeds::lines,
    },
    Target {
        name: "log_file",
        run: log::file,
        seeds: seeds::log_files,
    },
    Target {
        name: "log_messages",
        run: log::messages,
        seeds: seeds::log_messages,
    },
    Target {
        name: "taxel_bus",
        run: taxels::bus,
        seeds: seeds::taxel_bus,
    },
];

/// Runs the target of a name on some bytes.
///
/// # Panics
/// If a property does not hold for these bytes, or there is no such target.
pub fn run(name: &str, bytes: &[u8]) {
    let target = TARGETS.iter().find(|target| target.name == name).unwrap();
    (target.run)(bytes);
}
