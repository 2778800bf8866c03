//! What CI runs beside the tests of the crates, and the rules of this workspace. No crate of the
//! workspace is needed for it.
//!
//! The rules are tests: `xtask/tests/rules.rs` lists them.
//!
//! - [`layers`]: what each crate owns and must not depend on (`xtask/crates.toml`).
//! - [`code`]: how source text is read, and what is asked of it.
//! - [`documents`], [`words`]: what is asked of pages; words that they do not use.
//! - [`readme`]: the commands of README.md, run word for word.
//! - [`results`]: the tables of results, from committed figures.
//! - [`figures`]: which sources made each committed figure and picture.
//! - [`kept`]: what each value that is kept in a file is made from.
//! - [`fuzz`]: the search for bytes that break what decodes wires and files.
//! - [`web`]: the page in which the gel is pressed.

#![allow(clippy::print_stderr)] // a tool for people at a terminal

pub mod cargo;
pub mod code;
pub mod documents;
pub mod figures;
pub mod fuzz;
mod git;
pub mod kept;
pub mod layers;
pub mod readme;
pub mod results;
pub mod web;
pub mod words;

use std::path::{Path, PathBuf};

/// The folder of the checkout that Cargo runs this from.
pub fn root() -> PathBuf {
    let own = std::env::var_os("CARGO_MANIFEST_DIR").unwrap_or_else(|| env!("CARGO_MANIFEST_DIR").into());
    Path::new(&own).parent().map(Path::to_owned).unwrap_or_default()
}
