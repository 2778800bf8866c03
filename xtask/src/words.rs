//! Words that pages no longer use (`xtask/words.toml`).

use std::collections::BTreeMap;
use std::fs;
use std::path::Path;

use anyhow::{Context, Result};
use serde::Deserialize;

use crate::documents::documents;

const LIST: &str = "xtask/words.toml";

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct List {
    /// Each word or phrase in lower case, and what to write instead.
    gone: BTreeMap<String, String>,
}

/// Each place of a page that has one of the words, and what to write instead. Code, links and what
/// stands in backquotes is left out.
pub fn gone_words(root: &Path) -> Result<Vec<String>> {
    let text = fs::read_to_string(root.join(LIST)).with_context(|| format!("reading {LIST}"))?;
    let List { gone } = toml::from_str(&text).context(LIST)?;
    let mut found = Vec::new();
    for document in documents(root)? {
        let text =
            fs::read_to_string(&document).with_context(|| format!("reading {}", document.display()))?;
        let place = document.strip_prefix(root)?.display();
        for (number, line) in prose(&text) {
            for (phrase, instead) in &gone {
                if has(&line, phrase) {
                    found.push(format!("{place}:{number}: `{phrase}`: write `{instead}`"));
                }
            }
        }
    }
    Ok(found)
}

/// Lines with their numbers, without fenced blocks, code in backquotes and targets of links.
fn prose(text: &str) -> Vec<(usize, String)> {
    let mut is_code = false;
    let mut lines = Vec::new();
    for (number, line) in text.lines().enumerate() {
        let is_fence = line.trim_start().starts_with("```");
        is_code ^= is_fence;
        if is_code || is_fence || line.trim_start().starts_with("<!--") {
            continue;
        }
        let words = line.split('`').step_by(2).collect::<Vec<_>>().join(" ` ");
        let mut parts = words.split("](");
        let mut shown = parts.next().unwrap_or_default().to_owned();
        for part in parts {
            shown += " ";
            shown += part.split_once(')').map_or("", |(_, rest)| rest);
        }
        lines.push((number + 1, shown.to_lowercase()));
    }
    lines
}

/// Whether whole words of a line are a phrase.
fn has(line: &str, phrase: &str) -> bool {
    let is_letter =
        |letter: Option<char>| letter.is_some_and(|letter| letter.is_alphanumeric() || letter == '-');
    line.match_indices(phrase).any(|(at, _)| {
        !is_letter(line[..at].chars().next_back()) && !is_letter(line[at + phrase.len()..].chars().next())
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn whole_words_count_outside_of_code_alone() {
        let text = "Lessons, `lessons` and [more](lessons.md).\n```sh\nlessons\n```\nno-lessons\n";
        let lines = prose(text);
        let found: Vec<usize> = lines
            .iter()
            .filter(|(_, line)| has(line, "lessons"))
            .map(|(number, _)| *number)
            .collect();
        assert_eq!(found, [1]);
        assert_eq!(lines[0].1.matches("lessons").count(), 1);
    }
}
