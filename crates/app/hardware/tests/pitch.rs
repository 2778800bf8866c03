//! A change of one number of a description, the pitch, changes board, printed parts and simulated
//! gel alike.

#![allow(clippy::print_stderr)] // says what is skipped
#![allow(clippy::unwrap_used)] // a test that cannot set itself up has failed

use std::path::Path;
use std::process::Command;
use std::sync::Arc;

use glam::DQuat;
use serde_json::Value;
use twintac_sensor::SensorFile;
use twintac_shape::Shape;
use twintac_simulate::{Gel, PressPlace, SimulateSettings};

const PITCH_MM: f64 = 9.0;

/// PhysTac with a pitch of 9 mm: its ports are 1.125 times as far from the middle, and the gel's
/// sides are as far beyond them as before.
fn wider() -> String {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../..");
    let mut text = std::fs::read_to_string(root.join("sensors/phystac.toml")).unwrap();
    for (from, to) in [
        ("name = \"phystac\"", "name = \"wider\""),
        ("[34.0, 18.0, 8.5]", "[37.0, 19.0, 8.5]"),
        ("[-12.0, ", "[-13.5, "),
        ("[12.0, ", "[13.5, "),
        (" -4.0, 0.0]", " -4.5, 0.0]"),
        (" 4.0, 0.0]", " 4.5, 0.0]"),
        ("[-4.0, ", "[-4.5, "),
        ("[4.0, ", "[4.5, "),
    ] {
        assert!(text.contains(from), "{from}");
        text = text.replace(from, to);
    }
    text
}

fn numbers(value: &Value) -> Vec<f64> {
    let values = value.as_array().unwrap().iter();
    values.map(|value| value.as_f64().unwrap()).collect()
}

#[test]
fn board_prints_and_mesh_follow_the_pitch() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("wider.toml");
    std::fs::write(&path, wider()).unwrap();
    let sensor = SensorFile::read(&path).unwrap().sensor;
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../..");
    let made = Command::new(env!("CARGO_BIN_EXE_twintac-hardware"))
        .args(["--sensor".as_ref(), path.as_os_str()])
        .args(["--chip", "MS5837-30BA"])
        .args(["--out".as_ref(), folder.path().join("made").as_os_str()])
        .args(["--root".as_ref(), root.as_os_str()])
        .output()
        .unwrap();
    let told = String::from_utf8_lossy(&made.stderr);
    assert!(made.status.success(), "{told}");
    for skipped in told.lines().filter(|line| line.contains("skipped")) {
        eprintln!("{skipped}");
    }
    let out = folder.path().join("made/wider");

    // The mechanics are made from this.
    let geometry: Value = serde_json::from_slice(&std::fs::read(out.join("geometry.json")).unwrap()).unwrap();
    assert_eq!(numbers(&geometry["gel"]["solid"]["size_mm"]), [37.0, 19.0, 8.5]);
    assert!((geometry["gel"]["volume_mm3"].as_f64().unwrap() - 37.0 * 19.0 * 8.5).abs() < 1e-6);
    let ports = geometry["taxels"].as_array().unwrap();
    for (port, taxel) in ports.iter().zip(&sensor.taxels) {
        let at = numbers(&port["position_mm"]);
        assert_eq!(at[..2], [taxel.position_mm.x, taxel.position_mm.y]);
    }
    assert_eq!(ports.len(), sensor.taxels.len());

    // Barometers on the board, by the placement file of the assembler.
    let placement = out.join("fabrication/placement.csv");
    if placement.exists() {
        let mut table = csv::Reader::from_path(placement).unwrap();
        let mut xs = Vec::new();
        for row in table.records() {
            let row = row.unwrap();
            if row[1].contains("MS5837") {
                xs.push(row[3].parse::<f64>().unwrap());
            }
        }
        xs.sort_by(f64::total_cmp);
        assert_eq!(xs.len(), 8);
        for pair in xs.chunks(2).collect::<Vec<_>>().windows(2) {
            assert!((pair[1][0] - pair[0][0] - PITCH_MM).abs() < 1e-3, "{xs:?}");
        }
    }
    if out.join("mechanics").exists() {
        let checks: Value =
            serde_json::from_slice(&std::fs::read(out.join("mechanics/check.json")).unwrap()).unwrap();
        let cavity = checks
            .as_array()
            .unwrap()
            .iter()
            .find(|check| check["check"] == "volume as the gel's" && check["of"] == "mould")
            .unwrap();
        assert!(
            cavity["holds"] == true && cavity["allowed"].as_str().unwrap().contains("5975"),
            "{cavity}"
        );
    }

    let gel = Gel::new(
        Arc::clone(&sensor),
        SimulateSettings {
            max_nodes: 1000,
            ..SimulateSettings::default()
        },
    );
    let mesh = gel
        .mesh(&PressPlace {
            indenter: "ball".to_owned(),
            shape: Shape::Sphere { radius_mm: 5.0 },
            x_mm: 0.0,
            y_mm: 0.0,
            rotation: DQuat::IDENTITY,
            depth_mm: 1.0,
            enough_force_n: None,
        })
        .unwrap();
    let highest = mesh
        .body()
        .mesh()
        .nodes_mm
        .iter()
        .copied()
        .reduce(|a, b| a.max(b))
        .unwrap();
    assert!(
        (highest.x - 18.5).abs() < 1e-9 && (highest.y - 9.5).abs() < 1e-9 && (highest.z - 8.5).abs() < 1e-9
    );
}
