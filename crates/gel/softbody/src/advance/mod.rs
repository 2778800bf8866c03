//! Moves a press from one pose of the indenter to the next.

mod clearance;
mod drive;
mod motion;
mod report;
mod substep;
