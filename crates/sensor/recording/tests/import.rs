//! CSV files of invented test setups, valid and invalid.

#![allow(clippy::unwrap_used)] // also in the helpers of tests

use std::path::PathBuf;

use proptest::prelude::*;
use tempfile::TempDir;
use twintac_recording::{Control, Import, ImportSummary, Recording, RecordingError};

const BENCH: &str = r#"
sensor = "pair"
provenance = "real"
indenter = "ball"
gel_top_mm = 6.0
time = { column = "ms", unit = "ms" }
x = { column = "x", unit = "um", offset = -1.0 }
z = { column = "steps", divide_by = 100.0 }
contact = { z_mm = 2.0, z_points = "down" }
readings = { unit = "Pa", usable = [0.0, 130000.0] }
taxels = [{ name = "S0", column = "a" }, { name = "S1", column = "b", lag_s = 0.05 }]
presses = { split = "return-to-rest" }
zero = { above_contact_mm = 0.5, window_s = 0.3 }
"#;

/// A test setup that goes down to 3 mm and up again at each location, in steps of 0.2 mm every 0.1
/// s. Taxel b reads the same as taxel a, 0.05 s later.
fn bench_csv(places_um: &[f64]) -> String {
    let mut text = "ms,a,b,x,steps\n".to_owned();
    let steps: Vec<f64> = (0..=15)
        .chain((0..15).rev())
        .map(|step| 20.0 * f64::from(step))
        .collect();
    let pressure = |steps: f64| 100_000.0 + 50.0 * (steps - 200.0).max(0.0);
    let mut row = 0;
    for place in places_um {
        let mut previous = 0.0;
        for &steps in &steps {
            let (a, b) = (pressure(steps), 0.5 * (pressure(previous) + pressure(steps)));
            text += &format!("{},{a},{},{place},{steps}\n", 100 * row, b + 250.0);
            previous = steps;
            row += 1;
        }
    }
    text
}

/// The same with a column `f`, the number of steps as mN.
fn with_force(csv: &str) -> String {
    let mut rows = csv.lines();
    let head = rows.next().unwrap();
    let rows = rows.map(|row| format!("{row},{}\n", row.rsplit_once(',').unwrap().1));
    format!("{head},f\n{}", rows.collect::<String>())
}

struct Bench {
    folder: TempDir,
}

impl Bench {
    fn with(files: &[(&str, &str)]) -> Self {
        let folder = tempfile::tempdir().unwrap();
        for (name, text) in files {
            std::fs::write(folder.path().join(name), text).unwrap();
        }
        Self { folder }
    }

    fn path(&self, name: &str) -> PathBuf {
        self.folder.path().join(name)
    }
}

fn read(description: &str, csv: &str) -> Result<(Recording, ImportSummary), RecordingError> {
    let bench = Bench::with(&[("run.csv", csv)]);
    Import::parse("bench.toml", description)?.read_csv(&bench.path("run.csv"))
}

/// The error without the folder of the file.
fn error(description: &str, csv: &str) -> String {
    let error = read(description, csv).unwrap_err().to_string();
    error
        .rsplit_once('/')
        .map_or(error.clone(), |(_, tail)| tail.to_owned())
}

#[test]
fn presses_come_with_poses_zeros_and_lags() {
    let (recording, summary) = read(BENCH, &bench_csv(&[0.0, 500.0])).unwrap();
    assert_eq!(recording.taxels, ["S0", "S1"]);
    let names: Vec<&str> = recording
        .presses
        .iter()
        .map(|press| press.name.as_str())
        .collect();
    assert_eq!(names, ["run#1", "run#2"]);
    let file = &summary.files[0];
    assert_eq!(
        (
            file.rows_read,
            file.rows_dropped,
            file.presses,
            file.presses_dropped
        ),
        (62, 1, 2, 0)
    );
    for (press, x_mm) in recording.presses.iter().zip([-1.0, -0.5]) {
        assert_eq!(
            (press.mounting.as_str(), press.indenter.as_str(), press.control),
            ("run.csv", "ball", Control::Pose)
        );
        assert_eq!(press.force_n, None);
        let deepest = press
            .gel_from_indenter
            .iter()
            .map(|pose| pose.position_mm.z)
            .fold(f64::INFINITY, f64::min);
        assert!((deepest - 5.0).abs() < 1e-12);
        for (frame, pose) in press.gel_from_indenter.iter().enumerate() {
            assert_eq!((pose.position_mm.x, pose.position_mm.y), (x_mm, 0.0));
            // 5 Pa per 0.001 mm of depth. The lagging taxel agrees once it is read at the right
            // time.
            let expected_kpa = 5.0 * (6.0 - pose.position_mm.z).max(0.0);
            for taxel in 0..2 {
                let found_kpa = press.taxels_kpa[frame][taxel];
                let is_kink = (expected_kpa - found_kpa).abs() > 1e-9;
                assert!(!is_kink || taxel == 1, "{found_kpa} kPa, expected {expected_kpa}");
                assert!(
                    (expected_kpa - found_kpa).abs() < 0.51,
                    "{found_kpa} kPa, expected {expected_kpa}"
                );
            }
        }
    }
}

