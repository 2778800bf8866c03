//! How long functions and files are, and how wide comments.

use std::fs;
use std::path::Path;

use anyhow::{Context, Result};
use syn::spanned::Spanned;
use syn::visit::{self, Visit};

use super::rust_files;

/// A function of more lines needs a comment `// long: why` above it or as its first line.
pub const MOST_LINES: usize = 100;

/// A file of more bytes holds more than one idea.
pub const MOST_BYTES: usize = 30_000;

/// A line of a comment or of a page that is wider makes its reader scroll.
pub const MOST_COLUMNS: usize = 100;

/// Functions of more than [`MOST_LINES`] that give no reason: one line of text each.
pub fn long_functions(root: &Path, folder: &str) -> Result<Vec<String>> {
    let mut found = Vec::new();
    for path in rust_files(root, &[folder])? {
        let text = fs::read_to_string(&path)?;
        let syntax = syn::parse_file(&text).with_context(|| format!("parsing {}", path.display()))?;
        let mut reader = Reader {
            lines: text.lines().collect(),
            found: Vec::new(),
        };
        reader.visit_file(&syntax);
        let place = path.strip_prefix(root).unwrap_or(&path).display();
        found.extend(reader.found.iter().map(|line| format!("{place}:{line}")));
    }
    Ok(found)
}

/// Files of more than [`MOST_BYTES`].
pub fn large_files(root: &Path, folder: &str) -> Result<Vec<String>> {
    let mut found = Vec::new();
    for path in rust_files(root, &[folder])? {
        let size = fs::metadata(&path)?.len();
        if size > MOST_BYTES as u64 {
            found.push(format!("{} has {size} bytes", path.strip_prefix(root)?.display()));
        }
    }
    Ok(found)
}

/// Lines of comments that are wider than [`MOST_COLUMNS`], where they can be broken. Tables and
/// examples of code are left out.
pub fn wide_comments(root: &Path, folder: &str) -> Result<Vec<String>> {
    let mut found = Vec::new();
    for path in rust_files(root, &[folder])? {
        let text = fs::read_to_string(&path)?;
        let place = path.strip_prefix(root)?.display();
        let mut fence: Option<&str> = None;
        for (number, line) in text.lines().enumerate() {
            let Some(comment) = line.trim_start().strip_prefix("//") else {
                fence = None;
                continue;
            };
            let comment = comment.trim_start_matches(['/', '!']).trim_start();
            if let Some(language) = comment.strip_prefix("```") {
                fence = if fence.is_none() { Some(language) } else { None };
            }
            let is_code = fence.is_some_and(|language| language != "text");
            if !is_code && !comment.starts_with('|') && is_wide(line) {
                found.push(format!("{place}:{}", number + 1));
            }
        }
    }
    Ok(found)
}

/// Whether a line is wider than [`MOST_COLUMNS`] and has a blank to break it at.
pub fn is_wide(line: &str) -> bool {
    line.chars().count() > MOST_COLUMNS && line.trim().trim_start_matches(['/', '!', '-', ' ']).contains(' ')
}

struct Reader<'text> {
    lines: Vec<&'text str>,
    found: Vec<String>,
}

impl Reader<'_> {
    fn look(&mut self, attributes: &[syn::Attribute], signature: &syn::Signature, block: &syn::Block) {
        let begin = signature.span().start().line;
        let lines = block.span().end().line + 1 - begin;
        let first = attributes
            .first()
            .map_or(begin, |attribute| attribute.span().start().line);
        let around = first.saturating_sub(2)..=block.span().start().line; // counted from 0: the line before, to the first of the body
        let has_reason = around
            .filter_map(|line| self.lines.get(line))
            .any(|line| line.trim_start().starts_with("// long: "));
        if lines > MOST_LINES && !has_reason {
            self.found
                .push(format!("{begin}: `{}` has {lines} lines", signature.ident));
        }
    }
}

impl<'ast> Visit<'ast> for Reader<'_> {
    fn visit_item_fn(&mut self, item: &'ast syn::ItemFn) {
        self.look(&item.attrs, &item.sig, &item.block);
        visit::visit_item_fn(self, item);
    }

    fn visit_impl_item_fn(&mut self, item: &'ast syn::ImplItemFn) {
        self.look(&item.attrs, &item.sig, &item.block);
        visit::visit_impl_item_fn(self, item);
    }

    fn visit_trait_item_fn(&mut self, item: &'ast syn::TraitItemFn) {
        if let Some(block) = &item.default {
            self.look(&item.attrs, &item.sig, block);
        }
        visit::visit_trait_item_fn(self, item);
    }
}
