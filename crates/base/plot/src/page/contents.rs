//! The contents of a page.

use super::block::{Badge, Block, Paragraph};

/// A page.
#[derive(Clone, Debug, Default)]
pub struct Page {
    /// Kind of the page, shown above the title.
    pub kind: String,
    /// Its title.
    pub title: String,
    /// Provenance of its figures.
    pub badge: Badge,
    /// The result in one or two sentences; the first paragraph has larger print.
    pub lead: Vec<Paragraph>,
    /// Warnings that the reader must know before trusting a number.
    pub warnings: Vec<String>,
    /// Its sections; those without blocks are left out.
    pub sections: Vec<Section>,
    /// Whether it should fit one printed page: small print, no table of contents.
    pub is_sheet: bool,
}

/// A section of a page.
#[derive(Clone, Debug, Default)]
pub struct Section {
    /// Anchor.
    pub id: &'static str,
    /// Heading.
    pub title: &'static str,
    /// Its contents.
    pub blocks: Vec<Block>,
}
