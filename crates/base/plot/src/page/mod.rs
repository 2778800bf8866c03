//! A page of texts, tables and scenes as one HTML file: no requests, and the same bytes for the
//! same contents. A page with a [`Replay`] has a script that moves it; other pages have none.

mod block;
mod contents;
mod html;
mod replay;

use std::path::Path;

use crate::PlotError;

pub use block::{Badge, Block, Card, Cell, Fact, Figure, Paragraph, Replay, ReplayPress, Row, Span, Table};
pub use contents::{Page, Section};

impl Page {
    /// The page as HTML.
    #[must_use]
    pub fn render(&self) -> String {
        html::page(self)
    }

    /// Writes the page to `path`; the file appears complete or not at all.
    ///
    /// # Errors
    /// [`PlotError::Write`] if the file cannot be written.
    pub fn write(&self, path: &Path) -> Result<(), PlotError> {
        PlotError::write_whole(path, self.render().as_bytes())
    }
}
