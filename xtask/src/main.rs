//! House rules and checks. `cargo xtask ci` lints, packages and tests as `.ci/run` does, which
//! first installs Python programs that some tests compare ours with: where these are missing and
//! `TWINTAC_PYTHON` is not set, those tests say so and look at nothing.

#![allow(clippy::print_stderr)] // a tool for people at a terminal

use std::process::ExitCode;

use anyhow::Result;
use xtask::cargo::{cargo, run};
use xtask::{figures, fuzz, layers, readme, results, web};

const USAGE: &str = "usage: cargo xtask <ci | lint | package | test | readme | crates | results [FILE] | pictures [NAME] | bench softbody [--json] | bench scaling | bench peers | bench recording | bench serial | bench view | bench import [--json] | bench twin |
    bench sensors [--rewrite] |
    fuzz [target…] [--seconds N] [--jobs N] [--keep] | hardware [--sensor FILE [--chip NAME]] [--out DIR] [--release] | web | verify [rung…] [--quick] [--json] [--ccx CASE] [--finer CASE]>
  ci     lint, package, readme, as CI does; CI also installs the Python programs that some tests want
  lint   formatting and clippy, warnings are errors
  package every Rust crate of the workspace, without building it again; nothing may be uncommitted
  test   every test, optimised
  readme the commands of README.md in blocks that are tagged `sh`, word for word; those of `cargo test` last; the book's are run by python/tests/test_docs.py
  crates  writes the tables of ARCHITECTURE.md and docs/reference/crates.md from xtask/crates.toml
  results  writes the tables of docs/results.md and docs/results from committed figures, xtask/results.toml and xtask/figures.toml, and fails where code that makes a figure has changed
         since and nothing says so; FILE: the metrics.json of `reproduce --paper` at this commit, which is kept first
  pictures  makes the pictures of the documents again: all, or those with NAME in their names; TWINTAC_PYTHON names a Python with twintac,
         CHROMIUM a browser; `results` says which pictures are of older code
  bench  softbody: how fast presses are followed, and how far off tight solutions they are; writes docs/benchmarks/softbody.*
         scaling: how time and memory grow with the mesh; writes docs/benchmarks/scaling.*
         peers: the same press on MuJoCo, Newton and rapier; needs Python 3 and the network, writes docs/benchmarks/peers.*
         recording: rate, faults and kills of a recording on the emulated bench; writes docs/benchmarks/recording.*
         view: ten clients press gels through one `twintac view` for ten minutes; writes docs/benchmarks/view.*
         serial: a thousand frames of sixteen taxels a second over a serial line for ten minutes; writes docs/benchmarks/serial.*
         import: how long a CSV log of two million rows takes to import, and how much memory
         twin: how fast a thousand twins are stepped; writes docs/benchmarks/twin.*
         sensors: how fast a thousand imperfect sensors are stepped, beside MuJoCo's touch_grid if TWINTAC_PYTHON names a Python that has it;
         writes docs/benchmarks/sensors.*
  fuzz   looks for bytes that break what decodes wires and files, 60 s a target, two at a time; needs a C++ compiler; exit code 2 if it finds any
         keep: the corpus that was found becomes `fuzz/corpus`, the figures docs/benchmarks/fuzz.*
  hardware  board, geometry, parts list and mechanics of each sensor that ships, or of one description, into target/hardware; with KiCad 9 also
         rule checks and fabrication files (hardware/README.md); release: one archive each
  web    the page in which the gel is pressed, target/web/twintac.html; needs Node.js and the standard library for wasm32-unknown-unknown (web/README.md)
  verify the verification ladder of the soft body; pages in docs/verification; exit code 1 if a limit does not hold";

fn main() -> ExitCode {
    let task = std::env::args().nth(1).unwrap_or_default();
    let result = match task.as_str() {
        "ci" => lint()
            .and_then(|()| package())
            .and_then(|()| readme::run(&xtask::root())),
        "lint" => lint(),
        "package" => package(),
        "test" => test(),
        "readme" => readme::run(&xtask::root()),
        "crates" => layers::page::write(&xtask::root()),
        "pictures" => figures::remake(&xtask::root(), &std::env::args().nth(2).unwrap_or_default()),
        "results" => results::write(&xtask::root(), std::env::args().nth(2).as_deref()),
        "bench" => bench(),
        "fuzz" => fuzz::fuzz(&std::env::args().skip(2).collect::<Vec<_>>()),
        "hardware" => hardware(),
        "web" => web::make(&xtask::root()),
        "verify" => return verify(),
        _ => Err(anyhow::anyhow!("there is no task `{task}`\n{USAGE}")),
    };
    match result {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("error: {error:#}");
            ExitCode::from(2)
        }
    }
}

fn lint() -> Result<()> {
    cargo(&["fmt", "--all", "--check"])?;
    for beside in ["fuzz/Cargo.toml", "web/engine/Cargo.toml"] {
        cargo(&["fmt", "--manifest-path", beside, "--check"])?;
    }
    cargo(&[
        "clippy",
        "--release",
        "--workspace",
        "--all-targets",
        "--",
        "--deny",
        "warnings",
    ])
}

fn package() -> Result<()> {
    let published = ["--workspace", "--exclude", "twintac-python"];
    cargo(&[&["package", "--no-verify", "--quiet"][..], &published].concat())
}

fn test() -> Result<()> {
    cargo(&["test", "--release", "--workspace"])
}

fn bench() -> Result<()> {
    let given: Vec<String> = std::env::args().skip(2).collect();
    // What measures the others knows no learning.
    match given.first().map(String::as_str) {
        Some("twin") => return cargo(&of_example("digitac", "step_rate", &given[1..])),
        Some("sensors") => return cargo(&of_example("twintac-sensors", "rate", &given[1..])),
        _ => {}
    }
    if given
        .first()
        .is_some_and(|bench| bench == "recording" || bench == "view")
    {
        cargo(&["build", "--release", "--package", "twintac-cli"])?; // it is run as its users run it
    }
    cargo(&of_verify(&given))
}

fn hardware() -> Result<()> {
    let root = xtask::root();
    let root = root.to_string_lossy();
    let mut arguments = vec![
        "run",
        "--release",
        "--quiet",
        "--package",
        "twintac-hardware",
        "--",
        "--root",
        &root,
    ];
    let given: Vec<String> = std::env::args().skip(2).collect();
    arguments.extend(given.iter().map(String::as_str));
    cargo(&arguments)
}

/// Passes on the ladder's own exit code: 1 where a limit does not hold.
fn verify() -> ExitCode {
    let given: Vec<String> = std::iter::once("ladder".to_owned())
        .chain(std::env::args().skip(2))
        .collect();
    match run(&of_verify(&given)) {
        Ok(status) => u8::try_from(status.code().unwrap_or(2)).unwrap_or(2).into(),
        Err(error) => {
            eprintln!("error: {error:#}");
            ExitCode::from(2)
        }
    }
}

fn of_example<'a>(package: &'a str, example: &'a str, given: &'a [String]) -> Vec<&'a str> {
    let mut arguments = vec![
        "run",
        "--release",
        "--quiet",
        "--package",
        package,
        "--example",
        example,
        "--",
    ];
    arguments.extend(given.iter().map(String::as_str));
    arguments
}

fn of_verify(given: &[String]) -> Vec<&str> {
    let mut arguments = vec!["run", "--release", "--quiet", "--package", "twintac-verify", "--"];
    arguments.extend(given.iter().map(String::as_str));
    arguments
}
