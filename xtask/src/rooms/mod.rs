//! The rooms of this workspace: what each crate owns, and what it must never know.
//!
//! `xtask/rooms.toml` is the one source. The tables of ARCHITECTURE.md are written from it ([`page`]), and each of its rules is a test ([`rule`]).

mod graph;
pub mod page;
pub mod rule;
mod source;

pub use graph::{Graph, Package};
pub use source::{Bar, Invariant, Room, Rooms, Term};
