//! Readings, force and poses of one recording in three files, each with its own clock.

#![allow(clippy::unwrap_used)] // also in the helpers of tests

use std::fmt::Write;
use std::path::Path;

use tempfile::TempDir;
use twintac_recording::{Import, Recording};

/// Depth of the indenter at a true time, s: presses of different depths, mm.
fn depth_mm(time_s: f64) -> f64 {
    let press = (time_s / 5.0).floor();
    let within_s = time_s - 5.0 * press;
    let deepest_mm = 1.5 + 0.8 * (press * 2.3).sin();
    let begins_s = 1.0 + 0.4 * (press * 1.7).sin();
    let part = ((within_s - begins_s) / 2.4).clamp(0.0, 1.0);
    // From 1 mm above the gel, and back.
    (1.0 + deepest_mm) * (std::f64::consts::PI * part).sin() - 1.0
}

fn force_n(time_s: f64) -> f64 {
    3.0 * depth_mm(time_s).max(0.0).powf(1.5)
}

fn pressure_kpa(time_s: f64) -> f64 {
    8.0 * depth_mm(time_s).max(0.0).powf(1.2)
}

const LENGTH_S: f64 = 240.0;

/// Writes the three files: readings at 55 Hz on the true clock, force at 200 Hz and poses at 100 Hz
/// on their own clocks.
fn write_files(folder: &Path, force_clock: (f64, f64), pose_clock: (f64, f64)) {
    let table = |name: &str, header: &str, rate_hz: f64, row: &dyn Fn(f64) -> String| {
        let mut text = header.to_owned();
        let n = (LENGTH_S * rate_hz) as usize;
        for index in 0..n {
            writeln!(text, "{}", row(index as f64 / rate_hz)).unwrap();
        }
        std::fs::write(folder.join(name), text).unwrap();
    };
    let own = |(offset_s, rate): (f64, f64), time_s: f64| (time_s - offset_s) / rate;
    table("a.csv", "t,p\n", 55.0, &|time_s| {
        format!("{time_s:.6},{:.5}", pressure_kpa(time_s))
    });
    table("a-force.csv", "us;f\n", 200.0, &|time_s| {
        format!("{:.0};{:.5}", 1e6 * own(force_clock, time_s), force_n(time_s))
    });
    table("a-pose.csv", "ms,z,true\n", 100.0, &|time_s| {
        format!(
            "{:.3},{:.6},{time_s:.6}",
            1e3 * own(pose_clock, time_s),
            -depth_mm(time_s)
        )
    });
}

fn description(force_clock: &str, pose_clock: &str) -> String {
    format!(
        r#"
sensor = "s"
provenance = "emulated"
indenter = "tip"
gel_top_mm = 6.0
time = {{ column = "t", unit = "s" }}
x = {{ offset = 0.0 }}
y = {{ column = "true", unit = "mm" }}    # the true time of the pose, to judge by
z = {{ column = "z", unit = "mm" }}
force = {{ column = "f", unit = "N" }}
readings = {{ unit = "kPa" }}
taxels = [{{ name = "S0", column = "p" }}]
presses = {{ split = "return-to-rest", rest_mm = 1.0 }}

[[join]]
file = "{{stem}}-force.csv"
columns = ["f"]
delimiter = ";"
time = {{ column = "us", unit = "us" }}
clock = {force_clock}

[[join]]
file = "{{stem}}-pose.csv"
columns = ["z", "true"]
time = {{ column = "ms", unit = "ms" }}
clock = {pose_clock}
"#
    )
}

fn read(folder: &Path, description: &str) -> Result<(Recording, Vec<String>), String> {
    let import = Import::parse("three.toml", description).map_err(|error| error.to_string())?;
    let (recording, summary) = import
        .read_csv(&folder.join("a.csv"))
        .map_err(|error| error.to_string())?;
    Ok((recording, summary.files[0].warnings.clone()))
}

