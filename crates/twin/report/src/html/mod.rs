//! The report as one HTML file: no scripts, no requests, the same bytes for the same data.

mod elements;
mod evidence;
mod figures;
mod page;
mod scores;
mod summary;

use std::fmt::Write as _;
use std::path::Path;

use crate::ReportError;
use crate::data::ReportData;
use crate::file::write_whole;
use crate::svg::escape;
use elements::{Section, badge};

pub use page::{Block, Cell, Page, PageSection};

const STYLE: &str = include_str!("style.css");

/// The whole page; parts without data are left out.
pub fn render(data: &ReportData) -> String {
    let sections: Vec<Section> = [
        scores::result(data),
        figures::presses(data),
        figures::peaks(data),
        figures::places(data),
        scores::where_it_errs(data),
        scores::recordings(data),
        scores::variants(data),
        evidence::training(data),
        evidence::bench(data),
        evidence::alignment(data),
        evidence::simulation(data),
        evidence::sensor(data),
        evidence::making_of(data),
    ]
    .into_iter()
    .flatten()
    .collect();

    let title = if data.title.is_empty() {
        "TwinTac report"
    } else {
        &data.title
    };
    let head = format!(
        "<p class=\"brand\">TwinTac report {}</p>\n<h1>{}</h1>\n{}",
        badge(data.provenance),
        escape(title),
        summary::paragraphs(data),
    );
    document(title, "", &head, &contents(&sections, true))
}

/// The sections, with a table of contents beside them if it is wanted.
fn contents(sections: &[Section], with_table: bool) -> String {
    let mut out = String::from("<div class=\"columns\">\n");
    if with_table {
        out.push_str("<nav aria-label=\"Contents\"><ul>\n");
        for section in sections {
            let _ = writeln!(
                out,
                "<li><a href=\"#{}\">{}</a></li>",
                section.id,
                escape(section.title)
            );
        }
        out.push_str("</ul></nav>\n");
    }
    out.push_str("<main>\n");
    for section in sections {
        let (id, title, body) = (section.id, escape(section.title), &section.body);
        let _ = writeln!(out, "<section id=\"{id}\">\n<h2>{title}</h2>\n{body}</section>");
    }
    out.push_str("</main>\n</div>\n");
    out
}

/// A whole HTML document; `class` is its body's.
fn document(title: &str, class: &str, head: &str, body: &str) -> String {
    let title = escape(title);
    let class = if class.is_empty() {
        String::new()
    } else {
        format!(" class=\"{class}\"")
    };
    format!(
        "<!doctype html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n\
         <meta name=\"viewport\" content=\"width=device-width,initial-scale=1\">\n\
         <meta name=\"color-scheme\" content=\"light dark\">\n<title>{title}</title>\n\
         <style>\n{STYLE}</style>\n</head>\n<body{class}>\n<header>\n{head}</header>\n{body}</body>\n</html>\n"
    )
}

/// Writes the page to `path`, whole or not at all.
///
/// # Errors
/// [`ReportError::Write`] if the file cannot be written.
pub fn write(path: &Path, data: &ReportData) -> Result<(), ReportError> {
    write_whole(path, render(data).as_bytes())
}
