//! The dashboard: a live pressure map, traces, and the state of reading.
//!
//! [`DashboardState`] is everything that is shown, [`draw`] a pure function of it, and [`run`] the
//! loop between source, keys and terminal.

mod draw;
mod map;
mod state;
mod terminal;

pub use draw::draw;
pub use state::{DashboardState, RecordingStatus};
pub use terminal::run;
