//! Escapes texts from untrusted sources, such as file names and summaries of sensors, so that they
//! are shown as plain text.
//!
//! Each function takes a text and returns one that is safe to show:
//!
//! - [`visible`] for terminals,
//! - [`markdown`] for a sentence or a table cell of a Markdown page,
//! - [`fenced`] for a block of code in a Markdown page.
//!
//! # How it works
//!
//! [`visible`] replaces control characters, except for line breaks and tabs, and characters that
//! change the direction of writing by their number (`\u001b`). A text then cannot move the cursor,
//! clear the screen or look different from what it says. [`markdown`] does the same and escapes
//! HTML and Markdown characters, so that the text makes no tags, links, table cells or emphasis.
//! [`fenced`] makes the fence longer than every run of backticks in the text, so that the text
//! cannot end the block.
//!
//! This crate has no dependencies: it knows neither sensors nor files.

mod markdown;
mod visible;

pub use markdown::{fenced, markdown};
pub use visible::visible;
