//! A very small trained twin: predictions along paths and protocols, and the other commands that
//! use a model.

#![allow(clippy::unwrap_used)] // a test that cannot set itself up has failed

use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};

use serde_json::Value;
use twintac_recording::Recording;

/// A gel as coarse, presses as few and training as short as still works.
const SETTINGS: &str = r#"
[simulate]
edges_per_height = 4.0
edges_per_contact_radius = 3.0
max_path_nodes = 4000
depth_step_mm = 0.5
[bench]
n_places = 2
[train]
epochs = 2
variants = ["pressure+memory"]
"#;

const PROTOCOL: &str = r#"
summary = "A few presses with one ball"
indenters = ["sphere-25"]
places = { kind = "random", x_mm = [-9.0, 9.0], y_mm = [-4.0, 4.0], count = 10 }
depth_mm = [0.5, 1.0]
speed_mm_per_s = 4.0
hold_s = 0.2
clearance_mm = 0.3
"#;

const ONE_PRESS: &str = r#"
summary = "One press"
indenters = ["sphere-25"]
places = { kind = "grid", x_mm = [-4.0, -4.0], y_mm = [4.0, 4.0], count = [1, 1] }
depth_mm = 1.0
speed_mm_per_s = 1.0
hold_s = 0.1
clearance_mm = 1.0
"#;

/// The same press as a path.
const PATH: &str = r#"
summary = "One press"
indenter = "sphere-25"
zero = "touch"
rate_hz = 20.0
poses = [
  { time_s = 0.0, position_mm = [-4.0, 4.0, 1.0] },
  { time_s = 2.0, position_mm = [-4.0, 4.0, -1.0] },
  { time_s = 2.1, position_mm = [-4.0, 4.0, -1.0] },
]
"#;

/// Temperature coefficients of its zeros, the largest for taxel t3.
fn temperature() -> String {
    let taxel = |taxel: usize| {
        let kpa_per_k = if taxel == 3 { 0.75 } else { 0.0 };
        format!(
            "[[taxels]]\nname = \"t{taxel}\"\nkpa_per_k = {kpa_per_k:?}\nbetween_c = [20.0, 30.0]\nremaining_kpa = 0.01\n"
        )
    };
    let taxels: String = (0..8).map(taxel).collect();
    format!("sensor = \"phystac\"\nprovenance = \"emulated\"\n{taxels}")
}

const BALL: &str = "name = \"ball-8\"\nshape = { kind = \"sphere\", radius_mm = 4.0 }\n";

struct Files {
    folder: tempfile::TempDir,
}

impl Files {
    /// A twin, trained on presses of the emulated bench.
    fn with_twin() -> Self {
        let files = Self {
            folder: tempfile::tempdir().unwrap(),
        };
        let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../..");
        let emulator = fs::read_to_string(root.join("emulators/default.toml")).unwrap();
        let coarse = emulator
            .replace("edges_per_height = 7.0", "edges_per_height = 4.0")
            .replace("edges_per_contact_radius = 6.0", "edges_per_contact_radius = 2.0");
        assert_ne!(coarse, emulator);
        let [emulator, protocol, settings] = [
            ("emulator.toml", &*coarse),
            ("protocol.toml", PROTOCOL),
            ("settings.toml", SETTINGS),
        ]
        .map(|(name, text)| files.write(name, text));
        let run = files.folder.path().join("run");
        let run = run.to_str().unwrap();
        let record = ["record", "--at-once", "--lab", &emulator, "--protocol", &protocol];
        let temperature = files.write("temperature.toml", &temperature());
        let record = [&record[..], &["--temperature", &temperature]].concat();
        done(&[&record[..], &["--settings", &settings, "--out", run]].concat());
        done(&["align", "--run", run]);
        done(&["train", "--run", run]);
        files
    }

    fn write(&self, name: &str, text: &str) -> String {
        let path = self.folder.path().join(name);
        fs::write(&path, text).unwrap();
        path.to_str().unwrap().to_owned()
    }

    fn model(&self) -> PathBuf {
        self.folder.path().join("run/model")
    }

