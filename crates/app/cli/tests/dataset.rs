//! A shard that is killed while it is made leaves no half-written file, and the same command makes
//! it.

#![allow(clippy::unwrap_used)] // a test that cannot set itself up has failed

use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use std::thread::sleep;
use std::time::{Duration, Instant};

fn dataset(folder: &Path, words: &[&str]) -> Command {
    let mut command = Command::new(env!("CARGO_BIN_EXE_twintac"));
    command
        .arg("dataset")
        .args(words)
        .current_dir(folder)
        .stdout(Stdio::null())
        .stderr(Stdio::null());
    command
}

/// The files with final names.
fn files(folder: &Path) -> Vec<PathBuf> {
    let entries = fs::read_dir(folder).unwrap();
    let mut files: Vec<PathBuf> = entries.map(|entry| entry.unwrap().path()).collect();
    files.retain(|file| file.is_file());
    files.sort();
    files
}

#[test]
fn a_killed_shard_is_made_again() {
    let folder = tempfile::tempdir().unwrap();
    let make = ["--fast", "--presses", "400", "--indenter", "sphere-25", "--out"];
    let whole = [&make[..], &["whole"]].concat();
    assert!(dataset(folder.path(), &whole).status().unwrap().success());
    let first = [&make[..], &["parts", "--shard", "1/2"]].concat();
    let parts = folder.path().join("parts");
    let mut child = dataset(folder.path(), &first).spawn().unwrap();
    let begun = Instant::now();
    while !parts.join("dataset.toml").exists() {
        assert!(begun.elapsed() < Duration::from_secs(60), "it never began");
        sleep(Duration::from_millis(1));
    }
    child.kill().unwrap();
    child.wait().unwrap();
    let names = ["dataset.toml", "sensor.toml"].map(|name| parts.join(name));
    assert_eq!(files(&parts), names, "of a killed shard nothing is there");
    assert!(
        !dataset(folder.path(), &["--check", "parts"])
            .status()
            .unwrap()
            .success()
    );
    for shard in ["1/2", "2/2"] {
        let again = [&make[..], &["parts", "--shard", shard]].concat();
        assert!(dataset(folder.path(), &again).status().unwrap().success());
    }
    assert!(
        dataset(folder.path(), &["--merge", "parts"])
            .status()
            .unwrap()
            .success()
    );
    let merged = fs::read(parts.join("presses.parquet")).unwrap();
    let alone = fs::read(folder.path().join("whole/shard-000001-of-000001.parquet")).unwrap();
    assert_eq!(merged, alone);
    let hidden = fs::read_dir(&parts).unwrap();
    let hidden = hidden.filter(|entry| {
        entry
            .as_ref()
            .unwrap()
            .file_name()
            .to_string_lossy()
            .starts_with('.')
    });
    assert_eq!(hidden.count(), 0, "what the killed one left at work is gone");
}
