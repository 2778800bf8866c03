//! Source text, read well enough to be judged: files and modules ([`Crate`]), what imports what
//! ([`circles`]), how long functions are ([`length`]), and what is public ([`public`]), and whether
//! there is anything to test ([`tested`]).

pub mod circles;
mod file;
pub mod length;
mod module;
pub mod public;
pub mod tested;
mod tree;

pub use file::{Mention, SourceFile, identifiers, rust_files};
pub use module::{Item, Module, ModulePath};
pub use tree::{Crate, Target};
