//! Contact estimation: from the readings of a tactile sensor to the contact that causes them, frame
//! by frame.
//!
//! In: the readings of a frame above the sensor without contact (kPa; `[n_readings]`) and the time
//! since the previous frame (s). Out: a [`Contact`] with the most probable of the known shapes, its
//! location (mm), depth (mm), yaw (rad) and force (N), the probability of each shape, standard
//! deviations and covariances, and a misfit.
//!
//! - [`Inverse`] is prepared once for a [`ContactModel`], its known shapes and the
//!   [`InverseSettings`].
//! - A [`Tracker`], from [`Inverse::start`], follows the contact of one sensor.
//! - [`ContactModel`] is the trait of a sensor's forward model: [`FastModel`], the surrogate of the
//!   gel (crate `twintac-fast`), or [`TableModel`], a table of readings over location and depth, of
//!   a trained twin or measured.
//! - [`FloorMap`] reads the pressure at the base of the gel under a contact.
//!
//! The crate depends neither on a solver nor on meshes, recordings, files or the emulated bench. It
//! also has no twin: it sees readings of a forward model alone.
//!
//! # How it works
//!
//! **Shapes press upright.** The unknowns are x, y, depth and yaw, as far as the [`Domain`] of a
//! shape leaves them free. Forces come from the forward model.
//!
//! **Several hypotheses.** Readings of few taxels fit several presses. For each known shape, a
//! coarse table of readings all over the gel says where to begin. A few possible presses of each
//! shape are followed at the same time, and in each frame one more is tried. A hypothesis makes a
//! damped Gauss-Newton step in each frame, between what was known before and what is read (an
//! iterated extended Kalman filter). Its covariance is that of Laplace's approximation.
//!
//! **Viscoelastic relaxation is removed beforehand.** Readings of a real gel depend on earlier
//! frames. Overstresses follow each taxel's own readings and nothing else, so they are subtracted
//! from the readings before this crate sees them (`WithoutMemory` in crate `digitac`). No
//! hypothesis then needs a history, and the table of a trained twin over location and depth is that
//! of a gel that has always rested. The zero follows the sensor while nothing touches. The command
//! `twintac locate` (`crates/app/model/src/locate`) combines the two.
//!
//! **Errors of the model are correlated in time.** The error of the model stays the same as long as
//! a contact does not change. Frames within [`InverseSettings::correlated_s`] therefore count as
//! one, and what was known is forgotten at the same rate. A long hold does not make a wrong press
//! certain. Noise, which is independent from frame to frame, is averaged.
//!
//! **Probability of a shape.** Shapes with more freedom fit more readings. The fraction of all
//! presses of a shape that fit as well (Occam's factor) corrects this. It is counted once and not
//! in each frame, because information that is forgotten would be counted again.
//!
//! **Computing time.** Hypotheses that are less probable than the best by more than a factor of e¹⁰
//! are updated less often: only in every n-th frame, with n the number of shapes.
//!
//! ```text
//! model       readings of a known shape that presses: a trait; implemented by fast_model and
//!             table_model
//! starts      readings of each shape all over the gel, coarse: where to begin
//! hypothesis  one possible press, followed from frame to frame
//! tracker     a few hypotheses for each shape, new ones on trial, and the resulting contact
//! inverse     what is prepared once for all sensors of a kind
//! floor       the pressure at the base of the gel under a contact
//! turn        angles after which shapes look the same; matrix: small matrices
//! ```
//!
//! # Example
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
