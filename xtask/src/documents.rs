//! Pages name files that exist.

use std::fs;
use std::path::{Path, PathBuf};

use anyhow::{Context, Result, ensure};

use crate::code::length::{MOST_COLUMNS, is_wide};

/// Folders of the checkout that documents name files of.
const FOLDERS: [&str; 13] = [
    "crates",
    "sensors",
    "protocols",
    "imports",
    "emulators",
    "rigs",
    "materials",
    "xtask",
    "docs",
    "firmware",
    "fuzz",
    "hardware",
    "python",
];

/// Reads a file of the checkout.
pub fn read(root: &Path, file: &str) -> Result<String> {
    fs::read_to_string(root.join(file)).with_context(|| format!("reading {file}"))
}

/// Writes what stands between `<!-- NAME -->` and `<!-- end -->` anew.
pub fn replace_part(text: &mut String, name: &str, part: &str) -> Result<()> {
    let begin = format!("<!-- {name} -->\n");
    let from = text
        .find(&begin)
        .with_context(|| format!("there is no line `{}`", begin.trim()))?
        + begin.len();
    let length = text[from..]
        .find("<!-- end -->")
        .with_context(|| format!("the part `{name}` has no end"))?;
    text.replace_range(from..from + length, part);
    Ok(())
}

/// An item of a list, in lines of at most [`MOST_COLUMNS`].
pub fn item(text: &str) -> String {
    let mut lines = String::new();
    let mut line = "-".to_owned();
    for word in text.split_whitespace() {
        if line.chars().count() + 1 + word.chars().count() > MOST_COLUMNS {
            lines += &line;
            lines += "\n";
            line = " ".to_owned();
        }
        line += " ";
        line += word;
    }
    lines + &line + "\n"
}

/// Each path in backquotes in a page exists, unless it has a placeholder. Changes may name files of
/// before.
pub fn files_named_exist(root: &Path) -> Result<()> {
    let documents = documents(root)?;
    for document in documents.iter().filter(|page| !page.ends_with("CHANGELOG.md")) {
        let text = fs::read_to_string(document).with_context(|| format!("reading {}", document.display()))?;
        for (number, line) in text.lines().enumerate() {
            for quoted in line.split('`').skip(1).step_by(2) {
                let is_ours = FOLDERS.contains(&quoted.split('/').next().unwrap_or_default());
                let is_file = quoted.contains('/') && !quoted.contains(['*', '{', ' ', '<']);
                ensure!(
                    !is_ours || !is_file || root.join(quoted).exists(),
                    "{}:{}: `{quoted}` does not exist",
                    document.display(),
                    number + 1
                );
            }
        }
    }
    Ok(())
}

/// Each link between documents leads to a file: those at the root, those of `docs`, and the README
/// of each package.
pub fn links_lead_somewhere(root: &Path) -> Result<()> {
    for document in documents(root)? {
        let text =
            fs::read_to_string(&document).with_context(|| format!("reading {}", document.display()))?;
        for (number, line) in text.lines().enumerate() {
            for link in line.split("](").skip(1).filter_map(|rest| rest.split(')').next()) {
                let file = link.split('#').next().unwrap_or_default();
                let is_there = link.contains("://") || document.with_file_name(file).exists();
                ensure!(
                    file.is_empty() || is_there,
                    "{}:{}: `{link}` leads nowhere",
                    document.display(),
                    number + 1
                );
            }
        }
    }
    Ok(())
}

/// Lines of prose that are wider than a reader sees: those of tables, headings, pictures and code
/// are left out, and so are pages that programs write.
pub fn wide_lines(root: &Path) -> Result<Vec<String>> {
    let written = ["docs/benchmarks", "docs/verification"].map(|folder| root.join(folder));
    let is_written = |page: &PathBuf| written.iter().any(|folder| page.parent() == Some(folder));
    let mut found = Vec::new();
    for document in documents(root)?.into_iter().filter(|page| !is_written(page)) {
        let text =
            fs::read_to_string(&document).with_context(|| format!("reading {}", document.display()))?;
        let mut is_code = false;
        for (number, line) in text.lines().enumerate() {
            let line = line.trim_start();
            is_code ^= line.starts_with("```");
            let is_prose = !is_code && !line.starts_with(['|', '#', '!', '<', '`', '$']);
            if is_prose && is_wide(line) {
                let place = document.strip_prefix(root)?.display();
                found.push(format!("{place}:{}", number + 1));
            }
        }
    }
    Ok(found)
}

/// The pages: those at the root, those of `docs`, and the README of each package.
pub fn documents(root: &Path) -> Result<Vec<PathBuf>> {
    let mut documents = Vec::new();
    let mut pending = vec![
        root.to_owned(),
        root.join("docs"),
        root.join("crates"),
        root.join("python"),
    ];
    while let Some(folder) = pending.pop() {
        for entry in fs::read_dir(&folder).with_context(|| format!("reading {}", folder.display()))? {
            let path = entry?.path();
            let is_below = folder != root && path.file_name().is_some_and(|name| name != "target");
            if path.is_dir() && is_below {
                pending.push(path);
            } else if path.file_name().is_some_and(|name| name == "README.md") || is_page(root, &path) {
                documents.push(path);
            }
        }
    }
    documents.sort();
    Ok(documents)
}

/// A page at the root or in `docs`.
fn is_page(root: &Path, path: &Path) -> bool {
    let is_markdown = path.extension().is_some_and(|extension| extension == "md");
    is_markdown && (path.parent() == Some(root) || path.starts_with(root.join("docs")))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_item_has_no_wide_line() {
        let text = item(&"word ".repeat(50));
        assert!(
            text.starts_with("- word word") && text.contains("\n  word"),
            "{text}"
        );
        assert!(
            text.lines().all(|line| line.chars().count() <= MOST_COLUMNS),
            "{text}"
        );
    }
}
