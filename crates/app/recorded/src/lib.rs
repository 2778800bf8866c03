//! What recordings and logs of a bench tell: what a sensor does ([`Recorded::characterize`]), and frames as tables ([`export`]), for ROS 2 ([`export_ros`]) and
//! for LeRobot ([`export_lerobot`]).

mod export;
mod recorded;

pub use export::{Exported, ExportedBag, LogFound, export, export_lerobot, export_ros};
pub use recorded::{COMPENSATION, Recorded};
