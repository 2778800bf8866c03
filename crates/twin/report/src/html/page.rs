//! A page put together by another crate: the same look, other contents.

use std::fmt::Write as _;
use std::path::Path;

use super::elements::{
    Cell as HtmlCell, Section, badge, cards, figure, figures, paragraph, table, wide_figure,
};
use super::{contents, document};
use crate::ReportError;
use crate::data::{Fact, Provenance};
use crate::file::write_whole;
use crate::scene::Scene;
use crate::svg::escape;

/// A page whose figures have one origin.
#[derive(Clone, Debug)]
pub struct Page {
    /// What kind of page it is, above the title.
    pub kind: String,
    /// Its title.
    pub title: String,
    /// Where all its figures come from.
    pub provenance: Provenance,
    /// The result in one or two sentences.
    pub lead: String,
    /// What the reader must know before trusting a number.
    pub warnings: Vec<String>,
    /// Its parts; those without blocks are left out.
    pub sections: Vec<PageSection>,
    /// Whether it is to fit one printed page: small print, no table of contents.
    pub is_sheet: bool,
}

/// A part of a page.
#[derive(Clone, Debug)]
pub struct PageSection {
    /// Anchor.
    pub id: &'static str,
    /// Heading.
    pub title: &'static str,
    /// What it shows.
    pub blocks: Vec<Block>,
}

/// A thing on a page.
#[derive(Clone, Debug)]
pub enum Block {
    /// A paragraph.
    Text(String),
    /// Values with their names, large.
    Cards(Vec<Fact>),
    /// Values with their names, as a list.
    Facts(Vec<Fact>),
    /// Pictures with captions, beside each other where there is room.
    Figures(Vec<(Scene, String)>),
    /// A picture with its caption that takes the whole width.
    Wide(Scene, String),
    /// A table: caption, heads, rows of cells.
    Table(String, Vec<String>, Vec<Vec<Cell>>),
}

/// A cell of a table.
#[derive(Clone, Debug)]
pub enum Cell {
    /// On the left.
    Words(String),
    /// On the right.
    Number(String),
}

impl Page {
    /// The page as HTML: no scripts, no requests, the same bytes for the same contents.
    #[must_use]
    pub fn render(&self) -> String {
        let section = |section: &PageSection| {
            let body = section.blocks.iter().map(|block| self.block(block)).collect();
            Section::new(section.id, section.title, body)
        };
        let sections: Vec<Section> = self.sections.iter().filter_map(section).collect();
        let mut head = format!(
            "<p class=\"brand\">{} {}</p>\n<h1>{}</h1>\n",
            escape(&self.kind),
            badge(self.provenance),
            escape(&self.title)
        );
        if !self.lead.is_empty() {
            let _ = writeln!(head, "<p class=\"lead\">{}</p>", escape(&self.lead));
        }
        head.push_str(&super::summary::warnings(&self.warnings));
        let body = contents(&sections, !self.is_sheet);
        document(
            &self.title,
            if self.is_sheet { "sheet" } else { "" },
            &head,
            &body,
        )
    }

    /// Writes the page to `path`, whole or not at all.
    ///
    /// # Errors
    /// [`ReportError::Write`] if the file cannot be written.
    pub fn write(&self, path: &Path) -> Result<(), ReportError> {
        write_whole(path, self.render().as_bytes())
    }

    fn block(&self, block: &Block) -> String {
        match block {
            Block::Text(text) => paragraph(text),
            Block::Cards(facts) => {
                let rows: Vec<_> = facts
                    .iter()
                    .map(|fact| (fact.value.clone(), fact.name.as_str(), self.provenance))
                    .collect();
                cards(&rows)
            }
            Block::Facts(facts) => super::evidence::fact_list(facts),
            Block::Figures(pictures) => {
                let pictures = pictures.iter();
                let pictures: Vec<String> = pictures
                    .map(|(scene, caption)| figure(scene, self.provenance, caption))
                    .collect();
                figures(&pictures)
            }
            Block::Wide(scene, caption) => wide_figure(scene, caption),
            Block::Table(caption, head, rows) => {
                let heads: Vec<&str> = head.iter().map(String::as_str).collect();
                let cell = |cell: &Cell| match cell {
                    Cell::Words(text) => HtmlCell::Words(text.clone()),
                    Cell::Number(text) => HtmlCell::Number(text.clone()),
                };
                let rows: Vec<_> = rows
                    .iter()
                    .map(|row| (false, row.iter().map(cell).collect()))
                    .collect();
                table(caption, &heads, &rows)
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_page_carries_its_badge_and_leaves_empty_parts_out() {
        let section = |id, blocks| PageSection {
            id,
            title: "a & b",
            blocks,
        };
        let page = Page {
            kind: "Sheet".into(),
            title: "<title>".into(),
            provenance: Provenance::Emulated,
            lead: String::new(),
            warnings: vec!["mind <this>".into()],
            sections: vec![
                section("one", vec![Block::Facts(vec![Fact::new("noise", "1 kPa")])]),
                section("none", Vec::new()),
            ],
            is_sheet: true,
        };
        let text = page.render();
        assert!(
            text.contains("badge emulated")
                && text.contains("&lt;title&gt;")
                && text.contains("mind &lt;this&gt;")
        );
        assert!(text.contains("id=\"one\"") && !text.contains("id=\"none\"") && !text.contains("<nav"));
        let long = Page {
            is_sheet: false,
            ..page
        };
        assert!(long.render().contains("<nav"));
    }
}
