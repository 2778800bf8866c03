//! A page and its blocks as HTML.

use super::block::{Badge, Block, Card, Cell, Fact, Figure, Paragraph, Span, Table};
use super::contents::{Page, Section};
use super::replay::{SCRIPT, replay};
use crate::svg::{escape, svg};

const STYLE: &str = include_str!("style.css");

/// The whole document.
pub(super) fn page(page: &Page) -> String {
    let sections: Vec<(&Section, String)> = page
        .sections
        .iter()
        .map(|section| (section, section.blocks.iter().map(block).collect::<String>()))
        .filter(|(_, body)| !body.is_empty())
        .collect();
    let (title, class) = (
        escape(&page.title),
        if page.is_sheet { " class=\"sheet\"" } else { "" },
    );
    let contents = if page.is_sheet {
        String::new()
    } else {
        table_of_contents(&sections)
    };
    let head = format!(
        "<p class=\"brand\">{} {}</p>\n<h1>{title}</h1>\n{}{}",
        escape(&page.kind),
        badge(&page.badge),
        lead(&page.lead),
        warnings("Before you trust a number", &page.warnings),
    );
    let main: String = sections
        .iter()
        .map(|(section, body)| {
            let (id, title) = (section.id, escape(section.title));
            format!("<section id=\"{id}\">\n<h2>{title}</h2>\n{body}</section>\n")
        })
        .collect();
    let script = if main.contains("<div class=\"replay\">") {
        format!("<script>\n{SCRIPT}</script>\n")
    } else {
        String::new()
    };
    format!(
        "<!doctype html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n\
         <meta name=\"viewport\" content=\"width=device-width,initial-scale=1\">\n\
         <meta name=\"color-scheme\" content=\"light dark\">\n<title>{title}</title>\n\
         <style>\n{STYLE}</style>\n</head>\n<body{class}>\n<header>\n{head}</header>\n\
         <div class=\"columns\">\n{contents}<main>\n{main}</main>\n</div>\n{script}</body>\n</html>\n"
    )
}

fn table_of_contents(sections: &[(&Section, String)]) -> String {
    let lines: String = sections
        .iter()
        .map(|(section, _)| {
            let (id, title) = (section.id, escape(section.title));
            format!("<li><a href=\"#{id}\">{title}</a></li>\n")
        })
        .collect();
    format!("<nav aria-label=\"Contents\"><ul>\n{lines}</ul></nav>\n")
}

fn block(block: &Block) -> String {
    match block {
        Block::Text(text) => paragraph(text, ""),
        Block::Cards(shown) => cards(shown),
        Block::Facts(shown) => facts(shown),
        Block::Figures(shown) => figures(shown),
        Block::Wide(shown) => figure(shown, " class=\"wide\""),
        Block::Replay(shown) => replay(shown, badge),
        Block::Table(shown) => table(shown),
        Block::Warnings(heading, lines) => warnings(heading, lines),
        Block::Command(line) if line.is_empty() => String::new(),
        Block::Command(line) => format!("<pre class=\"command\"><code>{}</code></pre>\n", escape(line)),
        Block::Details(_, text) if text.is_empty() => String::new(),
        Block::Details(heading, text) => format!(
            "<details><summary>{}</summary><pre><code>{}</code></pre></details>\n",
            escape(heading),
            escape(text)
        ),
    }
}

fn badge(Badge(word): &Badge) -> String {
    if word.is_empty() {
        return String::new();
    }
    let word = escape(word);
    format!("<span class=\"badge {word}\">{word}</span>")
}

fn lead(paragraphs: &[Paragraph]) -> String {
    let class = |index| if index == 0 { " class=\"lead\"" } else { "" };
    let lines = paragraphs.iter().enumerate();
    lines.map(|(index, line)| paragraph(line, class(index))).collect()
}

fn paragraph(Paragraph(spans): &Paragraph, class: &str) -> String {
    if spans.is_empty() {
        return String::new();
    }
    let text: Vec<String> = spans
        .iter()
        .map(|span| match span {
            Span::Words(words) => escape(words),
            Span::Badge(shown) => badge(shown),
        })
        .collect();
    format!("<p{class}>{}</p>\n", text.join(" "))
}

/// A heading and a list; nothing if the list is empty.
fn warnings(heading: &str, lines: &[String]) -> String {
    if lines.is_empty() {
        return String::new();
    }
    let lines: String = lines
        .iter()
        .map(|line| format!("<li>{}</li>\n", escape(line)))
        .collect();
    let heading = escape(heading);
    format!("<aside class=\"warnings\" role=\"note\"><b>{heading}</b><ul>\n{lines}</ul></aside>\n")
}

