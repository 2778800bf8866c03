//! The few elements that the page is made of.

use std::fmt::Write as _;

use crate::axis::fixed;
use crate::data::Provenance;
use crate::scene::Scene;
use crate::svg::{escape, svg};

/// A part of the page with a line in the table of contents.
pub(super) struct Section {
    /// Anchor.
    pub(super) id: &'static str,
    /// Heading.
    pub(super) title: &'static str,
    /// HTML.
    pub(super) body: String,
}

impl Section {
    /// A section, unless its body is empty.
    pub(super) fn new(id: &'static str, title: &'static str, body: String) -> Option<Self> {
        (!body.is_empty()).then_some(Section { id, title, body })
    }
}

/// The pill that says where a number comes from.
pub(super) fn badge(provenance: Provenance) -> String {
    let word = provenance.word();
    format!("<span class=\"badge {word}\">{word}</span>")
}

/// A picture with its caption, and a badge if its numbers come from a sensor or stand for one.
pub(super) fn figure(scene: &Scene, provenance: impl Into<Option<Provenance>>, caption: &str) -> String {
    framed_figure("", scene, provenance.into(), caption)
}

/// A picture that takes the whole width.
pub(super) fn wide_figure(scene: &Scene, caption: &str) -> String {
    framed_figure(" class=\"wide\"", scene, None, caption)
}

fn framed_figure(class: &str, scene: &Scene, provenance: Option<Provenance>, caption: &str) -> String {
    let badge = provenance.map_or(String::new(), badge);
    let (picture, caption) = (svg(scene), escape(caption));
    format!(
        "<figure{class}><div class=\"plot\">{picture}</div><figcaption>{badge} {caption}</figcaption></figure>\n"
    )
}

/// Figures beside each other where there is room.
pub(super) fn figures(figures: &[String]) -> String {
    if figures.is_empty() {
        String::new()
    } else {
        format!("<div class=\"figures\">\n{}</div>\n", figures.concat())
    }
}

/// One cell of a table.
pub(super) enum Cell {
    /// Words, on the left.
    Words(String),
    /// A number, on the right.
    Number(String),
    /// Where the row's numbers come from.
    Source(Provenance),
}

impl Cell {
    pub(super) fn words(text: impl Into<String>) -> Self {
        Cell::Words(text.into())
    }

    pub(super) fn percent(value: f64) -> Self {
        Cell::Number(percent(value))
    }

    pub(super) fn count(value: usize) -> Self {
        Cell::Number(value.to_string())
    }

    pub(super) fn number(value: f64, decimals: usize) -> Self {
        Cell::Number(fixed(value, decimals))
    }
}

/// A table with its caption; rows marked `true` are emphasised. Empty without rows.
pub(super) fn table(caption: &str, head: &[&str], rows: &[(bool, Vec<Cell>)]) -> String {
    if rows.is_empty() {
        return String::new();
    }
    let is_words = |column: usize| {
        rows.iter()
            .all(|(_, row)| !matches!(row.get(column), Some(Cell::Number(_))))
    };
    let mut out = format!(
        "<div class=\"scroll\"><table><caption>{}</caption>\n<thead><tr>",
        escape(caption)
    );
    for (column, name) in head.iter().enumerate() {
        let class = if is_words(column) { "" } else { " class=\"number\"" };
        let _ = write!(out, "<th scope=\"col\"{class}>{}</th>", escape(name));
    }
    out.push_str("</tr></thead>\n<tbody>\n");
    for (emphasised, row) in rows {
        out.push_str(if *emphasised {
            "<tr class=\"chosen\">"
        } else {
            "<tr>"
        });
        for cell in row {
            let _ = match cell {
                Cell::Words(text) => write!(out, "<td>{}</td>", escape(text)),
                Cell::Number(text) => write!(out, "<td class=\"number\">{}</td>", escape(text)),
                Cell::Source(provenance) => write!(out, "<td>{}</td>", badge(*provenance)),
            };
        }
        out.push_str("</tr>\n");
    }
    out.push_str("</tbody></table></div>\n");
    out
}

/// A row of cards, each a value over its name.
pub(super) fn cards(cards: &[(String, &str, Provenance)]) -> String {
    let mut out = String::from("<div class=\"cards\">\n");
    for (value, name, provenance) in cards {
        let (value, name, badge) = (escape(value), escape(name), badge(*provenance));
        let _ = writeln!(
            out,
            "<div class=\"card\"><b>{value}</b><span>{name}</span>{badge}</div>"
        );
    }
    out.push_str("</div>\n");
    out
}

/// A paragraph.
pub(super) fn paragraph(text: &str) -> String {
    if text.is_empty() {
        String::new()
    } else {
        format!("<p>{}</p>\n", escape(text))
    }
}

/// An error in %, kept on one line, with three significant digits or so.
pub(super) fn percent(value: f64) -> String {
    if !value.is_finite() {
        return "–".into();
    }
    let decimals = if value.abs() < 9.995 { 2 } else { 1 };
    format!("{}\u{a0}%", fixed(value, decimals))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn percentages_keep_their_digits() {
        assert_eq!(percent(1.274), "1.27\u{a0}%");
        assert_eq!(percent(12.34), "12.3\u{a0}%");
        assert_eq!(percent(f64::NAN), "–");
    }

    #[test]
    fn cells_are_escaped_and_no_rows_give_no_table() {
        let row = (false, vec![Cell::words("<b>"), Cell::percent(1.0)]);
        let text = table("a & b", &["<i>", "error"], &[row]);
        assert!(text.contains("&lt;b&gt;") && text.contains("&lt;i&gt;") && text.contains("a &amp; b"));
        assert!(table("none", &["a"], &[]).is_empty());
    }
}
