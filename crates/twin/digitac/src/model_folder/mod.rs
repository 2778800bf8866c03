//! A twin with all that is needed to use it and to know where it comes from, and the folder that keeps it.

mod card;
mod check;
mod folder;
mod record;

pub use record::{Model, ModelRecord, Origin};
