//! A log of readings alone: from the file to temperature coefficients, and to compensated frames.

#![allow(clippy::unwrap_used)] // a test that cannot set itself up has failed

use std::fmt::Write as _;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};

/// The import description of another laboratory's log of eight barometers, Pa, and one thermometer.
const IMPORT: &str = r#"
sensor = "phystac"
provenance = "real"
indenter = "none"
gel_top_mm = 8.5
time = { column = "ms", unit = "ms" }
readings = { unit = "Pa" }
temperatures = { column = "temp", unit = "C", scale = 0.01 }
taxels = [
    { name = "t0", column = "p0" }, { name = "t1", column = "p1" }, { name = "t2", column = "p2" }, { name = "t3", column = "p3" },
    { name = "t4", column = "p4" }, { name = "t5", column = "p5" }, { name = "t6", column = "p6" }, { name = "t7", column = "p7" },
]
presses = { split = "none" }
"#;

fn twintac(arguments: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_twintac"))
        .args(arguments)
        .output()
        .unwrap()
}

fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../../..")
}

/// Ten minutes at 5 Hz in which the chips warm up by 5 K. The zero of taxel `k` drifts by `k`
/// tenths of a kPa per K. In the middle a finger touches.
fn log() -> String {
    let mut log = "ms,p0,p1,p2,p3,p4,p5,p6,p7,temp\n".to_owned();
    for row in 0..3000_u32 {
        let warmer_k = 5.0 * f64::from(row) / 3000.0;
        let noise_pa = f64::from((row * 7) % 13) - 6.0;
        let touch_pa = if (1500..1520).contains(&row) { 9000.0 } else { 0.0 };
        let _ = write!(log, "{}", 200 * row);
        for taxel in 0..8 {
            let drift_pa = 100.0 * f64::from(taxel) * warmer_k;
            let _ = write!(log, ",{:.0}", 101_325.0 + drift_pa + noise_pa + touch_pa);
        }
        let _ = writeln!(log, ",{:.0}", 2200.0 + 100.0 * warmer_k);
    }
    log
}

/// Checks for exit code 2, and one error that contains all the words.
fn refused(output: &Output, words: &[&str]) {
    let text = String::from_utf8_lossy(&output.stderr);
    assert_eq!(output.status.code(), Some(2), "{text}");
    assert_eq!(text.matches("error: ").count(), 1, "{text}");
    for word in words {
        assert!(text.contains(word), "no `{word}` in: {text}");
    }
}

#[test]
fn from_a_log_of_readings_alone_to_frames_without_drift() {
    let folder = tempfile::tempdir().unwrap();
    let write = |name: &str, text: &str| {
        let path = folder.path().join(name);
        fs::write(&path, text).unwrap();
        path.to_str().unwrap().to_owned()
    };
    let (log, import) = (write("log.csv", &log()), write("import.toml", IMPORT));
    let sensor = root().join("sensors/phystac.toml");
    let sensor = sensor.to_str().unwrap();
    let out = folder.path().join("found");
    let characterize = ["characterize", "--sensor", sensor, "--recordings", &log];
    let output = twintac(
        &[
            &characterize[..],
            &["--import", &import, "--out", out.to_str().unwrap()],
        ]
        .concat(),
    );
    let said = String::from_utf8(output.stdout).unwrap();
    assert!(
        output.status.success(),
        "{}",
        String::from_utf8_lossy(&output.stderr)
    );
    for words in [
        "Zero over time",
        "Drift with temperature",
        "kPa/K",
        "not given: ",
        "temperature.toml",
    ] {
        assert!(said.contains(words), "no `{words}` in {said}");
    }
    let file = out.join("temperature.toml");
    let text = fs::read_to_string(&file).unwrap();
    let table: toml::Table = text.parse().unwrap();
    for (taxel, of_taxel) in table["taxels"].as_array().unwrap().iter().enumerate() {
        let found = of_taxel["kpa_per_k"].as_float().unwrap();
        assert!((found - 0.1 * taxel as f64).abs() < 0.002, "{text}");
    }
    let report = fs::read_to_string(out.join("report.html")).unwrap();
    assert!(report.contains("readings alone") && report.contains("as if something touched it"));

    // It is refused without an import description, and as presses.
    refused(&twintac(&characterize), &["log.csv", "--import"]);
    let run = folder.path().join("run");
    let imported = [
        "import",
        "--sensor",
        sensor,
        "--import",
        &import,
        "--recordings",
        &log,
    ];
    let output = twintac(&[&imported[..], &["--out", run.to_str().unwrap()]].concat());
    refused(&output, &["log.csv", "readings alone", "characterize"]);

    // Frames as they come.
    let stream = [
        "stream",
        "--lab",
        "--format",
        "csv",
        "--frames",
        "40",
        "--temperature",
    ];
    let streamed = |file: &str| twintac(&[&stream[..], &[file]].concat());
    let output = streamed(file.to_str().unwrap());
    assert!(
        output.status.success(),
        "{}",
        String::from_utf8_lossy(&output.stderr)
    );
    assert_eq!(String::from_utf8(output.stdout).unwrap().lines().count(), 41);
    let other = write("other.toml", &text.replace("\"phystac\"", "\"tip\""));
    refused(&streamed(&other), &["other.toml", "`tip`", "`phystac`"]);
    let short = write("short.toml", &text.replace("\"t5\"", "\"t9\""));
    refused(&streamed(&short), &["short.toml", "no taxel `t5`"]);
    let wrong = write("wrong.toml", &text.replace("kpa_per_k", "kpa_per_c"));
    refused(&streamed(&wrong), &["wrong.toml", "kpa_per_c"]);
    refused(&streamed("nowhere.toml"), &["nowhere.toml"]);
}
