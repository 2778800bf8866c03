//! The robot, tested with its manufacturer's own client.
//!
//! The test needs Python with `xarm-python-sdk`, in the interpreter that the variable
//! `TWINTAC_PYTHON` names, or `python3`. If the variable is not set and the package is missing, the
//! test reports this and passes without a check.

#![allow(clippy::unwrap_used, clippy::print_stderr)] // a test that does not run says so

use std::process::Command;

use serde_json::Value;
use twintac_emulate::robot::{RobotServer, RobotSettings};
use twintac_emulate::{Hertz, LabClock, Workcell};
use twintac_rig::xarm::ReportPort;

#[test]
fn the_manufacturers_client_drives_the_robot() {
    let asked = std::env::var("TWINTAC_PYTHON");
    let python = asked.clone().unwrap_or_else(|_| "python3".to_owned());
    let found = Command::new(&python).args(["-c", "import xarm.wrapper"]).output();
    if !found.as_ref().is_ok_and(|output| output.status.success()) {
        assert!(asked.is_err(), "{python} has no xarm-python-sdk: {found:?}");
        eprintln!("not run: {python} has no package xarm-python-sdk");
        return;
    }

    let mut settings = RobotSettings::default();
    settings.first_pose.roll_pitch_yaw_rad.x = 3.0; // half a turn has two representations
    let workcell = Workcell::new(
        LabClock::real(),
        Hertz::default(),
        settings.first_pose,
        settings.arm,
    );
    let robot = RobotServer::start(workcell, settings, &[]).unwrap();
    let ports = [
        robot.commands().port(),
        robot.reports(ReportPort::Normal).port(),
        robot.reports(ReportPort::Rich).port(),
        robot.reports(ReportPort::Development).port(),
    ];
    let script = concat!(env!("CARGO_MANIFEST_DIR"), "/tests/manufacturers_client.py");
    let output = Command::new(&python)
        .arg(script)
        .args(ports.map(|port| port.to_string()))
        .env("PYTHONDONTWRITEBYTECODE", "1")
        .output()
        .unwrap();
    let text = String::from_utf8_lossy(&output.stdout);
    let talk = format!("{text}{}", String::from_utf8_lossy(&output.stderr));
    assert!(output.status.success(), "{talk}");
    let seen: Value = serde_json::from_str(text.lines().last().unwrap()).unwrap();

    for (name, code) in seen["codes"].as_object().unwrap() {
        assert_eq!(code, 0, "{name}: {talk}");
    }
    assert_eq!(seen["version"], "6,6,XI1200,AC1200,v1.11.0");
    assert_eq!(seen["version_number"], serde_json::json!([1, 11, 0]));
    assert_eq!(seen["serial_number"], "XI1200");
    assert_eq!(seen["state_at_first"], 4, "stopped");
    let is = |name: &str, expected: [f64; 6]| {
        let pose = seen[name].as_array().unwrap_or_else(|| panic!("{name}: {talk}"));
        for (number, expected) in pose.iter().zip(expected) {
            assert!(
                (number.as_f64().unwrap() - expected).abs() < 0.05,
                "{name}: {pose:?}"
            );
        }
    };
    let at = |z_mm: f64| [200.0, 0.0, z_mm, 3.0, 0.0, 0.0];
    is("first", at(150.0));
    is("axis_angle", at(150.0));
    is("lowered", at(130.0));
    is("followed", at(120.0));
    is("reported", at(120.0));
    for name in ["is_ready", "is_error_reported", "is_ready_again"] {
        assert_eq!(seen[name], true, "{name}: {talk}");
    }
    assert_eq!(seen["mode"], 1);
    assert_eq!(seen["errors"], serde_json::json!([24, 0]));
    assert_ne!(seen["code_of_a_jump"], 0);
}