    fn predict(&self, arguments: &[&str]) -> Output {
        let model = self.model();
        twintac(&[&["predict", "--model", model.to_str().unwrap()], arguments].concat())
    }

    /// A model is not evaluated on presses that it was trained on.
    fn refuse_training_presses(&self) {
        let (model, run) = (self.model(), self.folder.path().join("run"));
        let presses = run.join("recordings/presses.parquet");
        let output = twintac(&[
            "evaluate",
            "--model",
            model.to_str().unwrap(),
            "--recordings",
            presses.to_str().unwrap(),
        ]);
        let said = String::from_utf8_lossy(&output.stderr);
        assert_eq!(output.status.code(), Some(2), "{said}");
        assert!(said.contains("trained on 10 of 10 presses"), "{said}");
    }

    /// Recordings of another sensor are refused even if its taxels have the same names, unless the
    /// option says that it is another name of the same sensor.
    fn refuse_another_sensor(&self) {
        let (model, presses) = (self.model(), self.folder.path().join("tip.parquet"));
        let own = self.folder.path().join("run/recordings/presses.parquet");
        let mut recording = twintac_recording::Recording::read_parquet(&own).unwrap();
        recording.sensor = "phystac-tip".to_owned();
        recording.write_parquet(&presses).unwrap();
        let [model, presses] = [&model, &presses].map(|path| path.to_str().unwrap());
        let said = |command: &str, more: &[&str]| {
            let arguments = [command, "--model", model, "--recordings", presses];
            let output = twintac(&[&arguments[..], more].concat());
            assert_eq!(output.status.code(), Some(2));
            String::from_utf8_lossy(&output.stderr).into_owned()
        };
        let out = self.folder.path().join("not-adapted");
        let out = ["--out", out.to_str().unwrap()];
        for (command, more) in [("evaluate", &[][..]), ("adapt", &out), ("fast variation", &[])] {
            let said = match command {
                "fast variation" => {
                    let arguments = ["fast", "variation", "--model", model, "--recordings", presses];
                    String::from_utf8_lossy(&twintac(&arguments).stderr).into_owned()
                }
                _ => said(command, more),
            };
            for part in ["`phystac-tip`, not of `phystac`", "--recorded-as phystac-tip"] {
                assert!(said.contains(part), "{command}: {said}");
            }
        }
        let renamed = said("evaluate", &["--recorded-as", "phystac-tip"]);
        assert!(renamed.contains("trained on 10 of 10 presses"), "{renamed}");
        let wrong = said("evaluate", &["--recorded-as", "mine"]);
        assert!(wrong.contains("--recorded-as is `mine`"), "{wrong}");
    }

    /// Its run is cross-validated for other seeds, each with its own test presses.
    fn evaluate_again(&self) {
        let run = self.folder.path().join("run");
        let output = twintac(&[
            "cross-validate",
            "--run",
            run.to_str().unwrap(),
            "--seeds",
            "2",
            "--json",
        ]);
        let said = String::from_utf8_lossy(&output.stderr);
        assert!(output.status.success(), "{said}");
        let found: Value = serde_json::from_slice(&output.stdout).unwrap();
        assert_eq!(found["provenance"], "emulated");
        let row = &found["rows"][0];
        assert_eq!(row["seeds"].as_array().unwrap().len(), 2);
        assert!(row["twin"]["mean_percent"].as_f64().unwrap() > 0.0);
        assert!(run.join("cross_validation/errors.png").exists());
    }

