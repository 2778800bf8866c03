//! The page in which the gel is pressed: its engine compiled to WebAssembly, and one HTML file
//! around it.

use std::ffi::OsStr;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

use anyhow::{Context, Result, bail, ensure};

const TARGET: &str = "wasm32-unknown-unknown";

/// Where Debian's packages put a compiler and the sources of its standard library.
const DEBIAN_RUSTC: &str = "/usr/bin/rustc";
const DEBIAN_SOURCES: &str = "/usr/lib/rustlib/src/rust/library";

const NO_STANDARD_LIBRARY: &str = "the standard library for WebAssembly is missing. Either run `rustup target add wasm32-unknown-unknown`, or, on Debian, `apt install rustc-web rust-web-src`";

const NO_NODE: &str = "Node.js is missing, which puts the page together. Install it, 20 or later, with npm";

/// Makes `target/web/twintac.html`.
///
/// # Errors
/// A tool that is missing, with what to install; a program that fails.
pub fn make(root: &Path) -> Result<()> {
    let web = root.join("web");
    let module = build(root, &web.join("engine"))?;
    if !web.join("node_modules").exists() {
        run(
            Command::new("npm")
                .arg("ci")
                .args(["--no-audit", "--no-fund"])
                .current_dir(&web),
            NO_NODE,
        )?;
    }
    let folder = root.join("target/web");
    fs::create_dir_all(&folder)?;
    let page = folder.join("twintac.html");
    run(
        Command::new("node")
            .arg(web.join("build.mjs"))
            .arg(module)
            .arg(page),
        NO_NODE,
    )
}

/// Compiles the engine; where the module lies.
fn build(root: &Path, engine: &Path) -> Result<PathBuf> {
    let mut cargo = Command::new(std::env::var_os("CARGO").unwrap_or_else(|| "cargo".into()));
    cargo.args([
        "build",
        "--lib",
        "--locked",
        "--profile",
        "web",
        "--target",
        TARGET,
        "--target-dir",
    ]);
    cargo.arg(root.join("target")).current_dir(engine);
    cargo.env(
        "CARGO_TARGET_WASM32_UNKNOWN_UNKNOWN_RUSTFLAGS",
        "-Ctarget-feature=+simd128",
    );
    if !has_target()? {
        let is_debian = Path::new(DEBIAN_RUSTC).exists() && Path::new(DEBIAN_SOURCES).exists();
        ensure!(is_debian, NO_STANDARD_LIBRARY);
        eprintln!("{TARGET}: the standard library is built from {DEBIAN_SOURCES}");
        cargo.arg("-Zbuild-std=std,panic_abort");
        cargo.env("RUSTC", DEBIAN_RUSTC).env("RUSTC_BOOTSTRAP", "1"); // lets a stable compiler build its own library
        cargo.env("CARGO_TARGET_WASM32_UNKNOWN_UNKNOWN_LINKER", linker()?);
    }
    run(&mut cargo, "Cargo is missing")?;
    Ok(root.join("target").join(TARGET).join("web/twintac_web.wasm"))
}

/// Whether the compiler has the standard library for WebAssembly.
fn has_target() -> Result<bool> {
    let folder = answer("rustc", &["--print", "target-libdir", "--target", TARGET])?;
    Ok(Path::new(&folder).exists())
}

/// The linker that comes with the compiler.
fn linker() -> Result<PathBuf> {
    let folder = answer("rustc", &["--print", "target-libdir"])?;
    let beside = Path::new(&folder)
        .parent()
        .unwrap_or(Path::new(""))
        .join("bin/rust-lld");
    ensure!(
        beside.exists(),
        "the linker `{}` is missing: install Rust with rustup",
        beside.display()
    );
    Ok(beside)
}

fn answer(program: &str, arguments: &[&str]) -> Result<String> {
    let output = Command::new(program)
        .args(arguments)
        .output()
        .with_context(|| format!("starting {program}"))?;
    ensure!(
        output.status.success(),
        "`{program} {}` failed",
        arguments.join(" ")
    );
    Ok(String::from_utf8_lossy(&output.stdout).trim().to_owned())
}

fn run(command: &mut Command, missing: &str) -> Result<()> {
    let words: Vec<_> = std::iter::once(command.get_program())
        .chain(command.get_args())
        .map(OsStr::to_string_lossy)
        .collect();
    let words = words.join(" ");
    eprintln!("{words}");
    let status = command.status().with_context(|| missing.to_owned())?;
    if !status.success() {
        bail!("`{words}` failed");
    }
    Ok(())
}
