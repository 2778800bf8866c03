//! Temperatures of chips, from logs to files and back; logs with readings only.

#![allow(clippy::unwrap_used)] // also in the helpers of tests

use std::path::Path;

use twintac_recording::{
    FrameTable, Frames, Import, Provenance, Recording, RecordingError, RecordingWriter, Stored, TaxelCell,
    guess_import,
};

/// Two taxels that are pressed 2 mm deep, and their column names.
const BENCH: &str = r#"
sensor = "pair"
provenance = "real"
indenter = "ball"
gel_top_mm = 6.0
time = { column = "t" }
z = { column = "z" }
contact = { z_mm = 0.0, z_points = "down" }
readings = { unit = "kPa" }
presses = { split = "return-to-rest", rest_mm = -1.0 }
"#;

const LOG: &str = "\
t,a,b,z,ta,tb
0,0,0,-1,25,26
1,0,0,0,25.5,26.5
2,2,4,1,,27
3,4,8,2,26.5,27.5
4,2,4,1,27,28
5,0,0,0,27.5,28.5
6,0,0,-1,28,29
";

const OWN: &str = "taxels = [{ name = \"S0\", column = \"a\", temperature = \"ta\" }, { name = \"S1\", column = \"b\", temperature = \"tb\" }]";
const NO_OWN: &str = "taxels = [{ name = \"S0\", column = \"a\" }, { name = \"S1\", column = \"b\" }]";

fn in_file<T>(text: &str, read: impl FnOnce(&Path) -> T) -> T {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("log.csv");
    std::fs::write(&path, text).unwrap();
    read(&path)
}

fn import(fields: &str, log: &str) -> Recording {
    let import = Import::parse("bench.toml", &format!("{BENCH}{fields}")).unwrap();
    in_file(log, |path| import.read_csv(path).unwrap().0)
}

/// Temperatures in the frames of the only press; -1 if missing.
fn temperatures_c(recording: &Recording) -> Vec<Vec<f64>> {
    let rows = recording.presses[0].temperature_c.as_ref().unwrap();
    let known = |row: &Vec<f64>| row.iter().map(|c| if c.is_nan() { -1.0 } else { *c }).collect();
    rows.iter().map(known).collect()
}

#[test]
fn each_taxel_has_a_thermometer_of_its_own() {
    let recording = import(OWN, LOG);
    assert_eq!(
        temperatures_c(&recording),
        [
            [25.0, 26.0],
            [25.5, 26.5],
            [-1.0, 27.0],
            [26.5, 27.5],
            [27.0, 28.0],
            [27.5, 28.5],
            [28.0, 29.0]
        ]
    );
    // A missing temperature affects nothing else.
    assert!(recording.presses[0].valid.iter().flatten().all(|valid| *valid));
}

#[test]
fn one_thermometer_stands_for_all_that_have_none_in_any_unit() {
    let shared = |unit: &str, scale: f64, log: &str| {
        let fields =
            format!("temperatures = {{ column = \"tb\", unit = \"{unit}\", scale = {scale:?} }}\n{NO_OWN}");
        temperatures_c(&import(&fields, log))[0].clone()
    };
    assert_eq!(shared("C", 1.0, LOG), [26.0, 26.0]);
    assert_eq!(
        shared("C", 0.01, &LOG.replace("-1,25,26", "-1,25,2650")),
        [26.5, 26.5]
    );
    assert_eq!(
        shared("F", 1.0, &LOG.replace("-1,25,26", "-1,25,77")),
        [25.0, 25.0]
    );
    let kelvin = shared("K", 1.0, &LOG.replace("-1,25,26", "-1,25,300.15"));
    assert!((kelvin[0] - 27.0).abs() < 1e-9, "{kelvin:?}");
    let one = "temperatures = { column = \"tb\" }\ntaxels = [{ name = \"S0\", column = \"a\", temperature = \"ta\" }, { name = \"S1\", column = \"b\" }]";
    assert_eq!(temperatures_c(&import(one, LOG))[0], [25.0, 26.0]);
    assert!(import(NO_OWN, LOG).presses[0].temperature_c.is_none());
}

