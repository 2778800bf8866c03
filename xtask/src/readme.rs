//! The commands of README.md, run word for word: the lines of fenced blocks that are tagged `sh`,
//! in the root of the checkout.
//!
//! Those of the book are run by `python/tests/test_docs.py`.

use std::fs;
use std::path::Path;
use std::process::{Command, Stdio};
use std::time::Instant;

use anyhow::{Context, Result, ensure};

/// The commands of a document's blocks that are tagged `sh`, without comments at their ends.
pub fn commands(document: &str) -> Vec<String> {
    let mut commands = Vec::new();
    let mut block: Option<bool> = None; // inside of one, and whether it has the tag
    let mut unfinished = String::new();
    for line in document.lines() {
        if let Some(tag) = line.trim_start().strip_prefix("```") {
            block = match block {
                Some(_) => None,
                None => Some(tag.trim() == "sh"),
            };
        } else if block == Some(true) {
            let line = line.split_once(" #").map_or(line, |(command, _)| command).trim();
            if let Some(begin) = line.strip_suffix('\\') {
                unfinished += begin;
            } else if !line.is_empty() && !line.starts_with('#') {
                commands.push(std::mem::take(&mut unfinished) + line);
            }
        }
    }
    commands
}

/// Runs the commands of the README.md at `root`, each once: those of `cargo test` last, so that
/// their closing lines are. The first one that fails is an error, and so is one that leaves files
/// which git does not ignore.
pub fn run(root: &Path) -> Result<()> {
    let mut run = commands(&fs::read_to_string(root.join("README.md")).context("reading README.md")?);
    ensure!(
        !run.is_empty(),
        "README.md has no command in a block that is tagged `sh`"
    );
    run.sort_by_key(|command| command.starts_with("cargo test"));
    run.dedup();
    for command in &run {
        eprintln!("run: {command}");
        let before = untracked(root);
        let begin = Instant::now();
        let status = shell(root, command).status().context("starting bash")?;
        ensure!(status.success(), "`{command}` failed, {status}");
        let left = untracked(root);
        ensure!(
            left == before,
            "`{command}` left files that git does not ignore:\n{left}"
        );
        eprintln!("done in {:.0} s: {command}", begin.elapsed().as_secs_f64());
    }
    Ok(())
}

fn shell(root: &Path, command: &str) -> Command {
    let mut shell = Command::new("bash");
    shell
        .args(["-euo", "pipefail", "-c", command])
        .current_dir(root)
        .stdin(Stdio::null());
    shell
}

/// What `git status` says; nothing where there is no git.
fn untracked(root: &Path) -> String {
    let status = Command::new("git")
        .args(["status", "--porcelain"])
        .current_dir(root)
        .output();
    status.map_or_else(
        |_| String::new(),
        |status| String::from_utf8_lossy(&status.stdout).into_owned(),
    )
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)] // a test that cannot set itself up has failed

    use super::*;

    /// What comes of running README.md in a checkout that has nothing else.
    fn error_of(readme: &str) -> String {
        let folder = tempfile::tempdir().unwrap();
        fs::write(folder.path().join("README.md"), readme).unwrap();
        fs::write(folder.path().join(".gitignore"), "/runs\n").unwrap();
        for arguments in [&["init", "--quiet"][..], &["add", "."]] {
            let git = Command::new("git")
                .args(arguments)
                .current_dir(folder.path())
                .status();
            assert!(git.unwrap().success());
        }
        run(folder.path()).map_or_else(|error| format!("{error:#}"), |()| String::new())
    }

    #[test]
    fn commands_are_lines_of_blocks_with_the_tag() {
        let readme = "cargo no\n```sh\ncargo run -- demo   # a comment\n\n# cargo comment\n```\n```rust\nlet no = 1;\n```\n\
            ```sh\ncargo \\\n  test\n```\ncargo no\n```text\ncargo shown\n```\n";
        assert_eq!(commands(readme), ["cargo run -- demo", "cargo test"]);
    }

    #[test]
    fn every_command_is_run_as_it_stands() {
        let readme = "```sh\nmkdir runs; echo one > runs/one   # a comment\ntest -f runs/one\n```\n```text\nfalse\n```\n";
        assert_eq!(error_of(readme), "");
    }

    #[test]
    fn a_broken_command_is_an_error() {
        let error = error_of("```sh\ntrue\ntest -f runs/no-such-file\n```\n");
        assert!(error.contains("`test -f runs/no-such-file` failed"), "{error}");
    }

    #[test]
    fn a_file_that_git_does_not_ignore_is_an_error() {
        let error = error_of("```sh\ntouch left-over\n```\n");
        assert!(
            error.contains("left files") && error.contains("left-over"),
            "{error}"
        );
    }

    #[test]
    fn a_readme_without_commands_is_an_error() {
        assert!(error_of("```\ntrue\n```\n").contains("no command"));
    }
}
