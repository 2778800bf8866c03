//! The drivers over [`embedded_hal_async`]. Those at the root of the crate are these, over [`embedded_hal`].
//!
//! Futures may be dropped at any point: no driver trusts what it has not seen end.

mod diagnosis;
mod phystac;
mod switch;

pub(crate) use phystac::FRAMES_PER_TEMPERATURE;
pub use phystac::PhysTac;
pub use switch::Tca9548a;