#[test]
fn a_thermometer_that_makes_no_sense_is_refused() {
    let refused = |fields: &str| {
        let error = Import::parse("bench.toml", &format!("{BENCH}{fields}")).unwrap_err();
        error.to_string()
    };
    let text = refused(&OWN.replace("\"ta\"", "\"a\""));
    assert!(
        text.contains("taxels[0].temperature") && text.contains("also the column of its readings"),
        "{text}"
    );
    let text = refused(&format!("temperatures = {{ scale = 0.0 }}\n{NO_OWN}"));
    assert!(text.contains("temperatures.scale"), "{text}");
    let text = refused(&format!("temperatures = {{ unit = \"R\" }}\n{NO_OWN}"));
    assert!(text.contains("`C`, `K`"), "{text}");
    let import = Import::parse(
        "bench.toml",
        &format!("{BENCH}{}", OWN.replace("\"tb\"", "\"tc\"")),
    )
    .unwrap();
    let text = in_file(LOG, |path| import.read_csv(path).unwrap_err().to_string());
    assert!(text.contains("no column `tc`"), "{text}");
    let hot = Import::parse("bench.toml", &format!("{BENCH}{OWN}")).unwrap();
    let text = in_file(&LOG.replace(",28.5", ",2850"), |path| {
        hot.read_csv(path).unwrap_err().to_string()
    });
    assert!(text.contains("2850") && text.contains("frame 5"), "{text}");
}

#[test]
fn temperatures_are_columns_of_a_file_only_where_there_are_any() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("recording.parquet");
    let recording = import(OWN, LOG);
    recording.write_parquet(&path).unwrap();
    assert_eq!(Recording::read_parquet(&path).unwrap(), recording);
    let names = |recording: &Recording| -> Vec<String> {
        let names = recording.columns().into_iter().map(|(name, _)| name);
        names.filter(|name| name.ends_with("_temperature_c")).collect()
    };
    assert_eq!(names(&recording), ["S0_temperature_c", "S1_temperature_c"]);
    assert!(names(&import(NO_OWN, LOG)).is_empty());
    // A press without temperatures beside one with them.
    let mut both = recording.clone();
    both.append(import(NO_OWN, LOG)).unwrap();
    both.write_parquet(&path).unwrap();
    assert_eq!(Recording::read_parquet(&path).unwrap(), both);
    // The same for JSON.
    let text = serde_json::to_string(&both).unwrap();
    assert_eq!(serde_json::from_str::<Recording>(&text).unwrap(), both);
    assert_eq!(text.matches("temperature_c").count(), 1);
}

#[test]
fn a_file_that_was_begun_without_temperatures_takes_none() {
    let folder = tempfile::tempdir().unwrap();
    let recording = import(OWN, LOG);
    let path = folder.path().join("recording.parquet");
    let mut writer = RecordingWriter::create(&path, "pair", Provenance::Real, &recording.taxels).unwrap();
    let error = writer.push(recording.presses[0].clone()).unwrap_err().to_string();
    assert!(
        error.contains("log#1") && error.contains("begun without"),
        "{error}"
    );
}

/// A test setup without a robot: readings, Pa, and temperatures.
const READINGS: &str = r#"
sensor = "pair"
provenance = "real"
indenter = "none"
gel_top_mm = 6.0
time = { column = "t", unit = "ms" }
readings = { unit = "Pa", usable = [30000.0, 125000.0] }
taxels = [{ name = "S0", column = "a", temperature = "ta" }, { name = "S1", column = "b" }]
presses = { split = "none" }
"#;

const READ: &str = "t,a,b,ta\n0,101325,101400,25\n20,101326,nan,25.1\n40,200000,101401,\n";

fn frames() -> Frames {
    let import = Import::parse("bench.toml", READINGS).unwrap();
    assert!(!import.has_presses());
    let (frames, summary) = in_file(READ, |path| import.read_frames(path)).unwrap();
    assert_eq!((summary.missing_readings, summary.clipped_readings), (1, 1));
    frames
}

#[test]
fn a_log_of_readings_alone_is_read_as_it_is() {
    let frames = frames();
    assert_eq!(frames.time_s, [0.0, 0.02, 0.04]);
    assert_eq!(frames.readings_kpa[0], [101.325, 101.4]);
    assert!(frames.readings_kpa[1][1].is_nan() && frames.readings_kpa[2][0].is_nan());
    assert_eq!(
        (frames.temperature_c[0][0], frames.temperature_c[1][0]),
        (25.0, 25.1)
    );
    assert!(frames.temperature_c[2][0].is_nan() && frames.temperature_c[0][1].is_nan());
}

