//! The crates of this workspace: what each owns, and what it must not depend on.
//!
//! `xtask/crates.toml` is the one source. The tables of ARCHITECTURE.md and
//! docs/reference/crates.md are written from it ([`page`]), and each of its rules is a test
//! ([`rule`]).

mod graph;
pub mod page;
pub mod rule;
mod source;

pub use graph::{Graph, Package};
pub use source::{Bar, Entry, Invariant, Layers, Term};
