//! Second derivatives of the energy at fixed pressures, in single precision, which is accurate
//! enough for a Newton direction.

mod coarse;
mod kernel;
mod sink;
mod stiffness;

pub(crate) use coarse::{CoarseSink, CoarseTangent};
pub(crate) use sink::{NodeBlock, NodeSlopes, Sink};
