//! `simulate --path`: a case from two files, against converged results of two other finite-element
//! programs.

#![allow(clippy::unwrap_used)] // a test that cannot set itself up has failed

use std::fs;
use std::path::Path;
use std::process::{Command, Output};

const SENSOR: &str = r#"
name = "block"
summary = "a bonded block without a shell"
source = "a case of its own"
inferred = []

[gel.solid]
kind = "block"
size_mm = [34.0, 18.0, 8.5]

[gel.material]
youngs_modulus_kpa = 70.0
poissons_ratio = 0.49
source = "chosen"

[readout]
min_kpa = 0.0
max_kpa = 1500.0
resolution_kpa = 0.01
rate_hz = 55.0

[[taxels]]
name = "corner"
position_mm = [4.0, 4.0, 0.0]
port_radius_mm = 1.0
channel = 0

[[indenters]]
name = "ball"
shape = { kind = "sphere", radius_mm = 12.5 }
"#;

const PATH: &str = r#"
summary = "four depths"
indenter = "ball"
zero = "touch"
poses = [
  { time_s = 0.0, position_mm = [0.0, 0.0, -0.5] },
  { time_s = 1.0, position_mm = [0.0, 0.0, -1.0] },
  { time_s = 2.0, position_mm = [0.0, 0.0, -2.0] },
  { time_s = 3.0, position_mm = [0.0, 0.0, -4.0] },
]
points = [{ name = "opposite", position_mm = [-4.0, -4.0, 0.0], radius_mm = 1.0 }]
"#;

/// Depth, mm; force, N; pressure at the bottom at (±4, ±4) mm, mean over a disc of 1 mm, kPa.
/// 20-node hexahedra of one program and quadratic tetrahedra with a pressure field of another agree
/// to 0.5 % in force and 1 % in pressure.
const CONVERGED: [(f64, f64, f64); 4] = [
    (0.5, 0.2155, 0.642),
    (1.0, 0.7100, 2.109),
    (2.0, 2.4585, 7.00),
    (4.0, 8.881, 21.96),
];

fn simulate(folder: &Path, path: &str) -> Output {
    fs::write(folder.join("sensor.toml"), SENSOR).unwrap();
    fs::write(folder.join("path.toml"), path).unwrap();
    Command::new(env!("CARGO_BIN_EXE_twintac"))
        .args([
            "simulate",
            "--sensor",
            "sensor.toml",
            "--path",
            "path.toml",
            "--json",
        ])
        .current_dir(folder)
        .output()
        .unwrap()
}

#[test]
fn force_and_pressures_are_those_of_other_codes() {
    let folder = tempfile::tempdir().unwrap();
    let output = simulate(folder.path(), PATH);
    assert!(
        output.status.success(),
        "{}",
        String::from_utf8_lossy(&output.stderr)
    );
    let answer: serde_json::Value = serde_json::from_slice(&output.stdout).unwrap();
    assert_eq!(answer["provenance"], "simulated");
    let frames = answer["frames"].as_array().unwrap();
    assert_eq!(frames.len(), CONVERGED.len());
    for (frame, (depth_mm, force_n, pressure_kpa)) in frames.iter().zip(CONVERGED) {
        let force = -frame["force_n"][2].as_f64().unwrap() / force_n - 1.0;
        assert!(force.abs() < 0.05, "{depth_mm} mm: force {force}");
        for place in ["corner", "opposite"] {
            let pressure = frame["pressure_kpa"][place].as_f64().unwrap() / pressure_kpa - 1.0;
            assert!(
                pressure.abs() < 0.06,
                "{depth_mm} mm, {place}: pressure {pressure}"
            );
        }
    }
}

#[test]
fn columns_are_in_the_order_of_the_description_and_limits_are_said() {
    let folder = tempfile::tempdir().unwrap();
    let taxel =
        "[[taxels]]\nname = \"a\"\nposition_mm = [-4.0, 4.0, 0.0]\nport_radius_mm = 1.0\nchannel = 1\n\n";
    let limits = "[limits]\nforce_n = 200.0\ndepth_mm = 1.5\n\n[[indenters]]";
    let sensor = SENSOR.replace("[[indenters]]", &format!("{taxel}{limits}"));
    fs::write(folder.path().join("sensor.toml"), sensor).unwrap();
    fs::write(folder.path().join("path.toml"), PATH).unwrap();
    let output = Command::new(env!("CARGO_BIN_EXE_twintac"))
        .args(["simulate", "--sensor", "sensor.toml", "--path", "path.toml"])
        .current_dir(folder.path())
        .output()
        .unwrap();
    let [out, said] = [&output.stdout, &output.stderr].map(|bytes| String::from_utf8_lossy(bytes));
    assert!(output.status.success(), "{said}");
    let head = out.lines().next().unwrap();
    assert!(head.ends_with("corner_kpa,a_kpa,opposite_kpa"), "{head}");
    assert_eq!(out.lines().count(), 5);
    assert!(said.contains("path.toml: from 2 s on (2.00 mm, "), "{said}");
}

#[test]
fn a_point_outside_the_gel_is_one_clear_error() {
    let folder = tempfile::tempdir().unwrap();
    let output = simulate(
        folder.path(),
        &PATH.replace("[-4.0, -4.0, 0.0]", "[-40.0, -4.0, 0.0]"),
    );
    let text = String::from_utf8_lossy(&output.stderr);
    assert_eq!(output.status.code(), Some(2), "{text}");
    assert!(output.stdout.is_empty());
    assert!(
        text.contains("path.toml") && text.contains("`opposite`"),
        "{text}"
    );
}

#[test]
fn frames_with_a_deadline_say_whether_they_have_settled() {
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("sensor.toml"), SENSOR).unwrap();
    fs::write(folder.path().join("path.toml"), PATH).unwrap();
    let rows = |deadline: &[&str]| -> Vec<Vec<String>> {
        let output = Command::new(env!("CARGO_BIN_EXE_twintac"))
            .args(["simulate", "--sensor", "sensor.toml", "--path", "path.toml"])
            .args(deadline)
            .current_dir(folder.path())
            .output()
            .unwrap();
        assert!(output.status.success(), "{output:?}");
        let text = String::from_utf8(output.stdout).unwrap();
        let cells = |line: &str| line.split(',').map(str::to_owned).collect();
        text.lines().map(cells).collect()
    };
    let (usual, in_time, late) = (
        rows(&[]),
        rows(&["--deadline-ms", "60000"]),
        rows(&["--deadline-ms", "1"]),
    );
    for (row, (usual, in_time)) in usual.iter().zip(&in_time).enumerate() {
        let (same, more) = in_time.split_at(usual.len());
        assert_eq!(usual, same);
        assert_eq!(more[0], if row == 0 { "converged" } else { "true" });
    }
    let converged = late[0].iter().position(|name| name == "converged").unwrap();
    assert!(late[1..].iter().any(|row| row[converged] == "false"), "{late:?}");
    let residual = |row: &Vec<String>| row[converged + 1].parse::<f64>().unwrap();
    assert!(late[1..].iter().all(|row| residual(row) < 1.0), "{late:?}");
    let is_behind = |row: &Vec<String>| row[converged + 2].parse::<f64>().unwrap() > 0.0;
    assert!(
        late[1..]
            .iter()
            .all(|row| row[converged] == "false" || !is_behind(row))
    );
}
