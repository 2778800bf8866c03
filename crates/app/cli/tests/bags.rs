//! ROS 2 bags from the command line: imported, exported, refused; and logs of a stream.

#![allow(clippy::unwrap_used)] // a test that cannot set itself up has failed

use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Output, Stdio};
use std::time::Duration;

use glam::{DQuat, DVec3};
use twintac_log::{
    Body, Description, Ending, LogReader, LogWriter, Message, PoseReading, TactileFrame, TaxelReading,
    TaxelState, WrenchReading,
};
use twintac_recording::{Provenance, Recording};
use twintac_shape::Pose;

fn twintac(arguments: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_twintac"))
        .args(arguments)
        .output()
        .unwrap()
}

fn said(output: &Output) -> String {
    String::from_utf8_lossy(&output.stderr).into_owned()
}

/// Checks for exit code 2, empty standard output, and one error that contains all the words.
fn refused(output: &Output, words: &[&str]) {
    let text = said(output);
    assert_eq!(output.status.code(), Some(2), "{text}");
    assert!(output.stdout.is_empty());
    assert_eq!(text.matches("error: ").count(), 1, "{text}");
    for word in words {
        assert!(text.contains(word), "no `{word}` in: {text}");
    }
}

fn text(path: &Path) -> &str {
    path.to_str().unwrap()
}

/// The import description of the bag below.
const BENCH: &str = r#"
sensor = "phystac"
provenance = "emulated"
indenter = "sphere-25"
gel_top_mm = 8.5
z = { column = "/arm:position.z", unit = "m" }
contact = { z_mm = 10.0 }
force = { column = "/wrench:force.z", unit = "N", scale = -1.0 }
readings = { unit = "Pa" }
taxels = [TAXELS]
presses = { split = "return-to-rest", rest_mm = 14.0 }
zero = { above_contact_mm = 1.0, window_s = 0.5 }
"#;

fn description() -> String {
    let taxels: Vec<String> = (0..8)
        .map(|taxel| format!("{{ name = \"t{taxel}\", column = \"/touch:data.{taxel}\" }}"))
        .collect();
    BENCH.replace("TAXELS", &taxels.join(", "))
}

/// A log of two presses, 2 mm deep, with 3 N and 10 kPa on every taxel for each mm.
fn log(path: &Path) {
    let about = Description {
        sensor: "phystac".to_owned(),
        sensor_toml: String::new(),
        provenance: Provenance::Emulated,
        taxels: (0..8).map(|taxel| format!("t{taxel}")).collect(),
        transfer: None,
        base_from_gel: Pose::IDENTITY,
        tool_from_indenter: Pose::IDENTITY,
        force_axis: DVec3::NEG_Z,
        start_unix_ns: 1_700_000_000_000_000_000,
        versions: BTreeMap::new(),
    };
    let mut writer = LogWriter::new(Vec::new(), &about).unwrap();
    for step in 0..400_u64 {
        let s = (step % 200) as f64 * 0.02;
        let depth_mm = (4.0 * (s - 0.5)).min(4.0 * (3.5 - s)).clamp(0.0, 6.0) - 4.0;
        let pressed_mm = depth_mm.max(0.0);
        let taxel = TaxelReading {
            state: TaxelState::Good,
            read_us: 0,
            counts: None,
            pressure_pa: Some(101_000.0 + 10_000.0 * pressed_mm),
            temperature_c: None,
        };
        for body in [
            Body::Tactile(TactileFrame {
                triggered_us: step,
                taxels: vec![taxel; 8],
            }),
            Body::Wrench(WrenchReading {
                source_s: None,
                sequence: None,
                status: 0,
                lost_before: 0,
                force_n: DVec3::new(0.0, 0.0, -3.0 * pressed_mm),
                torque_n_mm: DVec3::ZERO,
            }),
            Body::Pose(PoseReading {
                source_s: None,
                position_mm: DVec3::new(0.0, 0.0, 10.0 - depth_mm),
                base_from_tool: DQuat::IDENTITY,
            }),
        ] {
            let bench_ns = step * 20_000_000;
            writer.write(&Message { bench_ns, body }).unwrap();
        }
    }
    fs::write(path, writer.finish().unwrap()).unwrap();
}

/// A folder with a log, the bag that `export --ros` makes of it, and its import description.
struct Bench {
    folder: tempfile::TempDir,
}

impl Bench {
    fn new() -> Self {
        let folder = tempfile::tempdir().unwrap();
        let bench = Self { folder };
        log(&bench.path("touch.mcap"));
        let (own, ros) = (bench.path("touch.mcap"), bench.path("ros"));
        let names = ["--topic", "tactile=/touch", "--topic", "pose=/arm", "--json"];
        let export = ["export", text(&own), "--ros", text(&ros)];
        let output = twintac(&[&export[..], &names].concat());
        assert!(output.status.success(), "{}", said(&output));
        let json = String::from_utf8(output.stdout).unwrap();
        assert!(
            json.contains("ros/touch.mcap\"") && json.contains("\"frames\":400,"),
            "{json}"
        );
        fs::write(bench.path("import.toml"), description()).unwrap();
        bench
    }

