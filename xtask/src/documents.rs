//! README.md, ARCHITECTURE.md and the pages beside them name files that exist.

use std::fs;
use std::path::{Path, PathBuf};

use anyhow::{Context, Result, ensure};

/// Folders of the checkout that documents name files of.
const FOLDERS: [&str; 13] = [
    "crates",
    "sensors",
    "protocols",
    "imports",
    "realities",
    "rigs",
    "materials",
    "xtask",
    "docs",
    "firmware",
    "fuzz",
    "hardware",
    "python",
];

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

/// Each path in backquotes in README.md and ARCHITECTURE.md exists, unless it has a placeholder.
pub fn files_named_exist(root: &Path) -> Result<()> {
    for document in ["README.md", "ARCHITECTURE.md"] {
        let text = fs::read_to_string(root.join(document)).with_context(|| format!("reading {document}"))?;
        for (number, line) in text.lines().enumerate() {
            for quoted in line.split('`').skip(1).step_by(2) {
                let is_ours = FOLDERS.contains(&quoted.split('/').next().unwrap_or_default());
                let is_file = quoted.contains('/') && !quoted.contains(['*', '{', ' ']);
                ensure!(
                    !is_ours || !is_file || root.join(quoted).exists(),
                    "{document}:{}: `{quoted}` does not exist",
                    number + 1
                );
            }
        }
    }
    Ok(())
}

/// Each link between documents leads to a file: those at the root, those of `docs`, and the README of each package.
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

fn documents(root: &Path) -> Result<Vec<PathBuf>> {
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
