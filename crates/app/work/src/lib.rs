//! Shared foundations of all application crates: the error type, progress reports and cancellation,
//! and planned press protocols.
//!
//! - [`WorkError`]: the error type of the crates that do the program's work. [`At`] adds where an
//!   error happened; [`in_one_sentence`] prints the whole chain.
//! - [`Progress`]: what long work reports to, and what can stop it. [`Silent`] ignores all reports.
//! - [`Caller`]: the program that runs the work: its build, the command that it was started with,
//!   and its [`Progress`].
//! - [`Planned`]: a press protocol (TOML), turned into single presses (mm, mm/s, s) and loads for
//!   one sensor.
//! - [`sha256_of_file`]: the SHA-256 that tells two builds of a program apart.
//!
//! # How it works
//!
//! Work that takes seconds to minutes is wrapped in a [`Work`]: a guard that reports the start,
//! each step and the end of one piece of work to a [`Progress`]. Between two steps the work asks
//! [`Progress::is_stopped`]; if the answer is yes, it ends with [`WorkError::Stopped`] and keeps
//! what is complete. The command line draws its progress bar from these calls.
//!
//! A [`WorkError`] wraps the errors of the lower crates. Its text says what is wrong and what to
//! do, and leaves out its source; a [`WorkError::In`] puts a place (a stage, a file, a press)
//! before it.
//!
//! The crate reads no environment variable and no command-line argument, prints nothing, and does
//! not depend on `crates/app/run`: the caller hands in everything.

mod caller;
mod error;
mod files;
mod planned;
mod progress;

pub use caller::Caller;
pub use error::{At, WorkError, in_one_sentence};
pub use files::{read_text, sha256, sha256_of_file};
pub use planned::{Planned, target};
pub use progress::{Progress, Silent, Work, go_on};