#[test]
fn logs_with_presses_and_without_are_not_taken_for_each_other() {
    let alone = Import::parse("bench.toml", READINGS).unwrap();
    let error = in_file(READ, |path| alone.read_csv(path).unwrap_err());
    assert!(matches!(error, RecordingError::NoPresses { .. }));
    assert!(error.to_string().contains("twintac characterize"), "{error}");
    let pressed = Import::parse("bench.toml", &format!("{BENCH}{OWN}")).unwrap();
    let error = in_file(LOG, |path| pressed.read_frames(path).unwrap_err().to_string());
    assert!(error.contains("split = \"none\""), "{error}");
    let zero = format!("{READINGS}zero = {{ above_contact_mm = 0.5, window_s = 1.0 }}\n");
    let error = Import::parse("bench.toml", &zero).unwrap_err().to_string();
    assert!(error.contains("zero") && error.contains("no presses"), "{error}");
}

#[test]
fn a_table_of_frames_reads_back_and_is_no_recording() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("frames.parquet");
    let frames = frames();
    let mut table = FrameTable::create(&path, "pair", Provenance::Real, &frames.taxels).unwrap();
    let known = |number: f64| Some(number).filter(|number| number.is_finite());
    for (frame, time_s) in frames.time_s.iter().enumerate() {
        let cells = (0..2).map(|taxel| TaxelCell {
            absolute_kpa: known(frames.readings_kpa[frame][taxel]),
            temperature_c: known(frames.temperature_c[frame][taxel]),
            ..TaxelCell::default()
        });
        table.push(*time_s, frame == 2, cells).unwrap();
    }
    table.finish().unwrap();
    let Stored::Frames(read) = Stored::read_parquet(&path).unwrap() else {
        panic!("no frames");
    };
    assert_eq!(
        (&read.sensor, read.provenance),
        (&frames.sensor, Provenance::Real)
    );
    assert_eq!((&read.taxels, &read.time_s), (&frames.taxels, &frames.time_s));
    assert_eq!(read.gap_before, [false, false, true]);
    let all = |frames: &Frames| format!("{:?} {:?}", frames.readings_kpa, frames.temperature_c);
    assert_eq!(all(&read), all(&frames));
    let error = Recording::read_parquet(&path).unwrap_err().to_string();
    assert!(error.contains("frames without poses"), "{error}");
    let recording = import(OWN, LOG);
    recording.write_parquet(&path).unwrap();
    assert!(matches!(Stored::read_parquet(&path).unwrap(), Stored::Presses(read) if read == recording));
}

#[test]
fn frames_that_contradict_themselves_are_refused() {
    let refused = |spoil: fn(&mut Frames), part: &str| {
        let mut frames = frames();
        spoil(&mut frames);
        let error = frames.check().unwrap_err().to_string();
        assert!(error.contains(part), "{error}");
    };
    refused(|frames| frames.time_s[2] = 0.01, "frame 2: time 0.01 s follows");
    refused(
        |frames| frames.readings_kpa[1].truncate(1),
        "frame 1: expected 2 taxels",
    );
    refused(|frames| frames.temperature_c[0][0] = f64::INFINITY, "frame 0");
    refused(|frames| frames.gap_before.truncate(1), "expected 3 frames");
}

#[test]
fn a_guess_finds_thermometers_and_logs_without_heights() {
    let row = |row: u32| {
        let t = f64::from(row);
        let [first, second] = [1013.2 + 0.01 * t, 1013.3 + 0.01 * f64::from(row % 2)];
        format!(
            "{:.0},{first:.2},{:.2},{second:.2},25.20\n",
            10.0 * t,
            25.0 + 0.1 * t
        )
    };
    let log: String = (0..60).map(row).collect();
    let log = format!("Time(ms),B1_P,B1_T,B2_P,B2_T\n{log}");
    let (guess, frames) = in_file(&log, |path| {
        let guess = guess_import(path).unwrap();
        let import = Import::parse("guessed.toml", &guess).unwrap_or_else(|error| panic!("{error}\n{guess}"));
        let frames = import
            .read_frames(path)
            .unwrap_or_else(|error| panic!("{error}\n{guess}"))
            .0;
        (guess, frames)
    });
    for part in [
        "split = \"none\"",
        "{ name = \"B1_P\", column = \"B1_P\", temperature = \"B1_T\" }",
        "unit = \"hPa\"",
    ] {
        assert!(guess.contains(part), "no `{part}` in\n{guess}");
    }
    assert!((frames.readings_kpa[0][0] - 101.32).abs() < 1e-9 && frames.temperature_c[10][0] == 26.0);
}
