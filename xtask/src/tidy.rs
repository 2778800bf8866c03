//! House rules, run as tests.

#![allow(clippy::unwrap_used)] // a check that cannot read what it checks has failed

use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).parent().unwrap().to_owned()
}

/// Names of the workspace's own crates, with those each depends on directly (for building, not for tests).
fn own_dependencies() -> BTreeMap<String, BTreeSet<String>> {
    let output = Command::new(env!("CARGO"))
        .args(["metadata", "--format-version", "1", "--no-deps", "--offline"])
        .current_dir(root())
        .output()
        .unwrap();
    assert!(
        output.status.success(),
        "{}",
        String::from_utf8_lossy(&output.stderr)
    );
    let metadata: serde_json::Value = serde_json::from_slice(&output.stdout).unwrap();
    let packages = metadata["packages"].as_array().unwrap();
    let names: BTreeSet<&str> = packages
        .iter()
        .map(|package| package["name"].as_str().unwrap())
        .collect();
    let dependencies_of = |package: &serde_json::Value| {
        let dependencies = package["dependencies"].as_array().unwrap();
        dependencies
            .iter()
            .filter(|dependency| dependency["kind"].as_str() != Some("dev"))
            .map(|dependency| dependency["name"].as_str().unwrap())
            .filter(|name| names.contains(name))
            .map(str::to_owned)
            .collect()
    };
    packages
        .iter()
        .map(|package| {
            (
                package["name"].as_str().unwrap().to_owned(),
                dependencies_of(package),
            )
        })
        .collect()
}

/// All that a crate reaches through the workspace's own crates.
fn reached_from(start: &str) -> BTreeSet<String> {
    let direct = own_dependencies();
    assert!(direct.contains_key(start), "there is no crate `{start}`");
    let mut reached = BTreeSet::new();
    let mut pending = vec![start.to_owned()];
    while let Some(name) = pending.pop() {
        for next in &direct[&name] {
            if reached.insert(next.clone()) {
                pending.push(next.clone());
            }
        }
    }
    reached
}

#[test]
fn the_twin_cannot_peek_at_the_reality_it_is_judged_against() {
    assert!(!reached_from("digitac").contains("twintac-lab"));
}

#[test]
fn the_lab_does_not_know_the_twin() {
    assert!(!reached_from("twintac-lab").contains("digitac"));
}

#[test]
fn the_soft_body_is_a_solver_in_its_own_right() {
    assert!(!reached_from("twintac-softbody").contains("twintac-sensor"));
}

#[test]
fn the_drivers_stand_alone() {
    assert_eq!(reached_from("phystac"), BTreeSet::new());
}

#[test]
fn the_bench_waits_for_nobody() {
    for own in ["twintac-rig", "twintac-press"] {
        let reached = reached_from(own);
        for other in [
            "twintac-lab",
            "twintac-emulate",
            "digitac",
            "twintac-softbody",
            "twintac-simulate",
        ] {
            assert!(!reached.contains(other), "{own} reaches {other}");
        }
    }
}

#[test]
fn wires_know_no_gel() {
    let reached = reached_from("twintac-emulate");
    for other in ["twintac-lab", "digitac", "twintac-softbody", "twintac-simulate"] {
        assert!(!reached.contains(other), "twintac-emulate reaches {other}");
    }
}

#[test]
fn watching_touch_solves_nothing() {
    let reached = reached_from("twintac-live");
    for other in ["twintac-lab", "digitac", "twintac-softbody", "twintac-simulate"] {
        assert!(!reached.contains(other), "twintac-live reaches {other}");
    }
}

#[test]
fn files_named_in_the_documents_exist() {
    for document in ["README.md", "ARCHITECTURE.md"] {
        let text = fs::read_to_string(root().join(document)).unwrap();
        for (number, line) in text.lines().enumerate() {
            for quoted in line.split('`').skip(1).step_by(2) {
                let first = quoted.split('/').next().unwrap_or_default();
                let is_ours = [
                    "crates",
                    "sensors",
                    "protocols",
                    "imports",
                    "realities",
                    "rigs",
                    "materials",
                    "xtask",
                    "docs",
                    "fuzz",
                ]
                .contains(&first);
                if is_ours && quoted.contains('/') && !quoted.contains(['*', '{', ' ']) {
                    assert!(
                        root().join(quoted).exists(),
                        "{document}:{}: `{quoted}` does not exist",
                        number + 1
                    );
                }
            }
        }
    }
}

#[test]
fn links_in_the_documents_lead_somewhere() {
    let crates = fs::read_dir(root().join("crates")).unwrap();
    let readmes = crates.map(|folder| folder.unwrap().path().join("README.md"));
    let own = ["README.md", "ARCHITECTURE.md", "CHANGELOG.md"].map(|name| root().join(name));
    for document in own.into_iter().chain(readmes.filter(|readme| readme.exists())) {
        let text = fs::read_to_string(&document).unwrap();
        for (number, line) in text.lines().enumerate() {
            for link in line.split("](").skip(1).filter_map(|rest| rest.split(')').next()) {
                let file = link.split('#').next().unwrap_or_default();
                let is_there = link.contains("://") || document.with_file_name(file).exists();
                assert!(
                    file.is_empty() || is_there,
                    "{}:{}: `{link}` leads nowhere",
                    document.display(),
                    number + 1
                );
            }
        }
    }
}

#[test]
fn source_files_are_one_idea_each() {
    let mut pending = vec![root().join("crates"), root().join("xtask")];
    while let Some(folder) = pending.pop() {
        for entry in fs::read_dir(folder).unwrap() {
            let path = entry.unwrap().path();
            if path.is_dir() {
                pending.push(path);
            } else if path.extension().is_some_and(|extension| extension == "rs") {
                let size = fs::metadata(&path).unwrap().len();
                assert!(
                    size < 30_000,
                    "{} has {size} bytes: look for the missing room",
                    path.display()
                );
            }
        }
    }
}
