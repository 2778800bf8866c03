//! The dashboard: a live pressure map, traces, and how the reading goes.
//!
//! [`State`] is all there is to see, [`draw`] a pure function of it, [`run`] the loop between source, keys and terminal.

mod draw;
mod map;
mod recording;
mod state;
mod terminal;

pub use draw::draw;
pub use recording::Recording;
pub use state::{Recorded, State};
pub use terminal::run;
