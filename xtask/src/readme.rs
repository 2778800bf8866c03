//! The commands of README.md, run word for word.
//!
//! A command is a line of a fenced block that is tagged `sh`, or not tagged at all. `xtask/readme.toml` names those that are not run, each with the
//! reason; of these, the options are looked up in the program's `--help`. Everything else is run by [`run`], in the root of the checkout.

use std::fs;
use std::path::Path;
use std::process::{Command, Stdio};
use std::time::Instant;

use anyhow::{Context, Result, bail, ensure};
use serde::Deserialize;

/// `xtask/readme.toml`.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Exceptions {
    #[serde(default)]
    not_run: Vec<NotRun>,
    #[serde(default)]
    needs: Vec<Needs>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct NotRun {
    command: String,
    why: String,
}

/// A command that is run where a file exists.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Needs {
    command: String,
    file: String,
}

/// What becomes of a command of README.md.
#[derive(Debug, PartialEq, Eq)]
pub enum Fate {
    /// It is run.
    Run,
    /// It is not run, for this reason.
    NotRun(String),
}

/// The commands of README.md in its order, without comments at their ends.
pub fn commands(readme: &str) -> Vec<String> {
    let mut commands = Vec::new();
    let mut block: Option<bool> = None; // inside of one, and whether it is of commands
    let mut unfinished = String::new();
    for line in readme.lines() {
        if let Some(tag) = line.trim_start().strip_prefix("```") {
            block = match block {
                Some(_) => None,
                None => Some(["", "sh"].contains(&tag.trim())),
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

/// The commands of README.md at `root`, and what becomes of each. An exception whose command does not stand in README.md is an error.
pub fn fates(root: &Path) -> Result<Vec<(String, Fate)>> {
    let read = |name: &str| fs::read_to_string(root.join(name)).with_context(|| format!("reading {name}"));
    let commands = commands(&read("README.md")?);
    ensure!(!commands.is_empty(), "README.md has no commands");
    let exceptions: Exceptions =
        toml::from_str(&read("xtask/readme.toml")?).context("reading xtask/readme.toml")?;
    let not_run = exceptions.not_run.iter().map(|exception| &exception.command);
    for command in not_run.chain(exceptions.needs.iter().map(|exception| &exception.command)) {
        ensure!(
            commands.contains(command),
            "xtask/readme.toml has `{command}`, which does not stand in README.md"
        );
    }
    let fate = |command: &String| {
        let not_run = exceptions
            .not_run
            .iter()
            .find(|exception| exception.command == *command);
        let needs = exceptions
            .needs
            .iter()
            .find(|exception| exception.command == *command);
        match (not_run, needs) {
            (Some(exception), _) => Fate::NotRun(exception.why.clone()),
            (None, Some(needs)) if !root.join(&needs.file).exists() => {
                Fate::NotRun(format!("there is no {}", needs.file))
            }
            _ => Fate::Run,
        }
    };
    Ok(commands
        .iter()
        .map(|command| (command.clone(), fate(command)))
        .collect())
}

/// Runs the commands of README.md at `root`: those of `cargo test` last, so that their closing lines are. The first one that fails is an error, and so
/// is one that leaves files which git does not ignore.
pub fn run(root: &Path) -> Result<()> {
    let mut fates = fates(root)?;
    fates.sort_by_key(|(command, _)| command.starts_with("cargo test"));
    for (command, fate) in fates {
        match fate {
            Fate::NotRun(why) => {
                eprintln!("README.md, not run: {command}\n  {why}");
                check_options(root, &command)?;
            }
            Fate::Run => {
                eprintln!("README.md: {command}");
                let before = untracked(root);
                let begin = Instant::now();
                let status = shell(root, &command).status().context("starting bash")?;
                ensure!(status.success(), "README.md: `{command}` failed, {status}");
                let left = untracked(root);
                ensure!(
                    left == before,
                    "README.md: `{command}` left files that git does not ignore:\n{left}"
                );
                eprintln!(
                    "README.md: done in {:.0} s: {command}",
                    begin.elapsed().as_secs_f64()
                );
            }
        }
    }
    Ok(())
}

/// Options of a command that is not run stand in the `--help` of its subcommand.
fn check_options(root: &Path, command: &str) -> Result<()> {
    let Some((program, arguments)) = command.split_once(" -- ") else {
        return Ok(());
    };
    let subcommands: Vec<&str> = arguments
        .split_whitespace()
        .take_while(|word| word.chars().all(char::is_alphabetic))
        .collect();
    let asked = format!("{program} -- {} --help", subcommands.join(" "));
    let output = shell(root, &asked)
        .stdout(Stdio::piped())
        .output()
        .context("starting bash")?;
    ensure!(
        output.status.success(),
        "README.md: `{command}`: `{asked}` failed"
    );
    let help = String::from_utf8_lossy(&output.stdout).into_owned();
    let known: Vec<&str> = help.split(|c: char| !(c.is_alphanumeric() || c == '-')).collect();
    for option in arguments.split_whitespace().filter(|word| word.starts_with("--")) {
        if !known.contains(&option) {
            bail!("README.md: `{command}`: `{asked}` says nothing of `{option}`");
        }
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

    /// A checkout with this README.md, these exceptions, and nothing else.
    fn checkout(readme: &str, exceptions: &str) -> tempfile::TempDir {
        let folder = tempfile::tempdir().unwrap();
        fs::create_dir(folder.path().join("xtask")).unwrap();
        fs::write(folder.path().join("README.md"), readme).unwrap();
        fs::write(folder.path().join("xtask/readme.toml"), exceptions).unwrap();
        fs::write(folder.path().join(".gitignore"), "/runs\n").unwrap();
        for arguments in [&["init", "--quiet"][..], &["add", "."]] {
            let git = Command::new("git")
                .args(arguments)
                .current_dir(folder.path())
                .status();
            assert!(git.unwrap().success());
        }
        folder
    }

    fn error_of(readme: &str, exceptions: &str) -> String {
        let folder = checkout(readme, exceptions);
        run(folder.path()).map_or_else(|error| format!("{error:#}"), |()| String::new())
    }

    #[test]
    fn commands_are_lines_of_blocks_for_a_shell() {
        let readme = "cargo no\n```\ncargo run -- demo   # a comment\n\n# cargo comment\n```\n```rust\nlet no = 1;\n```\n\
            ```sh\ncargo \\\n  test\n```\ncargo no\n";
        assert_eq!(commands(readme), ["cargo run -- demo", "cargo test"]);
    }

    #[test]
    fn every_command_is_run_as_it_stands() {
        let readme = "```\nmkdir runs; echo one > runs/one   # a comment\ntest -f runs/one\n```\n";
        assert_eq!(error_of(readme, ""), "");
    }

    #[test]
    fn a_broken_command_is_an_error() {
        let error = error_of("```\ntrue\ntest -f runs/no-such-file\n```\n", "");
        assert!(error.contains("`test -f runs/no-such-file` failed"), "{error}");
    }

    #[test]
    fn a_file_that_git_does_not_ignore_is_an_error() {
        let error = error_of("```\ntouch left-over\n```\n", "");
        assert!(
            error.contains("left files") && error.contains("left-over"),
            "{error}"
        );
    }

    #[test]
    fn an_exception_holds_for_its_command_word_for_word() {
        let readme = "```\nfalse --one\ntrue\n```\n";
        let exception = "[[not_run]]\ncommand = \"false --one\"\nwhy = \"it fails\"\n";
        assert_eq!(error_of(readme, exception), "");
        let error = error_of(readme, &exception.replace("--one", "--two"));
        assert!(
            error.contains("`false --two`, which does not stand in README.md"),
            "{error}"
        );
    }

    #[test]
    fn options_of_a_command_that_is_not_run_are_looked_up() {
        let error_of = |option: &str| {
            let command = format!("bash -c 'echo its help names --known' -- go {option}");
            let exception = format!("[[not_run]]\ncommand = \"{command}\"\nwhy = \"it needs a sensor\"\n");
            error_of(&format!("```\n{command}\n```\n"), &exception)
        };
        assert_eq!(error_of("--known"), "");
        assert!(error_of("--unknown").contains("says nothing of `--unknown`"));
    }
}
