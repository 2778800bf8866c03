//! A described gel in use: [`mesh`] writes it as meshes, [`simulated`] presses it along a protocol or a path, [`calibration`] fits its material to
//! measured presses.

pub mod calibration;
pub mod mesh;
mod settings;
pub mod simulated;

pub use settings::simulate_settings;
