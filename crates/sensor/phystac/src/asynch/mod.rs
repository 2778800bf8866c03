//! The drivers over [`embedded_hal_async`]. The drivers at the root of the crate are the same ones
//! over [`embedded_hal`].
//!
//! A future may be dropped at any point: the next call starts over if the last operation did not
//! end.

mod diagnosis;
mod phystac;
mod switch;

pub(crate) use phystac::FRAMES_PER_TEMPERATURE;
pub use phystac::PhysTac;
pub use switch::Tca9548a;