fn cards(cards: &[Card]) -> String {
    if cards.is_empty() {
        return String::new();
    }
    let cards: String = cards
        .iter()
        .map(|Card { fact, badge: source }| {
            let (value, name, badge) = (escape(&fact.value), escape(&fact.name), badge(source));
            format!("<div class=\"card\"><b>{value}</b><span>{name}</span>{badge}</div>\n")
        })
        .collect();
    format!("<div class=\"cards\">\n{cards}</div>\n")
}

fn facts(facts: &[Fact]) -> String {
    if facts.is_empty() {
        return String::new();
    }
    let facts: String = facts
        .iter()
        .map(|fact| {
            let (name, value) = (escape(&fact.name), escape(&fact.value));
            format!("<div><dt>{name}</dt><dd>{value}</dd></div>\n")
        })
        .collect();
    format!("<dl class=\"facts\">\n{facts}</dl>\n")
}

/// Pictures beside each other; a picture shares its place with its table.
fn figures(shown: &[Figure]) -> String {
    if shown.is_empty() {
        return String::new();
    }
    let shown: String = shown
        .iter()
        .map(|one| match &one.table {
            Some(numbers) => format!("<div>{}{}</div>\n", figure(one, ""), table(numbers)),
            None => figure(one, ""),
        })
        .collect();
    format!("<div class=\"figures\">\n{shown}</div>\n")
}

fn figure(figure: &Figure, class: &str) -> String {
    let badge = figure.badge.as_ref().map_or(String::new(), badge);
    let (picture, caption) = (svg(&figure.scene), escape(&figure.caption));
    format!(
        "<figure{class}><div class=\"plot\">{picture}</div><figcaption>{badge} {caption}</figcaption></figure>\n"
    )
}

fn table(table: &Table) -> String {
    if table.rows.is_empty() {
        return String::new();
    }
    let is_number = |column: usize| {
        let mut cells = table.rows.iter().map(|row| row.cells.get(column));
        cells.any(|cell| matches!(cell, Some(Cell::Number(_))))
    };
    let head: String = table
        .head
        .iter()
        .enumerate()
        .map(|(column, name)| {
            let class = if is_number(column) {
                " class=\"number\""
            } else {
                ""
            };
            format!("<th scope=\"col\"{class}>{}</th>", escape(name))
        })
        .collect();
    let rows: String = table
        .rows
        .iter()
        .map(|row| {
            let class = if row.is_chosen { " class=\"chosen\"" } else { "" };
            let cells: String = row.cells.iter().map(cell).collect();
            format!("<tr{class}>{cells}</tr>\n")
        })
        .collect();
    let caption = escape(&table.caption);
    format!(
        "<div class=\"scroll\"><table><caption>{caption}</caption>\n<thead><tr>{head}</tr></thead>\n\
         <tbody>\n{rows}</tbody></table></div>\n"
    )
}

fn cell(cell: &Cell) -> String {
    match cell {
        Cell::Words(text) => format!("<td>{}</td>", escape(text)),
        Cell::Number(text) => format!("<td class=\"number\">{}</td>", escape(text)),
        Cell::Badge(source) => format!("<td>{}</td>", badge(source)),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_page_carries_its_badge_and_leaves_empty_parts_out() {
        let section = |id, blocks| Section {
            id,
            title: "a & b",
            blocks,
        };
        let sheet = Page {
            kind: "Sheet".into(),
            title: "<title>".into(),
            badge: Badge("emulated".into()),
            warnings: vec!["mind <this>".into()],
            sections: vec![
                section("one", vec![Block::Facts(vec![Fact::new("noise", "1 kPa")])]),
                section("none", vec![Block::Table(Table::default())]),
            ],
            is_sheet: true,
            ..Page::default()
        };
        let text = sheet.render();
        for part in [
            "badge emulated",
            "&lt;title&gt;",
            "mind &lt;this&gt;",
            "id=\"one\"",
        ] {
            assert!(text.contains(part), "{part}");
        }
        assert!(!text.contains("id=\"none\"") && !text.contains("<nav"));
        let long = Page {
            is_sheet: false,
            ..sheet
        };
        assert!(long.render().contains("<nav"));
    }

    #[test]
    fn cells_are_escaped_and_no_rows_give_no_table() {
        let cells = vec![Cell::Words("<b>".into()), Cell::Number("1".into())];
        let filled = Table {
            caption: "a & b".into(),
            head: ["<i>", "error"].map(str::to_owned).to_vec(),
            rows: vec![cells.into()],
        };
        let text = table(&filled);
        assert!(text.contains("&lt;b&gt;") && text.contains("&lt;i&gt;") && text.contains("a &amp; b"));
        assert!(table(&Table::default()).is_empty());
    }
}
