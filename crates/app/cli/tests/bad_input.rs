//! Bad input gets one clear error, exit code 2, and leaves nothing half-written.

#![allow(clippy::unwrap_used)] // a test that cannot set itself up has failed

use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};

use glam::{DQuat, DVec3};
use twintac_log::{
    Body, Description, Event, LogWriter, Message, PoseReading, TactileFrame, TaxelReading, TaxelState,
};
use twintac_recording::{Control, Provenance};
use twintac_shape::Pose;

fn twintac(arguments: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_twintac"))
        .args(arguments)
        .output()
        .unwrap()
}

/// Checks for exit code 2, empty standard output, and one error that contains all the words.
fn refused(output: &Output, words: &[&str]) {
    let text = String::from_utf8_lossy(&output.stderr);
    assert_eq!(output.status.code(), Some(2), "{text}");
    assert!(output.stdout.is_empty());
    assert_eq!(text.matches("error: ").count(), 1, "{text}");
    for word in words {
        assert!(text.contains(word), "no `{word}` in: {text}");
    }
}

fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../../..")
}

fn text(path: &Path) -> &str {
    path.to_str().unwrap()
}

#[test]
fn a_truncated_mesh() {
    let folder = tempfile::tempdir().unwrap();
    let sensor = root().join("sensors/phystac.toml");
    let made = twintac(&[
        "mesh",
        "--sensor",
        text(&sensor),
        "--edge-mm",
        "4",
        "--out",
        text(folder.path()),
    ]);
    assert!(made.status.success(), "{}", String::from_utf8_lossy(&made.stderr));
    let whole = fs::read(folder.path().join("gel.msh")).unwrap();
    let cut = folder.path().join("cut.msh");
    fs::write(&cut, &whole[..whole.len() / 2]).unwrap();
    refused(&twintac(&["mesh", "--check", text(&cut)]), &["cut.msh", "line"]);
}

#[test]
fn a_taxel_outside_the_gel() {
    let folder = tempfile::tempdir().unwrap();
    let description = fs::read_to_string(root().join("sensors/phystac.toml")).unwrap();
    let path = folder.path().join("sensor.toml");
    fs::write(
        &path,
        description.replacen("position_mm = [-12.0,", "position_mm = [-42.0,", 1),
    )
    .unwrap();
    refused(
        &twintac(&["sensor", "show", text(&path)]),
        &["sensor.toml:", "taxels[0]"],
    );
}

/// Imports a recording of three presses of the strip, after a change, in a folder of its own.
fn recording(folder: &Path, change: impl Fn(usize, &mut Vec<String>)) -> Output {
    let mut csv = String::new();
    let mut time_s = 0.0;
    for row in 0..900 {
        let phase = f64::from(row % 300) * 0.061;
        let depth = (phase - 2.0).clamp(0.0, 4.0).min((16.0 - phase).clamp(0.0, 4.0));
        let mut cells = vec![format!("{}", 100_000.0 + 900.0 * depth.powi(2)); 4];
        cells.extend([
            format!("{}", (row / 300) * 1000),
            format!("{}", (480.0 * depth).round()),
            format!("{time_s}"),
        ]);
        change(row as usize, &mut cells);
        csv += &(cells.join(",") + "\n");
        time_s += 0.061;
    }
    let header = if csv
        .lines()
        .next()
        .is_some_and(|line| line.split(',').count() == 7)
    {
        "Sensor_0,Sensor_1,Sensor_2,Sensor_3,x,z,time\n"
    } else {
        "Sensor_0,Sensor_1,Sensor_2,x,z,time\n"
    };
    fs::write(folder.join("gelD_invented.csv"), header.to_owned() + &csv).unwrap();
    let (sensor, file) = (
        root().join("sensors/strip4-gel-d.toml"),
        folder.join("gelD_invented.csv"),
    );
    let out = folder.join("run");
    twintac(&[
        "import",
        "--sensor",
        text(&sensor),
        "--recordings",
        text(&file),
        "--out",
        text(&out),
    ])
}

#[test]
fn a_whole_recording_is_imported() {
    let folder = tempfile::tempdir().unwrap();
    let output = recording(folder.path(), |_, _| ());
    assert!(
        output.status.success(),
        "{}",
        String::from_utf8_lossy(&output.stderr)
    );
    assert!(folder.path().join("run/recordings/presses.parquet").exists());
}

