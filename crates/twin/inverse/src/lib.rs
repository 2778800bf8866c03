//! From what a sensor reads to what touches it: place, depth, force, and which of the known shapes it is, frame by frame.
//!
//! ```
//! use twintac_fast::FastGel;
//! use twintac_inverse::{Inverse, InverseSettings, KnownShape};
//! use twintac_shape::Shape;
//!
//! let ball = KnownShape { name: "ball".into(), shape: Shape::Sphere { radius_mm: 5.0 } };
//! let inverse = Inverse::of_fast_gel(&FastGel::phystac()?, &[ball], &Default::default(), InverseSettings::default())?;
//! let mut tracker = inverse.start();
//! assert!(tracker.update(0.01, &[0.0; 8])?.is_none());
//! let contact = tracker.update(0.01, &[0.1, 0.9, 1.0, 0.1, 0.8, 8.7, 0.9, 0.2])?.expect("something touches");
//! println!("{:.1} mm, {:.2} mm deep, {:.2} N", contact.place_mm, contact.depth_mm, contact.force_n);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

mod contact;
mod error;
mod fast_model;
mod floor;
mod hypothesis;
mod inverse;
mod matrix;
mod model;
mod settings;
mod starts;
mod table_model;
mod tracker;
mod turn;

pub use contact::Contact;
pub use error::InverseError;
pub use fast_model::{FastModel, KnownShape};
pub use floor::FloorMap;
pub use inverse::Inverse;
pub use model::{ContactModel, Domain, Press};
pub use settings::InverseSettings;
pub use table_model::{ReadingTable, TableModel};
pub use tracker::{LARGEST_READING_KPA, Tracker};
