//! The format's official reader in Python, with its decoder of ROS 2 messages. `TWINTAC_PYTHON`
//! names a Python that has both packages.

#![allow(clippy::unwrap_used, clippy::print_stderr)] // also in the helpers of tests

mod common;

use std::process::Command;

use common::{NS_PER_S, bench, description, log};
use serde_json::{Value, json};
use twintac_log::{Message, recover};

/// What the reader finds in a file. `None` without such a Python.
fn found(path: &std::path::Path) -> Option<Value> {
    let python = std::env::var_os("TWINTAC_PYTHON").unwrap_or_else(|| "python3".into());
    let has_packages = Command::new(&python)
        .args(["-c", "import mcap, mcap_ros2"])
        .output()
        .is_ok_and(|output| output.status.success());
    if !has_packages {
        eprintln!(
            "skipped: no Python with the packages mcap and mcap-ros2-support; TWINTAC_PYTHON can name one"
        );
        return None;
    }
    let script = concat!(env!("CARGO_MANIFEST_DIR"), "/tests/official_reader.py");
    let output = Command::new(python).arg(script).arg(path).output().unwrap();
    assert!(
        output.status.success(),
        "{}",
        String::from_utf8_lossy(&output.stderr)
    );
    Some(serde_json::from_slice(&output.stdout).unwrap())
}

#[test]
fn the_official_reader_decodes_every_topic() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("bench.mcap");
    let messages = bench(2, 2, [50, 100, 20]);
    std::fs::write(&path, log(&description(2), &messages)).unwrap();
    let Some(found) = found(&path) else { return };
    assert_eq!(found["profile"], "ros2");
    assert_eq!(found["provenance"], "\"emulated\"");
    let counts = found["counts"].as_object().unwrap();
    assert_eq!(counts.len(), 10);
    let total: u64 = counts.values().map(|count| count.as_u64().unwrap()).sum();
    assert_eq!(found["messages"], total);
    assert_eq!(
        (
            &counts["/tactile/frame"],
            &counts["/wrench"],
            &counts["/robot/pose"],
            &counts["/events"]
        ),
        (&json!(100), &json!(200), &json!(40), &json!(4))
    );

    let last = |topic: &str| &found["last"][topic];
    let data = |topic: &str| &last(topic)["data"];
    let start_ns = description(2).start_unix_ns;
    // The last frame is triggered at 1.98 s and 3 ns of the bench clock.
    let pressure = last("/tactile/S1/pressure");
    let stamp_ns = start_ns + 1_980_000_003;
    assert_eq!(pressure["schema"], "sensor_msgs/msg/FluidPressure");
    assert_eq!(pressure["log_time"], stamp_ns);
    let stamp = json!({ "sec": stamp_ns / NS_PER_S, "nanosec": stamp_ns % NS_PER_S });
    assert_eq!(
        pressure["data"]["header"],
        json!({ "stamp": stamp, "frame_id": "S1" })
    );
    let counts = 3_242_400 + 980 + 10;
    assert_eq!(pressure["data"]["fluid_pressure"], f64::from(counts) / 32.0);
    let temperature = last("/tactile/S1/temperature");
    assert_eq!(temperature["schema"], "sensor_msgs/msg/Temperature");
    assert_eq!(temperature["data"]["temperature"], 25.5);

    let frame = data("/tactile/frame");
    assert_eq!(frame["triggered_us"], 1_980_077);
    assert_eq!(
        (&frame["counts"], &frame["read_us"]),
        (&json!([counts - 10, counts]), &json!([7, 7]))
    );
    assert_eq!(frame["state"], json!([0, 0]));
    assert_eq!(frame["temperature_c"], json!([25.5, 25.5]));

    let wrench = data("/wrench");
    assert_eq!(last("/wrench")["schema"], "geometry_msgs/msg/WrenchStamped");
    assert_eq!(
        wrench["wrench"]["torque"],
        json!({ "x": 0.001, "y": -0.002, "z": 0.003 })
    );
    let sample = data("/wrench/sample");
    assert_eq!(sample["torque_n_mm"], json!({ "x": 1.0, "y": -2.0, "z": 3.0 }));
    assert_eq!(
        (&sample["sequence"], &sample["lost_before"]),
        (&json!(1990), &json!(0))
    );
    assert_eq!(sample["force_n"], wrench["wrench"]["force"]);

    let pose = data("/robot/pose");
    assert_eq!(last("/robot/pose")["schema"], "geometry_msgs/msg/PoseStamped");
    assert_eq!(pose["pose"]["position"]["x"], 0.3);
    assert_eq!(pose["pose"]["orientation"]["x"], 1.0);
    assert_eq!(data("/robot/pose/sample")["position_mm"]["x"], 300.0);
    assert_eq!(
        data("/robot/pose/sample")["source_s"].as_f64(),
        None,
        "it has no clock"
    );

    let event: Value = serde_json::from_str(data("/events")["data"].as_str().unwrap()).unwrap();
    assert_eq!(event, json!({ "event": "press-ended", "name": "p1" }));
}

#[test]
fn the_official_reader_takes_a_recovered_log_for_a_whole_one() {
    let folder = tempfile::tempdir().unwrap();
    let cut = folder.path().join("bench.mcap.partial");
    let messages = bench(4, 2, [50, 100, 20]);
    let bytes = log(&description(2), &messages);
    std::fs::write(&cut, &bytes[..bytes.len() / 2]).unwrap();
    let whole = recover(&cut).unwrap();
    let Some(found) = found(&whole.path) else { return };
    let samples = [
        "/tactile/frame",
        "/wrench/sample",
        "/robot/pose/sample",
        "/events",
    ];
    let count: u64 = samples
        .iter()
        .map(|topic| found["counts"][topic].as_u64().unwrap())
        .sum();
    assert_eq!(count, whole.messages + 1, "and the gap where it was cut");
    let last_ns = |messages: &[Message]| messages.last().unwrap().bench_ns;
    assert!(last_ns(&messages[..count as usize]) < last_ns(&messages));
}
