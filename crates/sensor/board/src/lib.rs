//! The circuit board of a sensor, made from its description: a placed and routed KiCad 9 project as
//! text.
//!
//! Input is a sensor's description and the name of a barometer chip. [`Board::design`] places and
//! routes the board. [`Board::files`] returns the files of the KiCad project, [`Board::parts`] the
//! parts to buy, and [`Board::geometry`] the [`Geometry`] that the mechanics are made from. Lengths
//! are in mm. A description from which no board can be made is a [`BoardError`] that says what to
//! change. The same description gives the same bytes. No board was ever built.
//!
//! # How it works
//!
//! - The barometers are on the top face, at the taxels of the description. Switch, capacitors,
//!   pull-ups, address jumpers and connector are on the bottom face, each as close as there is room
//!   to the pads it connects to. The board has two layers. At both ends along x, beyond the gel, it
//!   has ears with holes for M2 screws.
//! - Each taxel's chip is on the switch channel that the description gives. The board has one
//!   TCA9548A for each address in the description, at most eight.
//! - Tracks are found by A* on a grid of 0.1 mm. A path may cross tracks of other nets at a cost;
//!   those are then routed again. A ground pour fills what is left on both layers.
//! - Pull-ups are 10 kOhm on the trunk and on each channel. An MS5837 sinks 0.6 mA at 0.2 VDD =
//!   0.66 V. At 3.3 V all pull-ups that it pulls against must therefore be at least (3.3 V - 0.66
//!   V) / 0.6 mA = 4.4 kOhm together; 10 kOhm in parallel with 10 kOhm is 5 kOhm. Conversions are
//!   started with all eight channels selected at once. The trunk then sees 10 kOhm / 9 = 1.11 kOhm:
//!   (3.3 V - 0.4 V) / 1.11 kOhm = 2.6 mA, below the 3 mA that the switch sinks at 0.4 V. Lower
//!   values would violate one of the two data sheets. The rise at 400 kHz may take 300 ns = 0.8473
//!   R C: 5 kOhm allow 71 pF on trunk and channel, which is a cable of some decimetres.
//! - If a host has pull-ups of its own on the cable, leave out the trunk's two resistors.
//! - [`rules`] has the fabrication rules.
//!
//! The crate reads no files and depends on no solver, device, recording or learning: a board is a
//! function of a description.

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
