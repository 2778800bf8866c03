//! The sensor description: gel, shell, taxels, read-out, indenters.
//!
//! Input is a TOML file that contains everything about a sensor that is known before it is pressed.
//! Output is a checked [`Sensor`]. Lengths are in mm, forces in N, pressures in kPa, times in s,
//! angles in radians. The gel's frame has z up and z = 0 at the board.
//!
//! - [`Sensor::read`] and [`Sensor::parse`] read a description.
//! - [`SensorFile`] is a sensor with its text, in the form that logs, runs and models keep. It has
//!   the built-in PhysTac ([`SensorFile::phystac`]).
//! - [`IndenterFile`] is an indenter in a file of its own.
//!
//! # How it works
//!
//! The file is parsed, and the STL surfaces and the material file that it names are loaded. Then
//! the sensor is checked as a whole. Every error ([`SensorError`]) names file, line and field, and
//! says what to do.
//!
//! The material table gives a model and its constants by the names of the model's fields, with
//! Young's or the shear modulus, and Poisson's ratio or the bulk modulus ([`GelMaterial`]). Fields
//! listed in `inferred` were not stated by the source: output that depends on them is marked.
//! [`Sensor::wiring`] gives the chips and their locations on the bus to the driver `phystac`.
//!
//! The crate depends on no mesh, no solver and no device, so that all of them can use a
//! description.

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
pub use sensor::{
    ATMOSPHERE_KPA, ConfirmedTransfer, Gel, Inclusion, Indenter, LoadLimits, Readout, Sensor, Shell, Taxel,
};
pub use sensor_file::SensorFile;
pub use twintac_material::{Model, PronyTerm};
pub use wiring::MOST_TAXELS;

/// Why a description cannot be used: the file, the line, the field, and what is wrong.
pub type SensorError = twintac_config::ConfigError;
