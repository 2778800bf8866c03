//! Tables over depth of a gel: solved and kept by all that they are made from ([`DepthTableStore`]), or the answers of a fast gel ([`FastTables`]).

mod fast;
mod store;

pub use fast::{FAST_GEL, FastTables};
pub use store::DepthTableStore;
