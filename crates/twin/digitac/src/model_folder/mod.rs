//! A twin with everything that is needed to use it and to know its origin, and the folder in which
//! it is stored.

mod card;
mod check;
mod folder;
mod record;

pub use record::{Model, ModelRecord, Origin};