    fn path(&self, name: &str) -> PathBuf {
        self.folder.path().join(name)
    }

    fn import(&self, recordings: &Path, import: &str) -> Output {
        let sensor = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../../sensors/phystac.toml");
        let (import, run) = (self.path(import), self.path("run"));
        twintac(&[
            "import",
            "--sensor",
            text(&sensor),
            "--import",
            text(&import),
            "--recordings",
            text(recordings),
            "--out",
            text(&run),
        ])
    }

    /// Checks that the run has two presses with the depths, forces and readings of the log.
    fn has_presses(&self) {
        let recording = Recording::read_parquet(&self.path("run/recordings/presses.parquet")).unwrap();
        assert_eq!(recording.provenance, Provenance::Emulated);
        assert_eq!(recording.presses.len(), 2);
        for press in &recording.presses {
            let deepest = press
                .gel_from_indenter
                .iter()
                .map(|pose| 8.5 - pose.position_mm.z);
            let largest_n = press.force_n.iter().flatten().copied().fold(0.0, f64::max);
            let largest_kpa = press.taxels_kpa.iter().flatten().copied().fold(0.0, f64::max);
            let found = [deepest.fold(0.0, f64::max), largest_n, largest_kpa];
            for (found, expected) in found.into_iter().zip([2.0, 6.0, 20.0]) {
                assert!((found - expected).abs() < 1e-3, "{found} is not {expected}");
            }
        }
    }
}

#[test]
fn a_bag_is_imported_and_so_is_the_folder_of_one() {
    let bench = Bench::new();
    let output = bench.import(&bench.path("ros/touch.mcap"), "import.toml");
    assert!(output.status.success(), "{}", said(&output));
    bench.has_presses();
    fs::remove_dir_all(bench.path("run")).unwrap();
    fs::write(bench.path("ros/metadata.yaml"), "rosbag2_bagfile_information:\n").unwrap();
    let output = bench.import(&bench.path("ros"), "import.toml");
    assert!(output.status.success(), "{}", said(&output));
    bench.has_presses();
}

#[test]
fn a_bag_that_was_cut_is_read_up_to_there_and_that_is_said() {
    let bench = Bench::new();
    let bag = bench.path("ros/touch.mcap");
    let whole = fs::read(&bag).unwrap();
    fs::write(&bag, &whole[..whole.len() * 4 / 5]).unwrap();
    let output = bench.import(&bag, "import.toml");
    assert!(output.status.success(), "{}", said(&output));
    assert!(
        said(&output).contains("is truncated; it is read up to that point"),
        "{}",
        said(&output)
    );
}

#[test]
fn what_is_not_in_a_bag_is_refused_with_what_is() {
    let bench = Bench::new();
    let bag = bench.path("ros/touch.mcap");
    let import = |old: &str, new: &str| {
        fs::write(bench.path("other.toml"), description().replace(old, new)).unwrap();
        let output = bench.import(&bag, "other.toml");
        assert!(!bench.path("run/recordings").exists());
        output
    };
    refused(
        &import("/wrench:", "/ft:"),
        &[
            "touch.mcap: column `/ft:force.z` is of an unknown topic",
            "/touch (std_msgs/msg/Float32MultiArray, 400 messages)",
            "/wrench (geometry_msgs/msg/WrenchStamped, 400 messages)",
        ],
    );
    refused(
        &import("data.7", "data.8"),
        &["`/touch:data.8`", "data.0 to data.7"],
    );
    refused(
        &import("\"emulated\"", "\"real\""),
        &["touch.mcap", "emulated", "provenance = \"real\""],
    );
    let db3 = bench.path("touch.db3");
    fs::write(&db3, b"SQLite format 3\0rest").unwrap();
    refused(
        &bench.import(&db3, "import.toml"),
        &["touch.db3", "ros2 bag convert"],
    );
}

#[test]
fn a_description_is_guessed_of_a_bag() {
    let bench = Bench::new();
    let output = twintac(&["import", "--guess", text(&bench.path("ros/touch.mcap"))]);
    assert!(output.status.success(), "{}", said(&output));
    let guess = String::from_utf8(output.stdout).unwrap();
    let guess = guess
        .replace("\"my-sensor\"", "\"phystac\"")
        .replace("\"tip\"", "\"sphere-25\"")
        .replace("provenance = \"real\"", "provenance = \"emulated\"");
    fs::write(bench.path("guess.toml"), &guess).unwrap();
    let output = bench.import(&bench.path("ros/touch.mcap"), "guess.toml");
    assert!(output.status.success(), "{}\n{guess}", said(&output));
    let summary = fs::read_to_string(bench.path("run/recordings/summary.json")).unwrap();
    assert!(summary.contains("\"presses\": 2,"), "{summary}\n{guess}");
}

