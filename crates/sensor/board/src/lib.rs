//! The circuit board of a sensor, made from its description: a KiCad 9 project as text, placed and
//! routed.
//!
//! Barometers stand on the top face, where the description has its taxels. Switch, capacitors,
//! pull-ups, address jumpers and connector are on the bottom face. The board has two layers, and
//! ends in ears with holes for M2 screws beyond the gel's ends.
//!
//! - Each taxel's chip is on the channel of the switch that the description says; a TCA9548A for
//!   each address that it names, eight at most.
//! - Pull-ups are 10 kOhm on the trunk and on each channel. An MS5837 sinks 0.6 mA at 0.2 VDD =
//!   0.66 V, so that at 3.3 V all pull-ups that it pulls against must be at least (3.3 V - 0.66 V)
//!   / 0.6 mA = 4.4 kOhm together: 10 kOhm beside 10 kOhm are 5 kOhm. With all eight channels
//!   selected at once, which is how conversions are started, the trunk sees 10 kOhm / 9 = 1.11
//!   kOhm: (3.3 V - 0.4 V) / 1.11 kOhm = 2.6 mA, below the 3 mA that the switch sinks at 0.4 V.
//!   Lower values would be outside one of the two data sheets. The rise at 400 kHz may take 300 ns
//!   = 0.8473 R C: 5 kOhm allow 71 pF on trunk and channel, which is a cable of some decimetres.
//! - A host with pull-ups of its own on the cable adds to the trunk: then the trunk's two resistors
//!   are left out.
//!
//! The same description gives the same bytes. Nothing here was ever built.

mod active;
mod barometer;
mod board;
mod circuit;
mod contour;
mod design;
mod device;
mod error;
mod geometry;
mod kicad;
mod label;
mod land;
mod outline;
mod passive;
mod place;
mod pour;
mod route;
pub mod rules;
mod shapes;

pub use board::{Board, PartLine, TaxelWiring};
pub use error::BoardError;
pub use geometry::{
    BoardGeometry, ChipGeometry, ConnectorGeometry, GelGeometry, Geometry, HoleGeometry, IndenterGeometry,
    PartGeometry, ShellGeometry, TaxelGeometry,
};
