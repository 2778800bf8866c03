//! The sensor description: gel, shell, taxels, read-out, indenters.
//!
//! A description is one TOML file that says all there is to know about a sensor before it is pressed.
//! [`Sensor::parse`] checks it as a whole; every error names file, line and field.
//!
//! The gel's frame has z up and z = 0 at the board. Lengths are in mm, pressures in kPa, times in s.

mod check;
mod describe;
mod file;
mod indenter_file;
mod load;
mod material;
mod material_table;
mod sensor;
mod sensor_file;
mod wiring;

pub use indenter_file::IndenterFile;
pub use material::GelMaterial;
pub use sensor::{ConfirmedTransfer, Gel, Inclusion, Indenter, LoadLimits, Readout, Sensor, Shell, Taxel};
pub use sensor_file::SensorFile;
pub use twintac_material::{Model, PronyTerm};
pub use wiring::MOST_TAXELS;

/// Why a description cannot be used: what is wrong with which field, in which file and line.
pub type SensorError = twintac_config::ConfigError;