    /// It is adapted with two presses of another recording, and evaluated on the third. Presses
    /// that it was trained on are refused.
    fn adapt(&self) {
        let root = self.folder.path().to_str().unwrap();
        let [emulator, settings] = ["emulator.toml", "settings.toml"].map(|name| format!("{root}/{name}"));
        let protocol = self.write("three.toml", &PROTOCOL.replace("count = 10", "count = 3"));
        let (run, out) = (format!("{root}/other"), format!("{root}/adapted"));
        let record = ["record", "--at-once", "--lab", &emulator, "--protocol", &protocol];
        let of_seed = ["--seed", "2", "--settings", &settings, "--out", &run];
        done(&[&record[..], &of_seed].concat());
        let model = format!("{root}/run/model");
        let adapt = |presses: &str, out: &str| {
            let adapt = ["adapt", "--model", &model, "--recordings", presses, "--out", out];
            twintac(&[&adapt[..], &["--presses", "2", "--json"]].concat())
        };
        let output = adapt(&format!("{run}/recordings/presses.parquet"), &out);
        let said = String::from_utf8_lossy(&output.stderr);
        assert!(output.status.success(), "{said}");
        let found: Value = serde_json::from_slice(&output.stdout).unwrap();
        assert_eq!(found["provenance"], "emulated");
        assert_eq!(found["evaluated_presses"], 1);
        assert_eq!(found["adaptation"]["used"].as_array().unwrap().len(), 2);
        for gain in found["adaptation"]["gain"].as_array().unwrap() {
            assert!(gain["value"].as_f64().unwrap() > 0.0 && gain["uncertainty"].as_f64().unwrap() > 0.0);
        }
        assert!(found["twin"]["all_percent"].as_f64().unwrap() < 20.0, "{found}");
        let path = self.write("path.toml", PATH);
        done(&["predict", "--model", &format!("{out}/model"), "--path", &path]);

        let refused = format!("{root}/refused");
        let output = adapt(&format!("{root}/run/recordings/presses.parquet"), &refused);
        let said = String::from_utf8_lossy(&output.stderr);
        assert_eq!(output.status.code(), Some(2), "{said}");
        assert!(said.contains("trained on 10 of 10 presses"), "{said}");
        assert!(!Path::new(&refused).exists());
    }

    /// It estimates from readings where and how deep it was pressed, in rows beside the recorded
    /// values. Settings that are not allowed are refused before anything is solved.
    fn locate(&self) {
        let run = self.folder.path().join("run");
        // Names with characters that are special in patterns and tables.
        let mut recording = Recording::read_parquet(&run.join("recordings/presses.parquet")).unwrap();
        recording
            .presses
            .iter_mut()
            .for_each(|press| press.name.push_str(", \"left\""));
        let presses = self.folder.path().join("[1], presses.parquet");
        recording.write_parquet(&presses).unwrap();
        let model = run.join("training/held-out");
        let locate = |settings: &str, indenter: &str| {
            let settings = self.write("inverse.toml", settings);
            let locate = [
                "locate",
                "--model",
                model.to_str().unwrap(),
                "--recordings",
                presses.to_str().unwrap(),
            ];
            twintac(&[&locate[..], &["--indenter", indenter, "--settings", &settings]].concat())
        };
        for (settings, indenter, word) in [
            ("noise_kpa = 0.0", "sphere-25", "noise_kpa"),
            ("noise = 1.0", "sphere-25", "noise"),
            ("", "thumb", "thumb"),
        ] {
            let output = locate(settings, indenter);
            let said = String::from_utf8_lossy(&output.stderr);
            assert_eq!(output.status.code(), Some(2), "{said}");
            assert!(said.contains(word) && output.stdout.is_empty(), "{said}");
        }
        let output = locate("deepest_mm = 1.2", "sphere-25");
        let said = String::from_utf8_lossy(&output.stderr);
        assert!(output.status.success(), "{said}");
        assert!(said.contains("held-out presses: "), "{said}");
        let mut table = csv::Reader::from_reader(&output.stdout[..]);
        let header = table.headers().unwrap().clone();
        let first = [
            "provenance",
            "press",
            "trained_on",
            "time_s",
            "indenter",
            "x_mm",
            "y_mm",
            "depth_mm",
        ];
        assert!(header.iter().take(8).eq(first), "{header:?}");
        let column = |name: &str| header.iter().position(|column| column == name).unwrap();
        let number = |row: &csv::StringRecord, name: &str| row[column(name)].parse::<f64>();
        let (mut places_mm, mut depths_mm) = (Vec::new(), Vec::new());
        for row in table.records().map(Result::unwrap) {
            assert!(row[1].ends_with(", \"left\""), "{row:?}");
            if &row[2] == "true" || number(&row, "true_depth_mm").unwrap() <= 0.4 {
                continue;
            }
            let off = |found: &str, truth: &str| number(&row, found).unwrap() - number(&row, truth).unwrap();
            places_mm.push(off("x_mm", "true_x_mm").hypot(off("y_mm", "true_y_mm")));
            depths_mm.push(off("depth_mm", "true_depth_mm").abs());
        }
        let median = |errors: &mut Vec<f64>| {
            errors.sort_by(f64::total_cmp);
            errors[errors.len() / 2]
        };
        let (place_mm, depth_mm) = (median(&mut places_mm), median(&mut depths_mm));
        assert!(place_mm < 1.0 && depth_mm < 0.15, "{place_mm} mm, {depth_mm} mm");
    }

