//! A library says of itself that it has no unit tests, or no examples in its documentation, where
//! it has none: each is a program that is built and linked to test nothing.

use std::fs;
use std::path::Path;

use anyhow::{Context, Result, ensure};
use toml::Table;

use super::rust_files;

/// `[lib] test = false` stands in the manifest of a library without `#[test]`, `doctest = false` in
/// that of one without an example, and nowhere else.
pub fn says_what_is_tested(root: &Path, folder: &str) -> Result<()> {
    if !root.join(folder).join("src/lib.rs").exists() {
        return Ok(());
    }
    let manifest = root.join(folder).join("Cargo.toml");
    let text = fs::read_to_string(&manifest).with_context(|| format!("reading {}", manifest.display()))?;
    let manifest: Table = text.parse()?;
    let (mut has_tests, mut has_examples) = (false, false);
    for path in rust_files(root, &[&format!("{folder}/src")])? {
        let text = fs::read_to_string(&path)?;
        has_tests |= text.contains("#[test]") || text.contains("proptest! {");
        has_examples |= has_example(&text);
    }
    for (key, has) in [("test", has_tests), ("doctest", has_examples)] {
        let said = manifest
            .get("lib")
            .and_then(|lib| lib.get(key))
            .and_then(toml::Value::as_bool);
        ensure!(
            has == said.unwrap_or(true),
            "{folder}/Cargo.toml: `[lib] {key} = false` should {}stand there",
            if has { "not " } else { "" }
        );
    }
    Ok(())
}

/// Whether documentation comments have a block of Rust.
fn has_example(text: &str) -> bool {
    let comments = text.lines().map(str::trim_start);
    let mut documentation =
        comments.filter_map(|line| line.strip_prefix("//!").or_else(|| line.strip_prefix("///")));
    let mut is_inside = false;
    let begins = documentation.any(|line| {
        let Some(language) = line.trim_start().strip_prefix("```") else {
            return false;
        };
        is_inside = !is_inside;
        let rust = ["", "no_run", "ignore", "should_panic", "compile_fail", "rust"];
        is_inside && language.split(',').all(|word| rust.contains(&word.trim()))
    });
    begins || text.contains("doc = include_str!")
}

#[cfg(test)]
mod tests {
    use super::has_example;

    #[test]
    fn an_example_is_a_block_of_rust() {
        assert!(has_example("/// Text.\n/// ```\n/// f();\n/// ```\nfn f() {}"));
        assert!(has_example("//! ```no_run\n//! f();\n//! ```\n"));
        assert!(!has_example("//! ```text\n//! a/   folder\n//! ```\n//! Text.\n"));
        assert!(!has_example("// ```\n// f();\n// ```\n"));
    }
}
