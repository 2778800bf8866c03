//! A source file, and the names that it mentions.

use std::collections::BTreeSet;
use std::fs;
use std::path::{Path, PathBuf};

use anyhow::{Context, Result};
use proc_macro2::{TokenStream, TokenTree};

/// A source file of a crate that is compiled without tests.
#[derive(Debug)]
pub struct SourceFile {
    /// From the root of the checkout.
    pub path: String,
    /// Its lines.
    pub lines: Vec<String>,
    /// What it mentions outside its tests.
    pub mentions: Vec<Mention>,
}

/// A path that stands in a file: imported (one for each leaf of a `use`), or written out.
#[derive(Clone, Debug)]
pub struct Mention {
    /// `["crate", "mesh", "TetMesh"]`.
    pub segments: Vec<String>,
    /// Counted from 1.
    pub line: usize,
    /// The module that it stands in.
    pub module: Vec<String>,
    /// It is the leaf of a `pub use`, under whatever visibility.
    pub is_reexport: bool,
}

impl Mention {
    /// Its segments as they are written.
    pub fn path(&self) -> String {
        self.segments.join("::")
    }
}

/// All `.rs` files under the folders, `target` folders left out.
pub fn rust_files(root: &Path, folders: &[&str]) -> Result<Vec<PathBuf>> {
    let mut files = Vec::new();
    let mut pending: Vec<PathBuf> = folders.iter().map(|folder| root.join(folder)).collect();
    while let Some(folder) = pending.pop() {
        for entry in fs::read_dir(&folder).with_context(|| format!("reading {}", folder.display()))? {
            let path = entry?.path();
            if path.is_dir() && path.file_name().is_some_and(|name| name != "target") {
                pending.push(path);
            } else if path.extension().is_some_and(|extension| extension == "rs") {
                files.push(path);
            }
        }
    }
    files.sort();
    Ok(files)
}

/// All identifiers of a text, comments and literals left out.
pub fn identifiers(tokens: TokenStream) -> BTreeSet<String> {
    let mut found = BTreeSet::new();
    for token in tokens {
        match token {
            TokenTree::Ident(ident) => {
                found.insert(ident.to_string());
            }
            TokenTree::Group(group) => found.append(&mut identifiers(group.stream())),
            TokenTree::Punct(_) | TokenTree::Literal(_) => {}
        }
    }
    found
}

/// Paths that stand in the tokens of a macro call, with their lines. Names after a dot are fields
/// and methods, and no paths.
pub(super) fn paths_in(tokens: TokenStream, found: &mut Vec<(Vec<String>, usize)>) {
    let mut path: Option<(Vec<String>, usize)> = None;
    let mut colons = 0;
    let mut after_dot = false;
    for token in tokens {
        match &token {
            TokenTree::Ident(ident) => {
                if colons != 2 {
                    found.extend(path.take());
                }
                if !after_dot {
                    let line = ident.span().start().line;
                    path.get_or_insert((Vec::new(), line)).0.push(ident.to_string());
                }
                colons = 0;
            }
            TokenTree::Punct(punct) if punct.as_char() == ':' => colons += 1,
            _ => {
                found.extend(path.take());
                colons = 0;
            }
        }
        after_dot = matches!(&token, TokenTree::Punct(punct) if punct.as_char() == '.');
        if let TokenTree::Group(group) = token {
            paths_in(group.stream(), found);
        }
    }
    found.extend(path);
}