    /// The prediction that is printed as JSON.
    fn predicted(&self, arguments: &[&str]) -> Value {
        let output = self.predict(&[arguments, &["--json"]].concat());
        let said = String::from_utf8_lossy(&output.stderr);
        assert!(output.status.success(), "{said}");
        let found: Value = serde_json::from_slice(&output.stdout).unwrap();
        assert_eq!(found["provenance"], "simulated");
        assert_eq!(found["trained_on"], "emulated");
        found
    }
}

fn twintac(arguments: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_twintac"))
        .args(arguments)
        .output()
        .unwrap()
}

fn done(arguments: &[&str]) {
    let output = twintac(arguments);
    let said = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success(), "{said}");
}

fn numbers(row: &Value) -> Vec<f64> {
    row.as_array()
        .unwrap()
        .iter()
        .map(|value| value.as_f64().unwrap())
        .collect()
}

/// Force and readings of the deepest frame.
fn deepest(predicted: &Value) -> (f64, Vec<f64>) {
    let press = &predicted["presses"][0];
    let (depth_mm, force_n) = (numbers(&press["depth_mm"]), numbers(&press["force_n"]));
    let deepest = (0..depth_mm.len())
        .max_by(|a, b| depth_mm[*a].total_cmp(&depth_mm[*b]))
        .unwrap();
    (force_n[deepest], numbers(&press["readings_kpa"][deepest]))
}

