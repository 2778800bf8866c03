//! A fast gel, from a sensor's description alone: presses of the solved gel to learn from, training, and presses to be judged on ([`train_fast`]).

mod plot;
mod presses;
mod strange;
mod train;

pub use strange::{Told, ToldKind};
pub use train::{FastResult, FastSettings, train_fast};
