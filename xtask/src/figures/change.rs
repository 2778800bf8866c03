//! What has changed since a commit, and counts.

use std::fs;
use std::path::Path;

use anyhow::{Context, Result};

use super::{script, source};
use crate::git::git;

/// Folders of a package that make no figure, unless they are named.
const BESIDE: [&str; 3] = ["tests", "benches", "examples"];

/// Parts of a `Cargo.toml` that change what is built.
const BUILT: [&str; 4] = ["dependencies", "build-dependencies", "features", "target"];

/// Files under `inputs` that differ between a commit and the checkout in more than comments and
/// tests. `named` are inputs that count as they stand.
pub(super) fn since(root: &Path, commit: &str, inputs: &[String], named: &[String]) -> Result<Vec<String>> {
    git(root, &["cat-file", "-e", &format!("{commit}^{{commit}}")])
        .with_context(|| format!("commit {commit} is not in this clone: fetch its whole history"))?;
    let mut arguments = vec!["diff", "--no-renames", "--name-only", commit, "--"];
    arguments.extend(inputs.iter().map(String::as_str));
    let mut changed = Vec::new();
    for file in git(root, &arguments)?.lines() {
        let is_named = named.iter().any(|path| Path::new(file).starts_with(path));
        if !is_named && is_beside(file) || is_document(file) {
            continue;
        }
        let before = git(root, &["show", &format!("{commit}:{file}")]).ok();
        let now = fs::read_to_string(root.join(file)).ok();
        let differs = match (before, now) {
            // Not of text, gone or new.
            (None, _) | (_, None) => true,
            (Some(before), Some(now)) => essence(file, &before) != essence(file, &now),
        };
        if differs {
            changed.push(file.to_owned());
        }
    }
    Ok(changed)
}

fn is_beside(file: &str) -> bool {
    let mut parts = file.split('/');
    parts.any(|part| BESIDE.contains(&part) || part == "tests.rs")
}

fn is_document(file: &str) -> bool {
    let name = file.rsplit('/').next().unwrap_or(file);
    name.ends_with(".md") || name.starts_with("LICENSE-")
}

/// What a file says to a program.
fn essence(file: &str, text: &str) -> String {
    let own = || text.trim().to_owned();
    if file.ends_with(".rs") {
        source::without_comments_and_tests(text).unwrap_or_else(own)
    } else if file.ends_with(".py") {
        script::without_comments(text)
    } else if file.ends_with(".toml") {
        let Ok(mut table) = text.parse::<toml::Table>() else {
            return own();
        };
        if file.ends_with("Cargo.toml") {
            table.retain(|name, _| BUILT.contains(&name));
        }
        table.to_string()
    } else {
        own()
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;

    /// A checkout whose `code/src/lib.rs` and `code/tests/t.rs` are committed.
    fn checkout() -> (tempfile::TempDir, String) {
        let folder = tempfile::tempdir().unwrap();
        let root = folder.path();
        for (file, text) in [
            ("code/src/lib.rs", "/// Two.\npub fn two() -> u32 {\n    2\n}\n"),
            ("code/tests/t.rs", "#[test]\nfn t() {}\n"),
            ("code/table.toml", "a = 1 # one\n"),
            ("code/README.md", "Two.\n"),
            ("code/LICENSE-MIT", "A text.\n"),
        ] {
            let path = root.join(file);
            fs::create_dir_all(path.parent().unwrap()).unwrap();
            fs::write(path, text).unwrap();
        }
        let user = ["-c", "user.name=nobody", "-c", "user.email=nobody@example.org"];
        git(root, &["init", "--quiet"]).unwrap();
        git(root, &["add", "."]).unwrap();
        git(root, &[&user[..], &["commit", "--quiet", "-m", "all"]].concat()).unwrap();
        let commit = git(root, &["rev-parse", "HEAD"]).unwrap();
        (folder, commit)
    }

    fn changed(root: &Path, commit: &str) -> Vec<String> {
        since(root, commit, &["code".to_owned()], &[]).unwrap()
    }

    #[test]
    fn comments_tests_and_documents_change_nothing() {
        let (folder, commit) = checkout();
        let root = folder.path();
        assert_eq!(changed(root, &commit), Vec::<String>::new());
        let text = "//! All.\n\n/// The number two.\npub fn two() -> u32 {\n    2 // two\n}\n\n#[cfg(test)]\nmod tests {}\n";
        fs::write(root.join("code/src/lib.rs"), text).unwrap();
        fs::write(root.join("code/tests/t.rs"), "#[test]\nfn other() {}\n").unwrap();
        fs::write(root.join("code/table.toml"), "# One.\na = 1\n").unwrap();
        fs::write(root.join("code/README.md"), "All.\n").unwrap();
        fs::write(root.join("code/LICENSE-MIT"), "Another text.\n").unwrap();
        assert_eq!(changed(root, &commit), Vec::<String>::new());
    }

    #[test]
    fn another_number_counts_and_so_does_a_file_that_is_gone() {
        let (folder, commit) = checkout();
        let root = folder.path();
        fs::write(root.join("code/table.toml"), "a = 2\n").unwrap();
        assert_eq!(changed(root, &commit), ["code/table.toml"]);
        fs::remove_file(root.join("code/src/lib.rs")).unwrap();
        assert_eq!(changed(root, &commit), ["code/src/lib.rs", "code/table.toml"]);
    }

    #[test]
    fn a_commit_that_nobody_has_is_said() {
        let (folder, _) = checkout();
        let error = since(folder.path(), "0123456", &["code".to_owned()], &[]).unwrap_err();
        assert!(error.to_string().contains("not in this clone"), "{error}");
    }
}