#[test]
fn another_height_of_the_gel_than_the_sensors() {
    let folder = tempfile::tempdir().unwrap();
    assert!(recording(folder.path(), |_, _| ()).status.success());
    let import = fs::read_to_string(root().join("imports/strip4.toml")).unwrap();
    assert!(import.contains("gel_top_mm = 6.0"));
    let description = folder.path().join("import.toml");
    fs::write(
        &description,
        import.replace("gel_top_mm = 6.0", "gel_top_mm = 10.0"),
    )
    .unwrap();
    let (sensor, file, out) = (
        root().join("sensors/strip4-gel-d.toml"),
        folder.path().join("gelD_invented.csv"),
        folder.path().join("other"),
    );
    let output = twintac(&[
        "import",
        "--sensor",
        text(&sensor),
        "--import",
        text(&description),
        "--recordings",
        text(&file),
        "--out",
        text(&out),
    ]);
    refused(
        &output,
        &["gelD_invented.csv", "`gel_top_mm`", "is 10", "6 mm high"],
    );
}

#[test]
fn a_missing_column() {
    let folder = tempfile::tempdir().unwrap();
    let output = recording(folder.path(), |_, cells| {
        cells.remove(3);
    });
    refused(&output, &["gelD_invented.csv", "Sensor_3"]);
    assert!(!folder.path().join("run/recordings").exists());
}

#[test]
fn a_reading_that_is_no_number() {
    let folder = tempfile::tempdir().unwrap();
    let output = recording(folder.path(), |row, cells| {
        if row == 500 {
            cells[1] = "ERR".into();
        }
    });
    refused(&output, &["gelD_invented.csv", "502", "Sensor_1", "`missing`"]);
    assert!(!folder.path().join("run/recordings").exists());
}

#[test]
fn what_an_import_leaves_out_is_said() {
    let folder = tempfile::tempdir().unwrap();
    let output = recording(folder.path(), |row, cells| {
        if row == 500 {
            cells[1] = "NaN".into();
        }
    });
    let said = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success(), "{said}");
    assert!(said.contains("gelD_invented.csv: "), "{said}");
    assert!(said.contains("1 readings missing"), "{said}");
}

#[test]
fn a_description_is_guessed_and_can_be_read() {
    let folder = tempfile::tempdir().unwrap();
    let log = root().join("crates/app/twintac/examples/data/presses.csv");
    let output = twintac(&["import", "--guess", text(&log)]);
    assert!(
        output.status.success(),
        "{}",
        String::from_utf8_lossy(&output.stderr)
    );
    let guess = String::from_utf8(output.stdout).unwrap();
    let guess = guess
        .replace("\"my-sensor\"", "\"phystac\"")
        .replace("\"tip\"", "\"cylinder\"");
    let description = folder.path().join("import.toml");
    fs::write(&description, &guess).unwrap();
    let sensor = root().join("sensors/phystac.toml");
    let out = folder.path().join("run");
    let output = twintac(&[
        "import",
        "--sensor",
        text(&sensor),
        "--import",
        text(&description),
        "--recordings",
        text(&log),
        "--out",
        text(&out),
    ]);
    let said = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success(), "{said}\n{guess}");
    let summary = fs::read_to_string(out.join("recordings/summary.json")).unwrap();
    assert!(summary.contains("\"presses\": 15,"), "{summary}\n{guess}");
    let letter = folder.path().join("letter.txt");
    fs::write(&letter, "Dear Sir,\n").unwrap();
    refused(
        &twintac(&["import", "--guess", text(&letter)]),
        &["letter.txt", "no rows of numbers"],
    );
    let both = ["import", "--guess", text(&log), "--sensor", text(&sensor)];
    refused(&twintac(&both), &["--guess", "--sensor"]);
}

#[test]
fn times_that_run_backwards() {
    let folder = tempfile::tempdir().unwrap();
    let output = recording(folder.path(), |row, cells| {
        if row == 500 {
            cells[6] = "1.0".into();
        }
    });
    refused(&output, &["gelD_invented.csv", "502", "time"]);
    assert!(!folder.path().join("run/recordings").exists());
}

