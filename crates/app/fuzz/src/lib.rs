//! Properties that must hold for any bytes from a wire or a file: one function for each kind of
//! bytes, which panics if a property does not hold.
//!
//! [`TARGETS`] has nine kinds: frames, requests and reports of the robot, datagrams of the
//! force/torque sensor, the tactile sensor's bus, lines of microcontrollers, log files, log
//! messages, and texts. [`run`] checks one input.
//!
//! # How it works
//!
//! A check decodes the bytes, encodes the result again and compares, or lets a driver, a client or
//! an emulated device process them, and asserts bounds: sizes, numbers of transactions, times,
//! finite numbers. An input that is refused with an error is fine; a panic, a wrong result or an
//! unbounded allocation is a finding.
//!
//! The package `fuzz/`, beside the workspace, runs the checks with libFuzzer (`cargo xtask fuzz`).
//! A test of this crate runs them on the [`seeds`](Target::seeds) and on the corpus that fuzzing
//! found, so that it needs no fuzzer.
//!
//! The crate depends on no solver and on no twin.

#![allow(clippy::unwrap_used)] // a violated property is a panic

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
    /// Its name, and the name of its corpus's folder.
    pub name: &'static str,
    /// Panics if a property does not hold for these bytes.
    pub run: fn(&[u8]),
    /// Valid inputs to start with, such as the examples of the manufacturers' documents.
    pub seeds: fn() -> Vec<Vec<u8>>,
}

/// All kinds of bytes.
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

/// Checks some bytes with the target of this name.
///
/// # Panics
/// If a property does not hold for these bytes, or there is no such target.
pub fn run(name: &str, bytes: &[u8]) {
    let target = TARGETS.iter().find(|target| target.name == name).unwrap();
    (target.run)(bytes);
}