/// A bag has the file extension of a log, but is no log.
#[test]
fn a_bag_of_readings_alone_is_characterized() {
    let bench = Bench::new();
    let lines: Vec<String> = description().lines().map(str::to_owned).collect();
    let is_read = |line: &&String| {
        !["z =", "contact", "force", "zero", "presses"]
            .iter()
            .any(|start| line.starts_with(start))
    };
    let alone: Vec<&str> = lines.iter().filter(is_read).map(String::as_str).collect();
    let alone = alone.join("\n") + "\npresses = { split = \"none\" }\n";
    let (bag, import) = (bench.path("ros/touch.mcap"), bench.path("alone.toml"));
    fs::write(&import, alone).unwrap();
    let sensor = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../../sensors/phystac.toml");
    let characterize = [
        "characterize",
        "--json",
        "--sensor",
        text(&sensor),
        "--recordings",
        text(&bag),
    ];
    let output = twintac(&[&characterize[..], &["--import", text(&import)]].concat());
    assert!(output.status.success(), "{}", said(&output));
    let found = String::from_utf8(output.stdout).unwrap();
    assert!(found.contains("\"n_frames_alone\": 400,"), "{found}");
    refused(&twintac(&characterize), &["touch.mcap is not a readable log"]);
}

#[test]
fn topics_that_cannot_be_named_so() {
    let bench = Bench::new();
    let (own, out) = (bench.path("touch.mcap"), bench.path("other"));
    let export = |topic: &str| twintac(&["export", text(&own), "--ros", text(&out), "--topic", topic]);
    refused(
        &export("touch=/touch"),
        &["`touch` is unknown", "tactile, pressure"],
    );
    refused(&export("wrench=ft"), &["`ft` is not a name of a topic"]);
    assert!(!out.exists());
    let ros = bench.path("ros");
    let again = ["export", text(&own), "--ros", text(&ros)];
    refused(&twintac(&again), &["touch.mcap exists already"]);
}

#[test]
fn a_stream_is_recorded_beside_its_rows_or_alone() {
    let folder = tempfile::tempdir().unwrap();
    let log = folder.path().join("touch.mcap");
    let record = ["stream", "--lab", "--frames", "40", "--log", text(&log)];
    let output = twintac(&[&record[..], &["--format", "csv"]].concat());
    assert!(output.status.success(), "{}", said(&output));
    assert_eq!(String::from_utf8_lossy(&output.stdout).lines().count(), 41);
    assert!(
        said(&output).contains("touch.mcap has 40 frames"),
        "{}",
        said(&output)
    );
    assert_eq!(n_frames(&log), (40, Some(Ending::Whole)));
    assert!(log.with_extension("parquet").is_file());
    refused(&twintac(&record), &["touch.mcap exists already"]);

    let log = folder.path().join("alone.mcap");
    let output = twintac(&["stream", "--lab", "--frames", "40", "--log", text(&log)]);
    assert!(
        output.status.success() && output.stdout.is_empty(),
        "{}",
        said(&output)
    );
    assert_eq!(n_frames(&log), (40, Some(Ending::Whole)));

    let compensated = [
        "stream",
        "--lab",
        "--log",
        "other.mcap",
        "--temperature",
        "t.toml",
    ];
    refused(&twintac(&compensated), &["--temperature is for rows"]);
    refused(
        &twintac(&["stream", "--lab", "--log", "other.txt"]),
        &["--log", ".mcap"],
    );
}

/// The number of tactile frames of a log, and how it ends.
fn n_frames(path: &Path) -> (usize, Option<Ending>) {
    let mut reader = LogReader::open(path).unwrap();
    let bodies = reader.by_ref().map(|message| message.unwrap().body);
    let n_frames = bodies.filter(|body| matches!(body, Body::Tactile(_))).count();
    (n_frames, reader.ending())
}

#[test]
#[cfg(unix)]
fn a_stream_that_is_ended_finishes_its_log_and_one_that_is_killed_leaves_a_cut_one() {
    for (signal, name, ending) in [
        ("INT", "ended.mcap", Ending::Whole),
        ("TERM", "told.mcap", Ending::Whole),
        ("KILL", "killed.mcap.partial", Ending::Cut),
    ] {
        let folder = tempfile::tempdir().unwrap();
        let log = folder.path().join(name.trim_end_matches(".partial"));
        let mut stream = Command::new(env!("CARGO_BIN_EXE_twintac"))
            .args(["stream", "--lab", "--log", text(&log)])
            .stderr(Stdio::null())
            .spawn()
            .unwrap();
        let partial = folder
            .path()
            .join(format!("{}.partial", log.file_name().unwrap().to_str().unwrap()));
        // Frames have been written if the file is longer than its start.
        let is_flushed = || fs::metadata(&partial).is_ok_and(|file| file.len() > 60_000);
        for _ in 0..1200 {
            if is_flushed() {
                break;
            }
            std::thread::sleep(Duration::from_millis(50));
        }
        let number = stream.id().to_string();
        assert!(
            Command::new("kill")
                .args(["-s", signal, &number])
                .status()
                .unwrap()
                .success()
        );
        let status = stream.wait().unwrap();
        assert_eq!(status.success(), ending == Ending::Whole, "{signal}: {status}");
        let (n_frames, found) = n_frames(&folder.path().join(name));
        assert_eq!(found, Some(ending), "{signal}");
        assert!(n_frames > 10, "{signal}: {n_frames} frames");
    }
}