#[test]
fn a_model_with_a_flipped_byte() {
    let folder = tempfile::tempdir().unwrap();
    let names = ["checksums.json", "twin.json", "weights.safetensors"];
    let hash = "0".repeat(64);
    let sums = format!(
        r#"{{"format":"twintac-twin","version":1,"sha256":{{"twin.json":"{hash}","weights.safetensors":"{hash}"}}}}"#
    );
    for (name, bytes) in names.iter().zip([sums.as_bytes(), b"{}", b"x"]) {
        fs::write(folder.path().join(name), bytes).unwrap();
    }
    let recordings = folder.path().join("run/recordings/presses.parquet");
    assert!(recording(folder.path(), |_, _| ()).status.success());
    let output = twintac(&[
        "evaluate",
        "--model",
        text(folder.path()),
        "--recordings",
        text(&recordings),
        "--json",
    ]);
    refused(&output, &["twin.json", "SHA-256"]);
}

#[test]
fn a_sensor_that_is_not_there() {
    refused(&twintac(&["sensor", "show", "nowhere.toml"]), &["nowhere.toml"]);
}

#[test]
fn a_curve_that_makes_no_sense() {
    let folder = tempfile::tempdir().unwrap();
    let curve = folder.path().join("press.csv");
    let sensor = root().join("sensors/phystac.toml");
    let out = folder.path().join("out");
    let calibrate = |table: &str, free: &str| {
        fs::write(&curve, table).unwrap();
        let output = twintac(&[
            "calibrate",
            "--sensor",
            text(&sensor),
            "--csv",
            text(&curve),
            "--indenter",
            "sphere-25",
            "--free",
            free,
            "--out",
            text(&out),
        ]);
        assert!(!out.exists());
        output
    };
    let good = "time_s,depth_mm,force_n\n0,0,0\n1,0.5,0.1\n2,1.0,0.4\n";
    let shear = "shear_modulus_kpa";
    refused(
        &calibrate("time_s,force_n\n0,0\n", shear),
        &["press.csv", "`depth_mm`"],
    );
    refused(
        &calibrate("time_s,depth_mm,force_n\n0,0,0\n1,0.5,x\n", shear),
        &["press.csv:3", "`force_n`", "`x`", "finite number"],
    );
    refused(
        &calibrate("time_s,depth_mm,force_n\n0,0,0\n0,0.5,0.1\n", shear),
        &["press", "time of sample 2", "expected more"],
    );
    refused(
        &calibrate("time_s,depth_mm,force_n\n0,0,0\n1,-0.5,0.1\n", shear),
        &["press", "never touches"],
    );
    refused(
        &calibrate(good, "stiffness"),
        &["`stiffness`", "there are bulk_modulus_kpa"],
    );
    refused(
        &calibrate(good, "c20_kpa"),
        &["there is no parameter `c20_kpa`", "shear_modulus_kpa"],
    );
    refused(
        &calibrate(good, "prony[0].weight"),
        &["there is no parameter `prony[0].weight`"],
    );
    refused(
        &calibrate(good, "shear_modulus_kpa,poissons_ratio,depth_offset_mm"),
        &["3 usable samples", "3 unknowns"],
    );
}

#[test]
fn a_log_that_is_none() {
    let folder = tempfile::tempdir().unwrap();
    let log = folder.path().join("touch.mcap");
    fs::write(&log, "time,pressure").unwrap();
    refused(
        &twintac(&["export", text(&log)]),
        &["touch.mcap", "not a readable log"],
    );
    assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 1);
}

fn characterize(sensor: &str, recordings: &[&Path], out: &Path) -> Output {
    let sensor = root().join(sensor);
    let mut arguments = vec!["characterize", "--sensor", text(&sensor), "--recordings"];
    arguments.extend(recordings.iter().map(|file| text(file)));
    arguments.extend(["--json", "--out", text(out)]);
    let output = twintac(&arguments);
    assert!(output.status.success() || !out.exists());
    output
}

/// A frame of the log below, this many ms after its start.
fn frame(at_ms: u64) -> Message {
    let taxel = TaxelReading {
        state: TaxelState::Good,
        read_us: 0,
        counts: None,
        pressure_pa: Some(101_000.0),
        temperature_c: Some(25.0),
    };
    Message {
        bench_ns: at_ms * 1_000_000,
        body: Body::Tactile(TactileFrame {
            triggered_us: at_ms * 1000,
            taxels: vec![taxel; 8],
        }),
    }
}

