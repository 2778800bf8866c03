//! What a page holds.

use super::block::{Badge, Block, Paragraph};

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
