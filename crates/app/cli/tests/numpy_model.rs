//! NumPy alone can evaluate a trained twin. `TWINTAC_PYTHON` names a Python interpreter with
//! `numpy` and `safetensors`.

#![allow(clippy::unwrap_used, clippy::print_stderr)] // a test that cannot set itself up has failed

use std::fs;
use std::path::Path;
use std::process::Command;

const SETTINGS: &str = r#"
[simulate]
edges_per_height = 3.0
edges_per_contact_radius = 2.0
depth_step_mm = 0.5
[bench]
n_places = 2
[train]
epochs = 60
variants = ["VARIANT"]
"#;

const PROTOCOL: &str = r#"
summary = "A few presses with one ball"
indenters = ["sphere-25"]
places = { kind = "random", x_mm = [-9.0, 9.0], y_mm = [-4.0, 4.0], count = 16 }
depth_mm = [0.5, 1.0]
speed_mm_per_s = 4.0
hold_s = 0.2
clearance_mm = 0.8
"#;

fn twintac(arguments: &[&str]) {
    let output = Command::new(env!("CARGO_BIN_EXE_twintac"))
        .args(arguments)
        .output()
        .unwrap();
    let errors = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success(), "{arguments:?}: {errors}");
}

#[test]
fn numpy_reads_what_the_papers_network_reads() {
    numpy_reads_what_the_twin_reads("paper");
}

#[test]
fn numpy_reads_what_a_twin_with_ports_reads() {
    numpy_reads_what_the_twin_reads("pressure+memory+mlp");
}

fn numpy_reads_what_the_twin_reads(variant: &str) {
    let asked = std::env::var("TWINTAC_PYTHON");
    let python = asked.clone().unwrap_or_else(|_| "python3".into());
    let has_packages = Command::new(&python)
        .args(["-c", "import numpy, safetensors.numpy"])
        .output()
        .is_ok_and(|output| output.status.success());
    if !has_packages {
        assert!(asked.is_err(), "{python} has no numpy or no safetensors");
        eprintln!("skipped: no Python with numpy and safetensors; TWINTAC_PYTHON can name one");
        return;
    }
    let folder = tempfile::tempdir().unwrap();
    let file = |name: &str, text: &str| {
        fs::write(folder.path().join(name), text).unwrap();
        folder.path().join(name).to_str().unwrap().to_owned()
    };
    let emulator = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../../emulators/harder.toml");
    let coarse = fs::read_to_string(emulator)
        .unwrap()
        .replace("edges_per_height = 7.0", "edges_per_height = 3.0")
        .replace("edges_per_contact_radius = 6.0", "edges_per_contact_radius = 2.0");
    let (emulator, protocol) = (file("emulator.toml", &coarse), file("protocol.toml", PROTOCOL));
    let settings = file("settings.toml", &SETTINGS.replace("VARIANT", variant));
    let run = folder.path().join("run");
    let run = run.to_str().unwrap();
    let record = ["record", "--at-once", "--lab", &emulator, "--protocol", &protocol];
    twintac(&[&record[..], &["--settings", &settings, "--out", run]].concat());
    for stage in ["align", "train", "evaluate"] {
        twintac(&[stage, "--run", run]);
    }
    let script = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/numpy_model.py");
    let output = Command::new(&python).arg(script).arg(run).output().unwrap();
    let (found, errors) = (
        String::from_utf8_lossy(&output.stdout),
        String::from_utf8_lossy(&output.stderr),
    );
    let worst: f64 = found.trim().parse().unwrap_or_else(|_| panic!("{found}{errors}"));
    assert!(worst < 1e-5, "{worst} of the largest reading");
}
