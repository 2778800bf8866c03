//! A continuous pressure map from a few taxels, by radial basis functions (equation 1 of the
//! TwinTac paper, arXiv 2509.10063).
//!
//! Input is the positions of the taxels in mm and their readings in kPa. Output is a
//! [`PressureMap`]: the pressure above the baseline, kPa, on a grid over a [`Rectangle`].
//!
//! - [`pressure_map`] computes one map.
//! - [`PreparedMap`] computes many maps of the same taxels, each as one weighted sum.
//! - [`MapSettings`] sets the grid, the function ([`Kernel`]) and how the weights are found
//!   ([`Weights`]).
//!
//! ```
//! use twintac_map::{MapSettings, Rectangle, pressure_map};
//!
//! let taxels_mm = [[-4.0, 0.0], [4.0, 0.0]];
//! let gel = Rectangle { min_mm: [-8.0, -4.0], max_mm: [8.0, 4.0] };
//! let settings = MapSettings { grid: [32, 16], ..MapSettings::default() };
//! let map = pressure_map(&taxels_mm, &[12.0, 3.0], &[0.0, 0.0], gel, &settings)?;
//! assert_eq!(map.pressure_kpa.len(), 32 * 16);
//! # Ok::<(), twintac_map::MapError>(())
//! ```
//!
//! # How it works
//!
//! A map is a sum of one function around each taxel: a Gaussian as in the paper, or a thin plate
//! (`r² ln r` and a plane). The weights are the readings, as in the paper, or they are solved so
//! that the map passes through the readings, or they are regularised for noisy readings. A width
//! that is not given is chosen by leave-one-out cross-validation.
//!
//! A map is linear in its readings. [`PreparedMap`] therefore computes the share of each taxel in
//! each cell once. A taxel without a reading (NaN) is left out.
//!
//! The crate depends on nothing that supplies readings: neither drivers, recordings, the emulator
//! nor simulation.

mod error;
mod fit;
mod geometry;
mod interpolate;
mod kernel;
mod prepared;
mod settings;
#[cfg(test)]
mod tests;
mod width;

pub use error::MapError;
pub use geometry::{Rectangle, pitch_mm};
pub use interpolate::{PressureMap, pressure_map};
pub use prepared::PreparedMap;
pub use settings::{Kernel, MapSettings, Weights};