/// A log of two seconds of PhysTac at rest, with these events, each this many ms after its start.
fn log(path: &Path, events: &[(u64, Event)]) {
    let description = Description {
        sensor: "phystac".to_owned(),
        sensor_toml: String::new(),
        provenance: Provenance::Emulated,
        taxels: (0..8).map(|taxel| format!("t{taxel}")).collect(),
        transfer: None,
        base_from_gel: Pose::IDENTITY,
        tool_from_indenter: Pose::IDENTITY,
        force_axis: DVec3::NEG_Z,
        start_unix_ns: 0,
        versions: BTreeMap::new(),
    };
    let mut writer = LogWriter::new(Vec::new(), &description).unwrap();
    for at_ms in (0..2000).step_by(20) {
        writer.write(&frame(at_ms)).unwrap();
        let pose = PoseReading {
            source_s: None,
            position_mm: DVec3::Z,
            base_from_tool: DQuat::IDENTITY,
        };
        let pose = Message {
            bench_ns: at_ms * 1_000_000,
            body: Body::Pose(pose),
        };
        writer.write(&pose).unwrap();
    }
    for (at_ms, event) in events {
        let event = Message {
            bench_ns: at_ms * 1_000_000,
            body: Body::Event(event.clone()),
        };
        writer.write(&event).unwrap();
    }
    fs::write(path, writer.finish().unwrap()).unwrap();
}

fn begun(name: &str) -> Event {
    Event::PressBegun {
        name: name.to_owned(),
        indenter: "sphere-25".to_owned(),
        control: Control::Pose,
    }
}

fn ended(name: &str) -> Event {
    Event::PressEnded {
        name: name.to_owned(),
    }
}

#[test]
fn nothing_to_characterize() {
    let folder = tempfile::tempdir().unwrap();
    let [csv, foreign, whole, touch] =
        ["press.csv", "foreign.parquet", "whole.mcap", "touch.mcap"].map(|name| folder.path().join(name));
    let out = folder.path().join("out");
    let phystac = "sensors/phystac.toml";
    fs::write(&csv, "time_s,depth_mm\n0,0\n").unwrap();
    refused(
        &characterize(phystac, &[&csv], &out),
        &[
            "press.csv",
            "neither a Parquet file nor an MCAP log",
            "`--import`",
            "`twintac import --guess`",
        ],
    );
    fs::write(&foreign, "PAR1, but nothing else").unwrap();
    refused(
        &characterize(phystac, &[&foreign], &out),
        &["foreign.parquet", "not a readable recording"],
    );
    log(&whole, &[(500, begun("p")), (1500, ended("p"))]);
    refused(
        &characterize("sensors/strip4-gel-d.toml", &[&whole], &out),
        &["sensor `phystac`", "`strip4-gel-d`"],
    );
    // Frames without presses can be characterized.
    log(&touch, &[]);
    let output = characterize(phystac, &[&touch], &out);
    let said = String::from_utf8_lossy(&output.stdout);
    assert!(
        output.status.success() && said.contains("\"n_frames_alone\": 100"),
        "{said}"
    );
    fs::remove_dir_all(&out).unwrap();
    let aside = folder.path().join("press-0001.try-1.mcap");
    fs::copy(&whole, &aside).unwrap();
    refused(&characterize(phystac, &[&aside], &out), &["set aside"]);
}

#[test]
fn recordings_that_do_not_belong_together() {
    let folder = tempfile::tempdir().unwrap();
    assert!(recording(folder.path(), |_, _| ()).status.success());
    let strip = folder.path().join("run/recordings/presses.parquet");
    let [cut, touch] = ["cut.parquet", "a-touch.mcap"].map(|name| folder.path().join(name));
    let out = folder.path().join("out");
    let bytes = fs::read(&strip).unwrap();
    fs::write(&cut, &bytes[..bytes.len() / 2]).unwrap();
    refused(
        &characterize("sensors/strip4-gel-d.toml", &[&cut], &out),
        &["cut.parquet", "not a readable recording"],
    );
    log(&touch, &[]);
    refused(
        &characterize("sensors/strip4-gel-d.toml", &[&strip, &touch], &out),
        &[
            "presses.parquet",
            "sensor `strip4-gel-d`, the previous ones have `phystac`",
        ],
    );
}

