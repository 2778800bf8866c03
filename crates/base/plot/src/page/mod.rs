//! A page of texts, tables and scenes as one HTML file: no scripts, no requests, the same bytes for the same contents.

mod block;
mod html;

use std::path::Path;

use crate::PlotError;

pub use block::{Badge, Block, Card, Cell, Fact, Figure, Paragraph, Row, Span, Table};

/// A page.
#[derive(Clone, Debug, Default)]
pub struct Page {
    /// What kind of page it is, above the title.
    pub kind: String,
    /// Its title.
    pub title: String,
    /// Where its figures come from.
    pub badge: Badge,
    /// The result in one or two sentences; the first paragraph is set larger.
    pub lead: Vec<Paragraph>,
    /// What the reader must know before trusting a number.
    pub warnings: Vec<String>,
    /// Its parts; those without blocks are left out.
    pub sections: Vec<Section>,
    /// Whether it is to fit one printed page: small print, no table of contents.
    pub is_sheet: bool,
}

/// A part of a page.
#[derive(Clone, Debug, Default)]
pub struct Section {
    /// Anchor.
    pub id: &'static str,
    /// Heading.
    pub title: &'static str,
    /// What it shows.
    pub blocks: Vec<Block>,
}

impl Page {
    /// The page as HTML.
    #[must_use]
    pub fn render(&self) -> String {
        html::page(self)
    }

    /// Writes the page to `path`, whole or not at all.
    ///
    /// # Errors
    /// [`PlotError::Write`] if the file cannot be written.
    pub fn write(&self, path: &Path) -> Result<(), PlotError> {
        PlotError::write_whole(path, self.render().as_bytes())
    }
}
