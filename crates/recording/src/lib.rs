//! The schema of recordings and paired frames; Parquet and CSV.
//!
//! A press is the unit of work: a named indenter, a time-stamped pose, and what was measured or simulated meanwhile.

mod press;
mod provenance;

pub use press::{Control, Press, Recording};
pub use provenance::Provenance;
