//! The schema of recordings and paired frames; Parquet and CSV.
//!
//! A press is the unit of work: a named indenter, a time-stamped pose, and what was measured or simulated meanwhile.

mod append;
mod check;
mod error;
mod import;
mod press;
mod provenance;
mod store;

pub use error::RecordingError;
pub use import::{FileSummary, Import, ImportSummary};
pub use press::{Control, Press, Recording};
pub use provenance::Provenance;
pub use store::{FrameTable, TaxelCell};