#[test]
fn a_press_in_which_the_bench_stopped_is_left_out_and_named() {
    let folder = tempfile::tempdir().unwrap();
    let [log_file, partial] = ["touch.mcap", "touch.mcap.partial"].map(|name| folder.path().join(name));
    let cause = "the operator stopped it".to_owned();
    let events = [
        (200, begun("one")),
        (900, ended("one")),
        (1000, begun("two")),
        (1800, Event::Stopped { cause }),
    ];
    log(&log_file, &events);
    let n_presses = |files: &[&Path]| {
        let output = characterize("sensors/phystac.toml", files, &folder.path().join("out"));
        let said = String::from_utf8(output.stderr).unwrap();
        assert!(output.status.success(), "{said}");
        let found: serde_json::Value = serde_json::from_slice(&output.stdout).unwrap();
        (found["n_presses"].as_u64().unwrap(), said)
    };
    let (presses, said) = n_presses(&[&log_file]);
    assert_eq!(presses, 1);
    assert!(
        said.contains("the test setup stopped at 1.800 s: the operator stopped it"),
        "{said}"
    );
    assert!(said.contains("press `two` was not finished"), "{said}");
    fs::copy(&log_file, &partial).unwrap();
    assert_eq!(n_presses(&[&partial]).0, 1);
    let (presses, said) = n_presses(&[&log_file, &partial]);
    assert_eq!(presses, 1);
    assert!(said.contains("touch.mcap.partial has a complete copy"), "{said}");
}

#[test]
fn a_prediction_without_a_twin() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("path.toml");
    fs::write(&path, "summary = \"no poses\"\n").unwrap();
    let plot = folder.path().join("plot.png");
    let predict = |more: &[&str]| {
        let output = twintac(&[&["predict", "--model", text(folder.path())], more].concat());
        assert!(!plot.exists());
        output
    };
    refused(
        &predict(&["--path", text(&path), "--plot", text(&plot)]),
        &["checksums.json", "not a usable model", "missing"],
    );
    refused(&predict(&[]), &["--path", "--protocol"]);
    refused(
        &predict(&["--path", text(&path), "--protocol", text(&path)]),
        &["--path", "--protocol", "cannot be used with"],
    );
    refused(
        &predict(&["--path", text(&path), "--plot", "plot.gif"]),
        &["--plot", ".png or .svg"],
    );
}

#[test]
fn places_that_cannot_be_found() {
    let folder = tempfile::tempdir().unwrap();
    let nothing = folder.path().join("none.parquet");
    let locate = |more: &[&str]| twintac(&[&["locate", "--model", text(folder.path())], more].concat());
    refused(&locate(&[]), &["--recordings"]);
    refused(&locate(&["--recordings", text(&nothing)]), &["none.parquet"]);
    refused(
        &locate(&["--recordings", text(&nothing), "--json", "--errors"]),
        &["--json", "--errors", "cannot be used with"],
    );
}

#[test]
fn a_stream_that_cannot_be() {
    let folder = tempfile::tempdir().unwrap();
    let stream = |more: &[&str]| twintac(&[&["stream", "--lab"], more].concat());
    // A sensor whose description does not say how it is wired.
    let unwired = folder.path().join("unwired.toml");
    let described = std::fs::read_to_string(root().join("sensors/strip4-gel-a.toml")).unwrap();
    let is_wiring = |line: &&str| line.starts_with("channel = ") || line.starts_with("chip = ");
    let lines: Vec<&str> = described.lines().filter(|line| !is_wiring(line)).collect();
    std::fs::write(&unwired, lines.join("\n")).unwrap();
    refused(
        &stream(&["--sensor", text(&unwired), "--format", "csv"]),
        &["strip4-gel-a", "does not say how its taxels are wired"],
    );
    // A line with a wrong description, with one of another sensor, or without a source.
    let line = folder.path().join("line.toml");
    for (described, words) in [
        (
            "form = \"text\"",
            ["line.toml", "`fields` are required for this form"],
        ),
        (
            "form = \"text\"\nfields = [\"pressure * 3\"]",
            ["8 taxels", "3 pressures"],
        ),
        (
            "form = \"text\"\nfields = [\"pressure * 8\"]",
            ["/dev/ttyNONE7", "cannot open"],
        ),
    ] {
        std::fs::write(&line, described).unwrap();
        refused(
            &twintac(&[
                "stream",
                "--serial",
                "/dev/ttyNONE7",
                "--line",
                text(&line),
                "--format",
                "csv",
            ]),
            &words,
        );
    }
    refused(&twintac(&["stream", "--serial", "/dev/ttyNONE7"]), &["--line"]);
    refused(&stream(&["--line", text(&line)]), &["--line", "--lab"]);
    refused(
        &twintac(&["stream", "--replay", text(&line), "--format", "csv"]),
        &["line.toml"],
    );
    for seconds in ["nan", "inf", "0", "-1"] {
        let seconds = format!("--seconds={seconds}");
        refused(
            &stream(&[&seconds, "--format", "csv"]),
            &["--seconds", "finite number above 0"],
        );
    }
    refused(&stream(&["--frames", "0", "--format", "csv"]), &["--frames"]);
    refused(
        &stream(&["--out", "here", "--format", "csv"]),
        &["--out", "--format"],
    );
}

