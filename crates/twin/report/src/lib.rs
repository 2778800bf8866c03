//! The page of a trained twin: what it predicts, how well, and what stands behind it.
//!
//! [`page`] makes one self-contained HTML page of a [`ReportData`] that other crates fill in: this crate computes no
//! results.
//!
//! ```
//! use twintac_report::data::Headline;
//! use twintac_report::{Provenance, ReportData, page};
//!
//! let headline = Headline { presses: 12, nearest_in_contact_percent: 1.3, ..Headline::default() };
//! let data = ReportData { provenance: Provenance::Emulated, headline: Some(headline), ..ReportData::default() };
//! assert!(page(&data).render().contains("on 12 presses that it never saw"));
//! ```

pub mod data;
mod sections;

pub use data::{Provenance, ReportData};
pub use sections::page;