// long: one model, which takes seconds to train, is used by all commands
#[test]
fn a_twin_reads_along_paths_protocols_and_with_shapes_of_ones_own() {
    let files = Files::with_twin();
    files.refuse_training_presses();
    files.refuse_another_sensor();
    files.evaluate_again();
    files.adapt();
    files.locate();
    let [path, protocol, ball] = [("path.toml", PATH), ("one.toml", ONE_PRESS), ("ball.toml", BALL)]
        .map(|(name, text)| files.write(name, text));

    // Protocol and path give the same press, apart from their meshes.
    let pressed = files.predicted(&["--protocol", &protocol]);
    assert_eq!(
        pressed,
        files.predicted(&["--threads", "1", "--protocol", &protocol])
    );
    let (force_n, readings_kpa) = deepest(&pressed);
    let (along_n, along_kpa) = deepest(&files.predicted(&["--path", &path]));
    assert!(
        force_n > 0.2 && (along_n / force_n - 1.0).abs() < 0.2,
        "{along_n} {force_n}"
    );
    let largest = readings_kpa.iter().copied().fold(0.0, f64::max);
    assert!(largest > 1.0, "{readings_kpa:?}");
    for (along, pressed) in along_kpa.iter().zip(&readings_kpa) {
        assert!(
            (along - pressed).abs() < 0.2 * largest,
            "{along_kpa:?} {readings_kpa:?}"
        );
    }

    // Rows for people, and a plot.
    let plot = files.folder.path().join("plot.svg");
    let output = files.predict(&["--path", &path, "--plot", plot.to_str().unwrap()]);
    let table = String::from_utf8(output.stdout).unwrap();
    let mut rows = table.lines();
    assert_eq!(
        rows.next().unwrap(),
        "provenance,press,indenter,time_s,x_mm,y_mm,depth_mm,force_n,\
         t0_kpa,t1_kpa,t2_kpa,t3_kpa,t4_kpa,t5_kpa,t6_kpa,t7_kpa"
    );
    assert!(
        rows.next()
            .unwrap()
            .starts_with("simulated,path,sphere-25,0.0000,-4.0000,4.0000,")
    );
    assert_eq!(rows.count(), 42);
    assert!(fs::read_to_string(&plot).unwrap().contains("reading (kPa)"));

    // A smaller ball, which was not in the training, takes less force.
    let smaller = files.write("smaller.toml", &PATH.replace("sphere-25", "ball-8"));
    let (smaller_n, _) = deepest(&files.predicted(&["--path", &smaller, "--indenter", &ball]));
    let both = files.write(
        "both.toml",
        &ONE_PRESS.replace("\"sphere-25\"", "\"ball-8\", \"sphere-25\""),
    );
    let by_both = files.predicted(&["--protocol", &both, "--indenter", &ball]);
    assert_eq!(by_both["presses"][0]["indenter"], "ball-8");
    assert_eq!(
        by_both["presses"][1]["readings_kpa"],
        pressed["presses"][0]["readings_kpa"]
    );
    let (ball_n, _) = deepest(&by_both);
    assert!(
        smaller_n < 0.9 * force_n && (ball_n / smaller_n - 1.0).abs() < 0.3,
        "{smaller_n} {ball_n}"
    );

    // Chips that are warmer than at their zero.
    let readings = |arguments: &[&str]| -> Vec<Vec<f64>> {
        let output = files.predict(&[&["--path", &path, "--json"], arguments].concat());
        let said = String::from_utf8_lossy(&output.stderr);
        assert!(output.status.success(), "{said}");
        let predicted: Value = serde_json::from_slice(&output.stdout).unwrap();
        serde_json::from_value(predicted["presses"][0]["readings_kpa"].clone()).unwrap()
    };
    let (as_zeroed, warmer) = (readings(&[]), readings(&["--warmer-k", "-2"]));
    assert_eq!(as_zeroed.len(), warmer.len());
    for (row, warmer) in as_zeroed.iter().zip(&warmer) {
        for (taxel, (reading_kpa, warmer_kpa)) in row.iter().zip(warmer).enumerate() {
            let expected_kpa = if taxel == 3 { -1.5 } else { 0.0 };
            assert!((warmer_kpa - reading_kpa - expected_kpa).abs() < 1e-9, "t{taxel}");
        }
    }

    // A wrong input gives an error, and no other output.
    let refused = |arguments: &[&str], words: &[&str]| {
        let output = files.predict(arguments);
        let text = String::from_utf8_lossy(&output.stderr);
        assert_eq!(output.status.code(), Some(2), "{text}");
        assert!(output.stdout.is_empty());
        assert_eq!(text.matches("error: ").count(), 1, "{text}");
        for word in words {
            assert!(text.contains(word), "no `{word}` in: {text}");
        }
    };
    refused(
        &["--path", &smaller],
        &["no indenter `ball-8`", "the sensor has sphere-25"],
    );
    refused(&["--protocol", &both], &["ball-8"]);
    refused(&["--path", "nowhere.toml"], &["nowhere.toml"]);
    let beside = files.write("beside.toml", &PATH.replace("-4.0, 4.0, ", "-90.0, 4.0, "));
    refused(
        &["--path", &beside],
        &["beside.toml", "x = -90.00 mm", "does not touch the gel"],
    );
    let broken = files.write("broken.toml", &BALL.replace("4.0", "-4.0"));
    refused(
        &["--path", &path, "--indenter", &broken],
        &["broken.toml:2", "`shape.radius_mm`"],
    );
    let weights = files.model().join("weights.safetensors");
    let mut bytes = fs::read(&weights).unwrap();
    *bytes.last_mut().unwrap() ^= 1;
    fs::write(&weights, bytes).unwrap();
    refused(&["--path", &path], &["weights.safetensors", "SHA-256"]);
}