#[test]
fn readings_beyond_the_range_are_not_valid() {
    let csv = bench_csv(&[0.0]).replace("104000,", "140000,");
    let (recording, summary) = read(BENCH, &csv).unwrap();
    let valid = recording.presses[0]
        .valid
        .iter()
        .flatten()
        .filter(|&&valid| !valid)
        .count();
    assert_eq!((valid, summary.files[0].clipped_readings), (2, 2));
}

#[test]
fn presses_that_the_file_cuts_are_dropped_and_named() {
    let csv = bench_csv(&[0.0, 500.0]);
    let rows = |from: usize, to: usize| {
        let lines: Vec<&str> = csv.lines().collect();
        [&lines[..1], &lines[1 + from..1 + to]].concat().join("\n")
    };
    // Row 46 is the deepest of the second press.
    let (recording, summary) = read(BENCH, &rows(0, 48)).unwrap();
    assert_eq!(
        (recording.presses.len(), summary.files[0].presses_dropped),
        (1, 1)
    );
    assert!(
        summary.files[0].warnings[0].contains("in the gel when the file ends"),
        "{:?}",
        summary.files[0].warnings
    );
    let (recording, summary) = read(BENCH, &rows(14, 62)).unwrap();
    assert_eq!(
        (recording.presses.len(), summary.files[0].presses_dropped),
        (1, 1)
    );
    assert!(
        summary.files[0].warnings[0].contains("in the gel when the file starts"),
        "{:?}",
        summary.files[0].warnings
    );
    // Out of the gel but not yet at rest: kept.
    let (recording, summary) = read(BENCH, &rows(0, 58)).unwrap();
    assert_eq!(
        (recording.presses.len(), summary.files[0].presses_dropped),
        (2, 0)
    );
    assert!(
        summary.files[0].warnings[0].contains("kept"),
        "{:?}",
        summary.files[0].warnings
    );
    let none = error(BENCH, &rows(14, 18));
    assert!(
        none.starts_with("run.csv: found no presses in 4 rows: a press lasts while z is more than"),
        "{none}"
    );
}

#[test]
fn every_wrong_cell_is_named() {
    let good = "ms,a,b,x,steps\n0,1,2,0,0\n100,1,2,0,220\n200,1,2,0,0\n300,1,2,0,0\n";
    assert!(read(BENCH, good).is_ok());
    let wrong = |old: &str, new: &str| error(BENCH, &good.replacen(old, new, 1));
    assert_eq!(
        wrong("steps", "z"),
        "run.csv:1: no column `steps`; the file has: ms, a, b, x, z"
    );
    assert_eq!(
        wrong("100,1", "100,much"),
        "run.csv:3: column `a` is `much`, expected a number; if that stands for a missing reading, name it in `missing`"
    );
    assert_eq!(
        wrong("100,1", "NaN,1"),
        "run.csv:3: column `ms` is missing, and only readings may be; `drop_incomplete_rows = true` leaves such rows out"
    );
    assert_eq!(
        wrong("200,1", "50,1"),
        "run.csv:4: column `ms` is 0.05 s after 0.1 s, expected times to increase; if the log was started again, split it into two files"
    );
    assert_eq!(
        wrong("200,1", "100,1"),
        "run.csv:4: column `ms` is 0.1 s after 0.1 s, expected times to increase; rows that were written in bursts are read with `repeated = \"spread\"`, or `repeated = { rate_hz = … }`"
    );
    assert_eq!(wrong(",2,0,220", ",2,0"), "run.csv:3: expected 5 cells, found 4");
    assert!(error(BENCH, "").ends_with("run.csv:1: no column `a`; the file has: nothing"));
    let none = error(BENCH, "ms,a,b,x,steps\n");
    assert!(none.starts_with("run.csv: found no presses in 0 rows"), "{none}");
    let missing = Import::parse("bench.toml", BENCH)
        .unwrap()
        .read_csv(&PathBuf::from("/nowhere/run.csv"));
    assert!(
        missing
            .unwrap_err()
            .to_string()
            .starts_with("cannot read /nowhere/run.csv")
    );
}

