//! Compensates the drift of taxels' zeros with temperature.
//!
//! A barometer under gel contains a little air and is soldered to a board. As it warms up, its
//! reading drifts by tenths of a kPa for each kelvin although nothing touches it.
//!
//! Input is a [`Compensation`], a TOML file with a coefficient in kPa/K for each taxel, as
//! `twintac characterize` finds it; and the chips' temperatures in °C. Output is readings without
//! this drift, in kPa. [`Compensation::apply`] subtracts the drift from recorded presses, and a
//! [`Warmth`] gives it for frames as they arrive:
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
//!
//! # How it works
//!
//! The drift of a taxel is its coefficient times the change of its chip's temperature since a
//! reference: the tare for frames, the first frames of a press for recordings. Temperatures are
//! averaged, over about two seconds for frames as they arrive and over ten seconds in presses,
//! because a single temperature is noisy and chips warm up within minutes. A remark says if
//! temperatures are far outside the range in which the coefficients were found.
//!
//! The crate depends on no source of data, no solver and no learning.

mod compensation;
mod presses;
mod warmth;

pub use compensation::{Compensation, TaxelDrift, TemperatureError};
pub use presses::Compensated;
pub use warmth::Warmth;