#[test]
fn three_clocks_are_found_and_joined_to_within_5_ms() {
    let folder = TempDir::new().unwrap();
    write_files(folder.path(), (1.12, 1.003), (-2.4, 0.997));
    let (recording, notes) = read(folder.path(), &description("\"found\"", "\"found\"")).unwrap();
    assert!(recording.presses.len() > 40, "{}", recording.presses.len());
    let mut worst_s: f64 = 0.0;
    for press in &recording.presses {
        for (frame, time_s) in press.time_s.iter().enumerate() {
            // Poses come every 10 ms; the nearest one is taken.
            let pose_s = press.gel_from_indenter[frame].position_mm.y;
            worst_s = worst_s.max((pose_s - time_s).abs() - 0.005);
            let force = press.force_n.as_ref().unwrap()[frame];
            let around = (-15..=15).map(|step| force_n(time_s + 0.0005 * f64::from(step)));
            let (low, high) = around.fold((f64::MAX, f64::MIN), |(low, high), force| {
                (low.min(force), high.max(force))
            });
            assert!(
                (low - 1e-4..=high + 1e-4).contains(&force),
                "{force} N at {time_s} s, {low} to {high}"
            );
        }
    }
    assert!(worst_s < 0.005, "{worst_s} s");
    let said = notes.join("\n");
    assert!(
        said.contains("a-force.csv: its times become those of the readings as 1.00"),
        "{said}"
    );
}

#[test]
fn a_clock_that_is_given_is_taken_and_the_same_one_is_the_default() {
    let folder = TempDir::new().unwrap();
    write_files(folder.path(), (1.12, 1.003), (0.0, 1.0));
    let given = description("{ offset_s = 1.12, rate = 1.003 }", "\"same\"");
    let (recording, notes) = read(folder.path(), &given).unwrap();
    assert!(recording.presses.len() > 40);
    assert_eq!(notes, Vec::<String>::new());
    let off = description("{ offset_s = 5000.0 }", "\"same\"");
    let error = read(folder.path(), &off).unwrap_err();
    assert!(
        error.contains("no row of it is within 0.02 s") && error.contains("clock = \"found\""),
        "{error}"
    );
}

#[test]
fn what_cannot_be_joined_is_an_error_with_the_remedy() {
    let folder = TempDir::new().unwrap();
    write_files(folder.path(), (0.0, 1.0), (0.0, 1.0));
    let same = description("\"same\"", "\"same\"");
    for (from, to, expected) in [
        (
            "columns = [\"f\"]",
            "columns = [\"g\"]",
            "`join[0].columns` has `g`, from which nothing is read",
        ),
        ("columns = [\"f\"]", "columns = []", "`join[0].columns` is empty"),
        (
            "{stem}-force.csv",
            "../force.csv",
            "`join[0].file` is `../force.csv`",
        ),
        ("{stem}-force.csv", "{stem}-torque.csv", "a-torque.csv"),
        ("column = \"us\"", "column = \"ns\"", "ns"),
        ("delimiter = \";\"", "within_s = -1.0", "`join[0].within_s` is -1"),
        (
            "split = \"return-to-rest\", rest_mm = 1.0",
            "split = \"row\"",
            "`join[0]` is given in a description whose own files have no time",
        ),
    ] {
        assert!(same.contains(from), "{from}");
        let error = read(folder.path(), &same.replacen(from, to, 1)).unwrap_err();
        assert!(error.contains(expected), "{to}: {error}");
    }
    // Nothing was pressed while the force was logged.
    std::fs::write(
        folder.path().join("a-force.csv"),
        "us;f\n0;0\n1000000;0\n2000000;0\n",
    )
    .unwrap();
    let error = read(folder.path(), &description("\"found\"", "\"same\"")).unwrap_err();
    assert!(
        error.contains("its clock is not found: nothing matches in the two"),
        "{error}"
    );
}
