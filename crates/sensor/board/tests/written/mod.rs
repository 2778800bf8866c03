//! A written board, read back from its text, and what must hold of its copper. Nothing here is
//! shared with what writes it.

#![allow(dead_code, unused_imports)] // each test program uses a part of it

mod copper;
mod expression;
mod sensors;

pub(crate) use copper::Written;
pub(crate) use sensors::{grid_of, sensor};
