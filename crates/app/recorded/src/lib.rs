//! What recordings and logs of a bench tell: what a sensor does ([`Recorded::characterize`]), and frames as tables ([`export`], [`export_lerobot`]).

mod export;
mod recorded;

pub use export::{Exported, export, export_lerobot};
pub use recorded::Recorded;
