//! Snapshots of the command line's output. After an intended change:
//! `INSTA_UPDATE=always cargo test --release --workspace`.

#![allow(clippy::unwrap_used)] // a test that cannot set itself up has failed

use std::path::Path;
use std::process::Command;

/// Standard output of a command run from the repository's root.
fn said(arguments: &[&str]) -> String {
    let output = Command::new(env!("CARGO_BIN_EXE_twintac"))
        .args(arguments)
        .current_dir(Path::new(env!("CARGO_MANIFEST_DIR")).join("../../.."))
        .env("COLUMNS", "140")
        .output()
        .unwrap();
    assert!(
        output.status.success(),
        "{}",
        String::from_utf8_lossy(&output.stderr)
    );
    String::from_utf8(output.stdout).unwrap()
}

#[test]
fn help() {
    insta::assert_snapshot!(said(&["--help"]));
}

#[test]
fn help_on_each_command() {
    for command in [
        "demo",
        "reproduce",
        "sensor",
        "mesh",
        "simulate",
        "dataset",
        "design",
        "view",
        "calibrate",
        "stream",
        "ports",
        "characterize",
        "export",
        "record",
        "import",
        "align",
        "train",
        "evaluate",
        "adapt",
        "cross-validate",
        "predict",
        "locate",
        "report",
    ] {
        insta::assert_snapshot!(format!("help_{command}"), said(&["help", command]));
    }
    insta::assert_snapshot!("help_fast_train", said(&["help", "fast", "train"]));
    insta::assert_snapshot!("help_fast_variation", said(&["help", "fast", "variation"]));
}

/// The pictures of PhysTac in the documentation. After an intended change:
/// `twintac sensor show sensors/phystac.toml --draw FILE`.
#[test]
fn pictures_of_phystac_are_those_of_its_description() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../..");
    let folder = tempfile::tempdir().unwrap();
    for picture in ["docs/phystac.png", "crates/app/twintac/phystac.svg"] {
        let drawn = folder.path().join(Path::new(picture).file_name().unwrap());
        said(&[
            "sensor",
            "show",
            "sensors/phystac.toml",
            "--draw",
            drawn.to_str().unwrap(),
        ]);
        let same = std::fs::read(drawn).unwrap() == std::fs::read(root.join(picture)).unwrap();
        assert!(same, "{picture} shows another description");
    }
}

#[test]
fn a_sensor_is_shown_with_units_and_what_is_inferred() {
    insta::assert_snapshot!(said(&["sensor", "show", "sensors/strip4-gel-d.toml"]));
}
