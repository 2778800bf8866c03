//! A written board, read back from its text. It shares no code with the crate that writes it.

#![allow(dead_code, unused_imports)] // each test program uses a part of it

mod copper;
mod expression;
mod sensors;

pub(crate) use copper::Written;
pub(crate) use sensors::{grid_of, sensor};
