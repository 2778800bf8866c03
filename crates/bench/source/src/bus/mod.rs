//! Frames from an I²C bus.

mod full_scale;
#[cfg(target_os = "linux")]
mod linux;
mod power_on;
mod reader;
mod screening;
mod settings;

pub use full_scale::{emulated_scale, full_scale_kpa};
#[cfg(target_os = "linux")]
pub use linux::{LinuxBus, LinuxPhysTac, open_linux};
pub use power_on::{Known, PowerOn, power_on};
pub use reader::FrameReader;
pub use screening::confirmed_transfer;
pub use settings::driver_settings;
