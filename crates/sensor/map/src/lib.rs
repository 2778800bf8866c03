//! A continuous pressure map from a few taxels, by radial basis functions (paper, equation 1).
//!
//! [`pressure_map`] makes one map. [`PreparedMap`] makes many of the same taxels, each as one weighted sum.
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