#[test]
fn a_bench_without_devices() {
    let folder = tempfile::tempdir().unwrap();
    let [protocol, bench] = ["protocols/demo.toml", "rigs/lab.toml"].map(|file| root().join(file));
    let out = folder.path().join("run");
    let output = twintac(&[
        "record",
        "--protocol",
        text(&protocol),
        "--bench",
        text(&bench),
        "--out",
        text(&out),
    ]);
    refused(&output, &["[devices]", "--lab"]);
    assert!(!out.exists(), "nothing is begun");
}

#[test]
fn settings_that_cannot_be() {
    let folder = tempfile::tempdir().unwrap();
    let [settings, out] = ["settings.toml", "run"].map(|name| folder.path().join(name));
    let sensor = root().join("sensors/phystac.toml");
    for (told, words) in [
        ("[split]\nseed = 3\n", ["settings.toml:2: `split.seed`", "--seed"]),
        (
            "[bench]\nn_places = 0\n",
            ["settings.toml:2: `bench.n_places` is 0", "give 1 to"],
        ),
        (
            "[pair.warp]\nwindow_s = -3\n",
            ["`pair.warp.window_s` is -3", "give 0, or"],
        ),
        (
            "[train]\ncorrection_hidden = [1000000000]\n",
            ["`train.correction_hidden[0]` is 1e9", "give 1 to 1024"],
        ),
    ] {
        fs::write(&settings, told).unwrap();
        let run = [
            "import",
            "--sensor",
            text(&sensor),
            "--recordings",
            "none.csv",
            "--out",
            text(&out),
            "--settings",
            text(&settings),
        ];
        refused(&twintac(&run), &words);
        assert!(!out.exists());
    }
    fs::write(&settings, "[train]\nepochs = 3\n").unwrap();
    let dataset = ["dataset", "--out", text(&out), "--settings", text(&settings)];
    refused(&twintac(&dataset), &["settings.toml:1: `train`", "[simulate]"]);
    assert!(!out.exists());
}

#[test]
fn designs_that_cannot_be() {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("designs");
    let design = |words: &[&str]| {
        let mut command = vec!["design", "--nodes", "500", "--designs", "2", "--out", text(&out)];
        command.extend(words);
        let output = twintac(&command);
        assert!(!out.exists());
        output
    };
    let fields = ["`gel.hight_mm`", "gel.height_mm", "taxels.port_radius_mm"];
    refused(&design(&["--vary", "gel.hight_mm=4..10"]), &fields);
    refused(
        &design(&["--vary", "gel.height_mm=10..4"]),
        &["the smaller first"],
    );
    refused(&design(&["--vary", "gel.height_mm"]), &["FIELD=LOW..HIGH"]);
    refused(&design(&[]), &["--vary"]);
    let height = ["--vary", "gel.height_mm=4..10"];
    refused(&design(&[height, height].concat()), &["varied twice"]);
    refused(
        &design(&[&height[..], &["--goal", "price"]].concat()),
        &["price", "range_n"],
    );
    refused(
        &design(&[&height[..], &["--need", "range_n"]].concat()),
        &["FIGURE=VALUE"],
    );
    refused(&design(&[&height[..], &["--force-n=-1"]].concat()), &["force"]);
    refused(
        &design(&[&height[..], &["--noise-kpa", "nan"]].concat()),
        &["noise"],
    );
    refused(&design(&["--vary", "gel.height_mm=-9..-4"]), &["size_mm[2]"]);
    // The fingertip's gel is no block.
    let tip = root().join("sensors/phystac-tip.toml");
    refused(
        &design(&[&["--sensor", text(&tip)], &height[..]].concat()),
        &["block", "gel.solid"],
    );
}
