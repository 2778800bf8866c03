//! The dashboard: a live pressure map, traces, and how the reading goes.
//!
//! [`DashboardState`] is all there is to see, [`draw`] a pure function of it, [`run`] the loop between source, keys and terminal.

mod draw;
mod map;
mod state;
mod terminal;

pub use draw::draw;
pub use state::{DashboardState, RecordingStatus};
pub use terminal::run;
