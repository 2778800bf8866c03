//! What CI runs beside the tests of the crates, and the rules of this workspace.
//!
//! The rules are tests: `xtask/tests/rules.rs` lists them. What each crate owns and must never know stands in `xtask/rooms.toml` ([`rooms`]); how
//! source text is read and judged stands in [`code`]; the commands of README.md are run by [`readme`]; [`results`]
//! keeps what the paper's experiments found; [`figures`] knows which sources made each committed figure, [`kept`] what each kept value is made from;
//! [`web`] makes the page in which the gel is pressed.

#![allow(clippy::print_stderr)] // a tool for people at a terminal

pub mod cargo;
pub mod code;
pub mod documents;
pub mod figures;
pub mod fuzz;
mod git;
pub mod kept;
pub mod readme;
pub mod results;
pub mod rooms;
pub mod web;

use std::path::{Path, PathBuf};

/// The folder of the checkout that Cargo runs this from.
pub fn root() -> PathBuf {
    let own = std::env::var_os("CARGO_MANIFEST_DIR").unwrap_or_else(|| env!("CARGO_MANIFEST_DIR").into());
    Path::new(&own).parent().map(Path::to_owned).unwrap_or_default()
}