#[test]
fn any_field_can_differ_for_some_files() {
    let description = format!(
        "{BENCH}\n[[override]]\nfiles = \"old_*\"\nsensor = \"old-pair\"\ncontact = {{ z_mm = 1.0 }}\ndelimiter = \";\"
         columns = [\"ms\", \"a\", \"b\", \"x\", \"steps\"]\n[[override]]\nfiles = \"*_left.csv\"\nx = {{ offset = 7.0 }}\n"
    );
    let csv = bench_csv(&[0.0]);
    let headerless = csv.split_once('\n').unwrap().1.replace(',', ";");
    let bench = Bench::with(&[("old_left.csv", &headerless), ("new.csv", &csv)]);
    let import = Import::parse("bench.toml", &description).unwrap();
    let deepest = |name: &str| {
        let (recording, _) = import.read_csv(&bench.path(name)).unwrap();
        let poses = recording.presses[0]
            .gel_from_indenter
            .iter()
            .map(|pose| pose.position_mm);
        let deepest = poses.min_by(|a, b| a.z.total_cmp(&b.z)).unwrap();
        (
            recording.sensor.clone(),
            deepest.x,
            (deepest.z * 1e9).round() / 1e9,
        )
    };
    assert_eq!(deepest("old_left.csv"), ("old-pair".to_owned(), 7.0, 4.0));
    assert_eq!(deepest("new.csv"), ("pair".to_owned(), -1.0, 5.0));
    let mixed = import
        .read_all(&[bench.path("new.csv"), bench.path("old_left.csv")])
        .unwrap_err();
    let text = mixed.to_string();
    assert!(
        text.contains("old_left.csv: ") && text.contains("sensor `old-pair`, the previous ones have `pair`"),
        "{text}"
    );
}

#[test]
fn a_column_can_number_the_presses_and_hold_the_force() {
    let description = BENCH
        .replace("split = \"return-to-rest\"", "split = \"column\", column = \"x\"")
        .replace("zero =", "force = { column = \"f\", unit = \"mN\" }\n# zero =")
        .replace("column = \"a\"", "column = \"a\", offset_kpa = -100.0")
        .replace("column = \"b\"", "column = \"b\", offset_kpa = -100.0");
    let (recording, _) = read(&description, &with_force(&bench_csv(&[0.0, 500.0]))).unwrap();
    assert_eq!(
        recording
            .presses
            .iter()
            .map(|press| press.time_s.len())
            .collect::<Vec<_>>(),
        [31, 30]
    );
    let force_n = recording.presses[0].force_n.clone().unwrap();
    assert!((force_n[15] - 0.3).abs() < 1e-12);
    assert_eq!(recording.presses[0].control, Control::Pose);
    // Without a zero, readings are as in the file.
    assert!(recording.presses[0].taxels_kpa[0][0].abs() < 1e-9);
}

#[test]
fn what_looks_like_a_wrong_unit_height_or_sign_is_said() {
    let warnings = |old: &str, new: &str| {
        let with_force_column = BENCH.replace("zero =", "force = { column = \"f\", unit = \"mN\" }\nzero =");
        assert_eq!(with_force_column.matches(old).count(), 1, "{old}");
        let description = with_force_column.replace(old, new);
        // Three locations; the force begins 1 mm above the deepest point, at contact.
        let csv = with_force(&bench_csv(&[0.0, 500.0, 900.0]));
        let (head, rows) = csv.split_once('\n').unwrap();
        let rows = rows.lines().map(|row| {
            let (row, steps) = row.rsplit_once(',').unwrap();
            format!("{row},{}\n", (steps.parse::<f64>().unwrap() - 200.0).max(0.0))
        });
        let csv = format!("{head}\n{}", rows.collect::<String>());
        match read(&description, &csv) {
            Ok((_, summary)) => summary.files[0].warnings.join("\n"),
            Err(error) => error.to_string(),
        }
    };
    // Only that the file ends before the tip is back.
    assert_eq!(warnings("provenance", "provenance").lines().count(), 1);
    for (old, new, says) in [
        ("unit = \"ms\"", "unit = \"s\"", "the unit of `time`"),
        (
            "unit = \"Pa\"",
            "unit = \"kPa\"",
            "1000 times the pressure of the air",
        ),
        (
            "unit = \"Pa\"",
            "unit = \"hPa\"",
            "100 times the pressure of the air",
        ),
        ("unit = \"mN\"", "unit = \"mN\", scale = -1.0", "other sign"),
        ("z_mm = 2.0", "z_mm = 0.6", "below the surface of the gel"),
        (
            "divide_by = 100.0 }\ncontact = { z_mm = 2.0",
            "divide_by = 50.0 }\ncontact = { z_mm = 5.5",
            "above the gel",
        ),
    ] {
        let found = warnings(old, new);
        assert!(found.contains(says), "{new}: {found}");
    }
}

#[test]
fn the_same_recording_twice_is_refused() {
    let bench = Bench::with(&[
        ("one.csv", &bench_csv(&[0.0, 500.0])),
        ("two.csv", &bench_csv(&[500.0])),
        ("copy.csv", &bench_csv(&[0.0, 500.0])),
    ]);
    let import = Import::parse("bench.toml", BENCH).unwrap();
    let paths = |names: &[&str]| names.iter().map(|name| bench.path(name)).collect::<Vec<_>>();
    let error = import
        .read_all(&paths(&["one.csv", "two.csv", "copy.csv"]))
        .unwrap_err()
        .to_string();
    assert!(
        error.contains("one.csv: press `one#1` has the same times"),
        "{error}"
    );
    import.read_all(&paths(&["one.csv", "two.csv"])).unwrap();
}

#[test]
fn static_presses_lose_isolated_outliers_but_no_peaks() {
    let description = r#"
        sensor = "block"
        provenance = "real"
        indenter = "weight"
        gel_top_mm = 8.0
        x = { column = "x" }
        y = { column = "y" }
        weight_n = 0.98
        readings = { unit = "psi" }
        taxels = [{ name = "s0", column = "s0" }]
        presses = { split = "row" }
        outliers = { within_mm = 0.8, jump = 0.15 }
    "#;
    let mut csv = "x,y,s0\n".to_owned();
    for (x, y) in (0..400).map(|index| (0.5 * f64::from(index % 20), 0.5 * f64::from(index / 20))) {
        let bump = (-((x - 5.0).powi(2) + (y - 5.0).powi(2)) / 8.0).exp();
        let reading = if (x, y) == (0.5, 0.5) { 0.9 } else { bump };
        csv += &format!("{x},{y},{reading}\n");
    }
    let (recording, summary) = read(description, &csv).unwrap();
    let marked: Vec<&str> = recording
        .presses
        .iter()
        .filter(|press| !press.valid[0][0])
        .map(|press| press.name.as_str())
        .collect();
    assert_eq!((marked, summary.files[0].outliers), (vec!["run#22"], 1));
    let peak = &recording.presses[20 * 10 + 10];
    assert!((peak.taxels_kpa[0][0] - 6.894_757).abs() < 1e-6);
    assert_eq!((peak.control, &peak.force_n), (Control::Force, &Some(vec![0.98])));
}

#[test]
fn one_column_is_not_read_as_two_quantities() {
    for (old, new, field) in [
        ("x = { column = \"x\"", "x = { column = \"steps\"", "`z`"),
        ("column = \"ms\"", "column = \"x\"", "`x`"),
        ("column = \"b\"", "column = \"steps\"", "`taxels`"),
        ("zero =", "force = { column = \"a\" }\nzero =", "`taxels`"),
    ] {
        let error = Import::parse("bench.toml", &BENCH.replace(old, new))
            .unwrap_err()
            .to_string();
        assert!(
            error.contains(field) && error.contains("reads as well"),
            "{new}: {error}"
        );
    }
}

#[test]
fn descriptions_that_make_no_sense_are_refused_with_their_field() {
    let wrong = |old: &str, new: &str| {
        assert!(BENCH.contains(old));
        Import::parse("bench.toml", &BENCH.replacen(old, new, 1))
            .unwrap_err()
            .to_string()
    };
    for (old, new, field) in [
        ("sensor =", "sensr =", "sensr"),
        ("\"Pa\"", "\"torr\"", "torr"),
        ("name = \"S1\"", "name = \"S0\"", "taxels[1].name"),
        ("divide_by = 100.0", "divide_by = 0.0", "`z`"),
        ("lag_s = 0.05", "lag_s = nan", "taxels[1].lag_s"),
        ("time =", "# time =", "`time`"),
        ("[0.0, 130000.0]", "[1.0, 0.0]", "readings.usable"),
        ("window_s = 0.3", "window_s = 0.0", "zero.window_s"),
        ("provenance = \"real\"", "provenance = \"true\"", "true"),
        ("\"return-to-rest\"", "\"row\"", "presses.split"),
    ] {
        let error = wrong(old, new);
        assert!(
            error.starts_with("bench.toml:") && error.contains(field),
            "{error}"
        );
    }
    let nameless = format!("{BENCH}\n[[override]]\nsensor = \"x\"\n");
    let error = Import::parse("bench.toml", &nameless).unwrap_err().to_string();
    assert!(
        error.contains("override[0]") && error.contains("files"),
        "{error}"
    );
    let unknown = format!("{BENCH}\n[[override]]\nfiles = \"*\"\ncontact = {{ depth_mm = 1.0 }}\n");
    let error = Import::parse("bench.toml", &unknown).unwrap_err().to_string();
    assert!(
        error.contains("override[0]") && error.contains("depth_mm"),
        "{error}"
    );
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(256))]

    #[test]
    fn no_file_makes_the_import_panic(
        mut bytes in proptest::collection::vec(any::<u8>(), 0..200),
        cells in proptest::collection::vec("(-?[0-9]{1,4}|1e300|[,\n\"]|nan|é){0,12}", 0..12),
        kind in 0..3,
    ) {
        if kind > 0 {
            bytes = format!("ms,a,b,x,steps\n{}", cells.join(if kind == 1 { "," } else { "\n" })).into_bytes();
        }
        let bench = Bench::with(&[("run.csv", "")]);
        std::fs::write(bench.path("run.csv"), bytes).unwrap();
        let import = Import::parse("bench.toml", BENCH).unwrap();
        if let Ok((recording, _)) = import.read_csv(&bench.path("run.csv")) {
            recording.check().unwrap();
        }
    }

    #[test]
    fn no_numbers_make_the_import_panic(
        rows in proptest::collection::vec((prop_oneof![0.0..500.0, Just(1e-300), Just(1e300)], -1e5..2e5, -50..400), 0..40),
        split in 0..3_usize,
        buffered in any::<bool>(),
    ) {
        let mut time_ms = 0.0;
        let mut csv = "ms,a,b,x,steps\n".to_owned();
        for (step_ms, reading, steps) in rows {
            time_ms += step_ms;
            csv += &format!("{time_ms},{reading},{reading},0,{steps}\n");
        }
        let split = ["split = \"return-to-rest\"", "split = \"column\", column = \"steps\"", "split = \"row\""][split];
        let mut description = BENCH.replace("split = \"return-to-rest\"", split);
        if split.contains("row") {
            description = description.replace(", lag_s = 0.05", "").replace("zero =", "# zero =");
        }
        if let Ok((recording, _)) = read(&format!("drop_buffered = {buffered}\n{description}"), &csv) {
            recording.check().unwrap();
        }
    }

    #[test]
    fn no_description_makes_the_parser_panic(text in "\\PC{0,80}", place in 0..900_usize) {
        prop_assert!(Import::parse("bench.toml", &text).is_err());
        let at = place.min(BENCH.len());
        let _ = Import::parse("bench.toml", &format!("{}{text}{}", &BENCH[..at], &BENCH[at..]));
    }
}
