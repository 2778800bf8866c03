//! How the zeros of taxels move with temperature, and readings without that.
//!
//! A barometer under gel has a little air, and is soldered to a board: as it warms up, its reading moves though nothing touches it, by
//! tenths of a kPa for each kelvin. A [`Compensation`] has a coefficient for each taxel, as `twintac characterize` finds it. It is taken off
//! recorded presses by [`Compensation::apply`], and off frames as they come by a [`Warmth`]:
//!
//! ```
//! use twintac_temperature::{Compensation, Warmth};
//!
//! let text = r#"
//! sensor = "pair"
//! provenance = "emulated"
//! taxels = [
//!     { name = "a", kpa_per_k = 0.5, between_c = [25.0, 35.0], remaining_kpa = 0.01 },
//!     { name = "b", kpa_per_k = -0.2, between_c = [25.0, 35.0], remaining_kpa = 0.01 },
//! ]
//! "#;
//! let compensation = Compensation::parse("temperature.toml", text)?;
//! let taxels = ["a".to_owned(), "b".to_owned()];
//! let mut warmth = Warmth::new(compensation.coefficients("pair", &taxels)?);
//! warmth.update(0.0, &[Some(25.0), Some(25.0)]);
//! warmth.tare();
//! for second in 1..60 {
//!     warmth.update(f64::from(second), &[Some(27.0), Some(27.0)]);
//! }
//! assert!((warmth.drift_kpa(0) - 1.0).abs() < 1e-6 && (warmth.drift_kpa(1) + 0.4).abs() < 1e-6);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

mod compensation;
mod presses;
mod warmth;

pub use compensation::{Compensation, TaxelDrift, TemperatureError};
pub use presses::Compensated;
pub use warmth::Warmth;
