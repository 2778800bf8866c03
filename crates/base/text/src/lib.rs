//! Texts that others wrote, such as names of files and summaries of sensors, shown so that they do nothing.
//!
//! [`visible`] is for terminals, [`markdown`] for a sentence or a cell of a table, [`fenced`] for a block of code.

mod markdown;
mod visible;

pub use markdown::{fenced, markdown};
pub use visible::visible;
