//! Commands on a sensor's gel alone, without a run: meshes, simulated presses, and calibration of
//! the material.
//!
//! - [`mesh`]: [`MeshedGel`](mesh::MeshedGel) meshes the gel of a description and writes the mesh
//!   for Gmsh, ParaView and CAD; [`check_mesh`](mesh::check_mesh) measures the quality of a Gmsh
//!   file.
//! - [`simulated`]: [`simulate_presses`](simulated::simulate_presses) carries out a protocol on the
//!   simulated gel, one table over depth a press (mm, N, kPa);
//!   [`SimulatedPath`](simulated::SimulatedPath) follows a path of poses with friction and
//!   relaxation.
//! - [`calibration`]: [`calibrate`](calibration::calibrate) fits constants of the material to
//!   measured presses and writes them as a material file.
//!
//! # How it works
//!
//! The commands `twintac mesh`, `simulate` and `calibrate` call this crate. It joins the
//! description (`crates/sensor/description`), the mesh generator (`crates/gel/mesh`), the
//! simulation of a press (`crates/twin/simulate`) and the fit (`crates/twin/calibrate`) with files.
//!
//! Measured curves of a calibration come from CSV files or from recordings
//! ([`curves_of_file`](calibration::curves_of_file)). A curve is one press: depth below first
//! contact in mm over time in s, with force in N, readings in kPa, or both. Frames of a recorded
//! press count up to 0.25 mm above the gel. If the file names no taxels, those count whose largest
//! reading is more than 30 % of the press's largest, but for taxels that the description excludes
//! (`doubtful`). The fitted material is rounded to six significant digits.
//!
//! The crate reads no environment variable and no argument, prints nothing, and does not depend on
//! `crates/app/run`.

pub mod calibration;
pub mod mesh;
mod settings;
pub mod simulated;

pub use settings::simulate_settings;
