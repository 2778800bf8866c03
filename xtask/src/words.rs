//! Words that pages and names no longer have (`xtask/words.toml`).

use std::collections::BTreeMap;
use std::fs;
use std::path::Path;

use anyhow::{Context, Result};
use serde::Deserialize;

use crate::code::{identifiers, rust_files};
use crate::documents::documents;

const LIST: &str = "xtask/words.toml";

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct List {
    /// Each word or phrase in lower case, and what to write instead.
    gone: BTreeMap<String, String>,
    /// Each part of a name, and what to write instead.
    gone_names: BTreeMap<String, String>,
}

fn list(root: &Path) -> Result<List> {
    let text = fs::read_to_string(root.join(LIST)).with_context(|| format!("reading {LIST}"))?;
    toml::from_str(&text).context(LIST)
}

/// Each place of a page that has one of the words, and what to write instead. Code, links and what
/// stands in backquotes is left out.
pub fn gone_words(root: &Path) -> Result<Vec<String>> {
    let List { gone, .. } = list(root)?;
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

/// Each name in Rust sources that has one of the words as a part, and what to write instead. Former
/// names of fields and options, which are still read, are strings and do not count.
pub fn gone_names(root: &Path) -> Result<Vec<String>> {
    let List { gone_names, .. } = list(root)?;
    let mut found = Vec::new();
    for path in rust_files(root, &["crates", "xtask", "fuzz", "python", "web"])? {
        let text = fs::read_to_string(&path)?;
        let tokens = text.parse().map_err(|error| anyhow::anyhow!("{error}"));
        let names = identifiers(tokens.with_context(|| format!("reading {}", path.display()))?);
        let place = path.strip_prefix(root)?.display();
        for name in names {
            for part in parts(&name) {
                if let Some(instead) = gone_names.get(&part) {
                    found.push(format!("{place}: `{name}`: write `{instead}` for `{part}`"));
                }
            }
        }
    }
    Ok(found)
}

/// The words of a name, in lower case.
fn parts(name: &str) -> Vec<String> {
    let mut parts = vec![String::new()];
    let mut was_lower = false;
    for letter in name.chars() {
        if letter == '_' || (letter.is_uppercase() && was_lower) {
            parts.push(String::new());
        }
        was_lower = letter.is_lowercase();
        if let (Some(last), true) = (parts.last_mut(), letter != '_') {
            last.extend(letter.to_lowercase());
        }
    }
    parts
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

    #[test]
    fn names_consist_of_words() {
        let of = |name: &str| parts(name).join(" ");
        assert_eq!(of("EmulatorConfiguration"), "emulator configuration");
        assert_eq!(of("n_trained_on"), "n trained on");
        assert_eq!(of("BLOCK_MM"), "block mm");
    }
}
