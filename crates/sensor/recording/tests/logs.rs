//! Logs as they occur in practice. Each has a feature that stops a strict reader; it is read, or
//! refused with a hint.

#![allow(clippy::unwrap_used)] // also in the helpers of tests

use twintac_recording::{FileSummary, Import, Recording, RecordingError, guess_import};

/// Two taxels whose readings rise from 0 to 4 kPa and fall again while the tip goes 2 mm into the
/// gel and back.
const BENCH: &str = r#"
sensor = "pair"
provenance = "real"
indenter = "ball"
gel_top_mm = 6.0
time = { column = "t" }
z = { column = "z" }
contact = { z_mm = 0.0, z_points = "down" }
readings = { unit = "kPa" }
taxels = [{ name = "S0", column = "a" }, { name = "S1", column = "b" }]
presses = { split = "return-to-rest", rest_mm = -1.0 }
"#;

const LOG: &str = "t,a,b,z\n0,0,0,-1\n1,0,0,0\n2,2,4,1\n3,4,8,2\n4,2,4,1\n5,0,0,0\n6,0,0,-1\n";

fn read_bytes(description: &str, log: &[u8]) -> Result<(Recording, FileSummary), RecordingError> {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("log.csv");
    std::fs::write(&path, log).unwrap();
    let (recording, mut summary) = Import::parse("bench.toml", description)?.read_csv(&path)?;
    Ok((recording, summary.files.remove(0)))
}

fn read(description: &str, log: &str) -> (Recording, FileSummary) {
    read_bytes(description, log.as_bytes()).unwrap()
}

/// The error, from the file's name on.
fn refused(description: &str, log: &str) -> String {
    let error = read_bytes(description, log.as_bytes()).unwrap_err().to_string();
    error
        .rsplit_once('/')
        .map_or(error.clone(), |(_, tail)| tail.to_owned())
}

/// The description with additional fields.
fn with(fields: &str) -> String {
    format!("{fields}\n{BENCH}")
}

/// All numbers of the only press.
fn numbers(recording: &Recording) -> Vec<(f64, Vec<f64>, f64)> {
    let press = &recording.presses[0];
    let frames = press
        .time_s
        .iter()
        .zip(&press.taxels_kpa)
        .zip(&press.gel_from_indenter);
    frames
        .map(|((time_s, kpa), pose)| (*time_s, kpa.clone(), pose.position_mm.z))
        .collect()
}

#[test]
fn what_differs_in_form_alone_is_read_the_same() {
    let plain = numbers(&read(BENCH, LOG).0);
    assert_eq!(plain.len(), 7);
    assert!(!read(BENCH, LOG).1.is_notable());
    let rows = LOG.split_once('\n').unwrap().1;
    let comma = LOG.replace(',', ";").replace(";2;4;", ";2,0;4,0e0;");
    for (name, description, log) in [
        (
            "a separator at the end of rows",
            BENCH.to_owned(),
            LOG.replace('\n', ",\n"),
        ),
        (
            "the same, but not of the header",
            BENCH.to_owned(),
            format!("t,a,b,z\n{}", rows.replace('\n', ",\n")),
        ),
        (
            "lines before the header",
            with("skip_lines = 2"),
            format!("Logger 3.1\n\"unit, V\n{LOG}"),
        ),
        (
            "comments",
            with("comment = \"#\""),
            format!("# gain 3\n{}", LOG.replace("3,4", "# touch\n3,4")),
        ),
        (
            "a decimal comma",
            with("decimal = \",\"\ndelimiter = \";\""),
            comma,
        ),
        (
            "tabs and blanks",
            with("delimiter = \"\\t\""),
            LOG.replace(',', " \t "),
        ),
        (
            "blanks alone",
            with("delimiter = \" \""),
            LOG.replace(',', "   ").replace('\n', "  \n  "),
        ),
        (
            "lines that end as on Windows, and empty ones",
            BENCH.to_owned(),
            LOG.replace('\n', "\r\n\r\n"),
        ),
        (
            "no end of the last line",
            BENCH.to_owned(),
            LOG.trim_end().to_owned(),
        ),
        (
            "quotes",
            BENCH.to_owned(),
            LOG.replace("t,a", "\"t\",\"a\"").replace("2,4", "\"2\",\"4\""),
        ),
        (
            "nanoseconds",
            BENCH.replace("column = \"t\"", "column = \"t\", unit = \"ns\", scale = 1e9"),
            LOG.to_owned(),
        ),
        (
            "centimetres",
            BENCH.replace(
                "column = \"z\"",
                "column = \"z\", unit = \"cm\", divide_by = 10.0",
            ),
            LOG.to_owned(),
        ),
        (
            "millibar",
            BENCH
                .replace("unit = \"kPa\"", "unit = \"mbar\"")
                .replace("column = \"a\"", "column = \"a\", scale = 10.0")
                .replace("column = \"b\"", "column = \"b\", scale = 10.0"),
            LOG.to_owned(),
        ),
        (
            "counts",
            BENCH.replace("unit = \"kPa\"", "unit = \"counts\", kpa_per_count = 1.0"),
            LOG.to_owned(),
        ),
        (
            "columns that nobody asked for",
            BENCH.to_owned(),
            LOG.lines().map(|line| format!("{line},hot\n")).collect(),
        ),
    ] {
        assert_eq!(numbers(&read(&description, &log).0), plain, "{name}");
    }
}

#[test]
fn other_encodings_are_read_and_said() {
    let plain = numbers(&read(BENCH, LOG).0);
    let extra = |name: &str| -> String {
        let lines = LOG.lines().enumerate();
        lines
            .map(|(index, line)| format!("{line},{}\n", if index == 0 { name } else { "1" }))
            .collect()
    };
    let latin: Vec<u8> = extra("Temperatur °C")
        .chars()
        .map(|character| character as u8)
        .collect();
    let utf16 = [
        vec![0xff, 0xfe],
        extra("温度").encode_utf16().flat_map(u16::to_le_bytes).collect(),
    ]
    .concat();
    // The column's name is in GBK.
    let gbk = LOG
        .replace("z\n", "z,@@\n")
        .replacen("1\n", "1,3\n", 1)
        .into_bytes();
    let gbk = String::from_utf8(gbk).unwrap();
    let gbk: Vec<u8> = gbk
        .lines()
        .enumerate()
        .flat_map(|(index, line)| {
            let line = if index > 1 {
                format!("{line},3\n")
            } else {
                format!("{line}\n")
            };
            line.bytes()
                .map(|byte| if byte == b'@' { 0xce } else { byte })
                .collect::<Vec<u8>>()
        })
        .collect();
    for (bytes, note) in [(latin, "Latin-1"), (utf16, "UTF-16"), (gbk, "Latin-1")] {
        let (recording, summary) = read_bytes(BENCH, &bytes).unwrap();
        assert_eq!(numbers(&recording), plain);
        assert!(summary.warnings[0].contains(note), "{summary}");
        assert_eq!(summary.unread_columns.len(), 1);
    }
}

#[test]
fn a_reading_that_is_missing_is_not_valid_and_the_rest_is_there() {
    for (word, fields) in [
        ("", ""),
        ("NaN", ""),
        ("nan", ""),
        ("N/A", ""),
        ("null", ""),
        ("ERR", "missing = [\"ERR\"]"),
        ("-999.0", "missing = [\"-999\"]"),
        ("inf", "missing = [\"inf\"]"),
    ] {
        let (recording, summary) = read(&with(fields), &LOG.replace("3,4,8", &format!("3,{word},8")));
        let press = &recording.presses[0];
        assert_eq!(summary.missing_readings, 1, "{word}");
        assert!(summary.is_notable(), "{word}");
        assert_eq!(summary.clipped_readings, 0, "{word}");
        assert!(
            press.taxels_kpa[3][0].is_nan() && press.taxels_raw[3][0].is_nan(),
            "{word}"
        );
        assert_eq!(
            (press.valid[3].clone(), press.taxels_kpa[3][1]),
            (vec![false, true], 8.0),
            "{word}"
        );
        assert_eq!(press.valid.iter().flatten().filter(|valid| !**valid).count(), 1);
    }
    for (word, remedy) in [
        ("ERR", "`missing`"),
        ("inf", "`missing`"),
        ("4,0", "expected 4 cells, found 5"),
        ("\"4,0\"", "`decimal = \",\"`"),
    ] {
        let error = refused(BENCH, &LOG.replace("3,4,8", &format!("3,{word},8")));
        assert!(
            error.starts_with("log.csv:5: ") && error.contains(remedy),
            "{error}"
        );
    }
}

#[test]
fn a_row_without_time_or_pose_is_refused_or_left_out() {
    for (old, new, line) in [("3,4,8,2", ",4,8,2", 5), ("3,4,8,2", "3,4,8,nan", 5)] {
        let log = LOG.replace(old, new);
        let error = refused(BENCH, &log);
        assert!(
            error.starts_with(&format!("log.csv:{line}: column `"))
                && error.contains("drop_incomplete_rows = true"),
            "{error}"
        );
        let (recording, summary) = read(&with("drop_incomplete_rows = true"), &log);
        assert_eq!(
            (
                recording.presses[0].time_s.len(),
                summary.rows_incomplete,
                summary.rows_read
            ),
            (6, 1, 7)
        );
        assert!(summary.to_string().contains("1 rows incomplete"), "{summary}");
    }
}

#[test]
fn what_a_crash_leaves_at_the_end_is_left_out_and_said() {
    let whole = numbers(&read(BENCH, LOG).0);
    for (tail, note) in [
        ("7,0,", "within a line"),
        ("\0\0\0\0", "4 bytes of zero"),
        ("7,0,0\0\0", "within a line"),
    ] {
        let (recording, summary) = read(BENCH, &format!("{LOG}{tail}"));
        assert_eq!(numbers(&recording), whole, "{tail:?}");
        assert!(summary.to_string().contains(note), "{summary}");
    }
    // In the middle of a file, and at the end of a complete line, it is not a cut.
    for log in [LOG.replace("3,4,8,2", "3,4,8"), format!("{LOG}7,0,\n")] {
        assert!(refused(BENCH, &log).contains("expected 4 cells, found 3"));
    }
    let twice = refused(BENCH, &format!("{LOG}{LOG}"));
    assert!(
        twice.starts_with("log.csv:9: ") && twice.contains("split it into two files"),
        "{twice}"
    );
}

#[test]
fn the_first_of_several_errors_is_said() {
    // Errors are reported in the order of lines, and within a line in the order of columns, also
    // with thousands of rows between.
    let many = "6,0,0,-1\n".repeat(10_000);
    for (log, line, column) in [
        ("t,a,b,z\n0,0,x,-1\n1,x,x,0\n", 2, "b"),
        ("t,a,b,z\n0,0,0,-1\n1,x,0,y\n", 3, "a"),
        ("t,a,b,z\n0,x,0,-1\n1,0,0\n2,0,0,0\n", 2, "a"),
        (&format!("{LOG}7,x,0,-1\n{many}8,y,0,-1\n9,0\n{many}"), 9, "a"),
        (&format!("{LOG}{many}8,0,y,-1\n{many}9,x,0,-1\n"), 10_009, "b"),
    ] {
        let error = refused(BENCH, log);
        assert!(
            error.contains(&format!(":{line}:")) && error.contains(&format!("`{column}`")),
            "{error}, expected line {line}, column {column}"
        );
    }
}

#[test]
fn a_clock_as_text_counts_from_the_first_row() {
    let plain = numbers(&read(BENCH, LOG).0);
    let description = BENCH.replace("column = \"t\"", "column = \"t\", unit = \"clock\"");
    let timed = |time: &dyn Fn(u32) -> String| -> String {
        let line = |(index, line): (usize, &str)| match (index, line.split_once(',').unwrap().1) {
            (0, _) => format!("{line}\n"),
            (index, rest) => format!("{},{rest}\n", time(index as u32 - 1)),
        };
        LOG.lines().enumerate().map(line).collect()
    };
    for log in [
        timed(&|s| format!("13:05:{:02}.000", 50 + s)),
        timed(&|s| format!("2026-11-26T13:05:{:02}Z", 50 + s)),
        timed(&|s| format!("2026-11-26 13:05:{:02}.0", 50 + s)),
        // Across midnight.
        timed(&|s| {
            if s < 3 {
                format!("23:59:{}", 57 + s)
            } else {
                format!("00:00:{:02}", s - 3)
            }
        }),
    ] {
        assert_eq!(numbers(&read(&description, &log).0), plain, "{log}");
        assert!(refused(BENCH, &log).contains("`unit = \"clock\"`"));
    }
    // A date that goes back is not midnight.
    let back = timed(&|s| format!("2026-11-{:02} 13:05:00", if s < 3 { 26 + s } else { 20 + s }));
    let error = refused(&description, &back);
    assert!(error.contains("expected times to increase"), "{error}");
    let error = refused(&description, &LOG.replace("3,4", "soon,4"));
    assert!(error.contains("expected a time"), "{error}");
}

#[test]
fn a_counter_that_rolls_over_goes_on() {
    let description = |more: &str| {
        BENCH.replace(
            "column = \"t\"",
            &format!("column = \"t\", unit = \"us\", scale = 1e6{more}"),
        )
    };
    let log = "t,a,b,z\n4294967292,0,0,-1\n4294967293,0,0,0\n4294967294,2,4,1\n4294967295,4,8,2\n0,2,4,1\n1,0,0,0\n2,0,0,-1\n";
    let (recording, _) = read(
        &description(", wraps_at = 4294967296, offset = -4294967292.0"),
        log,
    );
    assert_eq!(numbers(&recording), numbers(&read(BENCH, LOG).0));
    let error = refused(&description(""), log);
    assert!(
        error.starts_with("log.csv:6: ") && error.contains("`wraps_at = 4294967296`"),
        "{error}"
    );
    assert!(refused(BENCH, &LOG.replace("3,4,8", "1.5,4,8")).contains("split it into two files"));
}

#[test]
fn rows_that_arrive_in_bursts_are_spread() {
    let log = LOG
        .replace("\n1,", "\n2,")
        .replace("\n3,", "\n4,")
        .replace("\n5,", "\n6,");
    let log = log.replacen("\n0,", "\n0.5,", 1);
    let error = refused(BENCH, &log);
    assert!(error.contains("repeated = \"spread\""), "{error}");
    let description = |repeated: &str| {
        BENCH.replace(
            "column = \"t\"",
            &format!("column = \"t\", repeated = {repeated}"),
        )
    };
    let times = |repeated: &str| read(&description(repeated), &log).0.presses[0].time_s.clone();
    assert_eq!(times("\"spread\""), [0.5, 1.25, 2.0, 3.0, 4.0, 5.0, 6.0]);
    assert_eq!(times("{ rate_hz = 2.0 }"), [0.5, 1.5, 2.0, 3.5, 4.0, 5.5, 6.0]);
    let too_slow = refused(&description("{ rate_hz = 0.1 }"), &log);
    assert!(too_slow.contains("expected times to increase"), "{too_slow}");
}

#[test]
fn presses_can_have_names() {
    let description = BENCH.replace(
        "split = \"return-to-rest\", rest_mm = -1.0",
        "split = \"column\", column = \"press\"",
    );
    let log = "t,a,b,z,press\n0,0,0,-1,\n1,2,4,1,first\n2,4,8,2,first\n3,2,4,1,\n4,2,4,1,2\n5,0,0,0,2.0\n6,0,0,-1,\n";
    let (recording, _) = read(&description, log);
    let frames: Vec<usize> = recording.presses.iter().map(|press| press.time_s.len()).collect();
    assert_eq!(frames, [2, 2]);
}

#[test]
fn quaternions_turn_the_indenter() {
    let description =
        with("rotation = { columns = [\"qx\", \"qy\", \"qz\", \"qw\"], upright = [1.0, 0.0, 0.0, 0.0] }");
    let turned = |quaternion: &str| -> String {
        let lines = LOG.lines().enumerate();
        lines
            .map(|(index, line)| format!("{line},{}\n", if index == 0 { "qx,qy,qz,qw" } else { quaternion }))
            .collect()
    };
    let (recording, _) = read(&description, &turned("1,0,0,0"));
    assert!(
        recording.presses[0].gel_from_indenter[3]
            .rotation
            .is_near_identity()
    );
    let half = std::f64::consts::FRAC_1_SQRT_2;
    let (recording, _) = read(&description, &turned(&format!("{half},0,0,{half}")));
    let turn = recording.presses[0].gel_from_indenter[3].rotation;
    assert!((turn.to_axis_angle().1 - std::f64::consts::FRAC_PI_2).abs() < 1e-9);
    let error = refused(&description, &turned("1,0,0,1"));
    assert!(
        error.contains("length 1.41") && error.contains("x, y, z, w"),
        "{error}"
    );
    // Rotation columns that are not requested are reported as unread.
    let (_, summary) = read(BENCH, &turned("1,0,0,0"));
    assert!(
        summary.to_string().contains("columns not read: qx, qy, qz, qw"),
        "{summary}"
    );
}

#[test]
fn columns_that_are_not_found_come_with_what_to_set() {
    for (log, remedy) in [
        (
            LOG.replace(',', ";"),
            "line 1 has all columns: set `delimiter = \";\"`",
        ),
        (
            format!("Logger\nV 3\n{LOG}"),
            "line 3 has all columns: set `skip_lines = 2`",
        ),
        (
            format!("Logger\n{}", LOG.replace(',', "\t")),
            "set `delimiter = \"\\t\"` and `skip_lines = 1`",
        ),
        (LOG.split_once('\n').unwrap().1.to_owned(), "`columns = [...]`"),
    ] {
        let error = refused(BENCH, &log);
        assert!(
            error.starts_with("log.csv:1: no column `a`") && error.contains(remedy),
            "{error}"
        );
    }
}

#[test]
fn silent_choices_are_errors() {
    let error = refused(BENCH, &LOG.replacen("t,a,b,z", "t,a,a,z", 1).replace(",b", ",a"));
    assert!(
        error.starts_with("log.csv:1: ")
            && error.contains("two columns have the name `a`, the 2nd and the 3rd"),
        "{error}"
    );
    // Names of columns that are not requested may occur twice.
    assert!(
        read_bytes(
            BENCH,
            LOG.replace("z\n", "z,e,e\n")
                .replace("1\n", "1,,\n")
                .replace("0\n", "0,,\n")
                .replace("2\n", "2,,\n")
                .as_bytes()
        )
        .is_ok()
    );
    let error = Import::parse("bench.toml", &BENCH.replace("column = \"b\"", "column = \"a\""))
        .unwrap_err()
        .to_string();
    assert!(
        error.contains("taxels[1].column") && error.contains("the column of another taxel"),
        "{error}"
    );
    let error = refused(&BENCH.replace("z_mm = 0.0", "z_mm = 11.0"), LOG);
    assert!(
        error.contains("no press reaches the gel: the deepest is 9.000 mm above it"),
        "{error}"
    );
    let air = LOG
        .replace(",0,0,", ",101.3,0,")
        .replace(",2,4,", ",103.3,4,")
        .replace(",4,8,", ",105.3,8,");
    let error = refused(BENCH, &air);
    assert!(
        error.contains("`S0` have a median of 101.3 kPa") && error.contains("give `zero`"),
        "{error}"
    );
    assert!(
        read_bytes(
            &with("zero = { above_contact_mm = 0.1, window_s = 2.0 }"),
            air.as_bytes()
        )
        .is_ok()
    );
}

#[test]
fn frames_that_two_presses_share_are_counted() {
    let log = LOG.to_owned() + "7,0,0,-1\n8,0,0,0\n9,2,4,1\n10,0,0,0\n11,0,0,-1\n";
    let description = BENCH.replace("rest_mm = -1.0", "rest_mm = -1.0, keep_rest_s = 5.0");
    let (recording, summary) = read(&description, &log);
    let frames: usize = recording.presses.iter().map(|press| press.time_s.len()).sum();
    assert_eq!((frames, summary.shared_frames), (12 + 2, 2));
    assert!(
        summary.to_string().contains("2 frames shared by two presses"),
        "{summary}"
    );
}

/// A log of five presses. `line` writes time, height, force and two absolute readings, Pa.
fn pressed(header: &str, line: &dyn Fn([f64; 5]) -> String) -> String {
    let row = |row: u32| {
        let z = (f64::from(row % 60) / 30.0 - 1.0).abs() * 4.0 - 1.0;
        let touch = (-z).max(0.0);
        let readings = [101_325.0 + 9_000.0 * touch, 101_400.0 + 4_000.0 * touch];
        line([f64::from(row) * 0.018, z, 2.0 * touch, readings[0], readings[1]]) + "\n"
    };
    let rows: String = (0..300).map(row).collect();
    format!("{header}\n{rows}")
}

/// Guesses a description, checks its parts, and imports the log with it.
fn guessed(log: &str, parts: &[&str]) {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("log.csv");
    std::fs::write(&path, log).unwrap();
    let guess = guess_import(&path).unwrap();
    for part in parts {
        assert!(guess.contains(part), "no `{part}` in\n{guess}");
    }
    // A decimal comma is found only in a log that has one.
    let has_comma = parts.contains(&"decimal = \",\"");
    assert_eq!(guess.contains("decimal"), has_comma, "{guess}");
    let import = Import::parse("guessed.toml", &guess).unwrap();
    // A file without column names needs names first.
    if guess.contains("columns = [\"") {
        return;
    }
    let (recording, _) = import
        .read_csv(&path)
        .unwrap_or_else(|error| panic!("{error}\n{guess}"));
    assert!(recording.presses.len() >= 4, "{guess}");
    for press in &recording.presses[1..4] {
        let largest = press.taxels_kpa.iter().map(|kpa| kpa[0]).fold(0.0, f64::max);
        assert!(largest > 5.0, "{largest} kPa\n{guess}");
    }
}

#[test]
fn a_guessed_description_reads_the_log_that_it_was_guessed_from() {
    guessed(
        &pressed("time_s,x_mm,y_mm,z_mm,force_N,p0_Pa,p1_Pa", &|[t, z, f, a, b]| {
            format!("{t:.3},1,2,{z:.3},{f:.3},{a:.1},{b:.1}")
        }),
        &[
            "unit = \"s\"",
            "55.6 rows a second",
            "\"force_N\"",
            "z_mm = -",
            "name = \"p0\", column = \"p0_Pa\"",
        ],
    );
    // From a spreadsheet.
    guessed(
        &pressed("Zeit;ms;z (cm);S1;S2", &|[t, z, _, a, b]| {
            let [ms, z, a, b] = [t * 1e3, z / 10.0, a / 100.0, b / 100.0];
            format!("{t:.3};{ms:.0};{z:.4};{a:.2};{b:.2}").replace('.', ",")
        }),
        &[
            "delimiter = \";\"",
            "decimal = \",\"",
            "unit = \"ms\"",
            "unit = \"cm\"",
            "unit = \"hPa\"",
        ],
    );
    // Tabs and semicolons, with decimal points.
    for (delimiter, escaped) in [('\t', "\\t"), (';', ";")] {
        let split = |line: String| line.replace(',', &delimiter.to_string());
        guessed(
            &pressed(&split("t,z,p0,p1".into()), &|[t, z, _, a, b]| {
                split(format!("{t:.3},{z:.3},{a:.1},{b:.1}"))
            }),
            &[&format!("delimiter = \"{escaped}\"")],
        );
    }
    // Lines before the header, and a clock.
    guessed(
        &pressed(
            "Logger 3.1\nunit 7, lab\n\nclock,z,baro1,baro2,note",
            &|[t, z, _, a, b]| format!("12:00:{t:06.3},{z:.3},{:.4},{:.4},ok", a / 1e3, b / 1e3),
        ),
        &["skip_lines = 2", "unit = \"clock\"", "unit = \"kPa\""],
    );
    // Lines of a microcontroller.
    guessed(
        &pressed("# gain 3", &|[t, z, _, a, b]| {
            format!("{:.0} {z:.3} {:.0} {:.0}", t * 1e6, a / 64.0, b / 64.0)
        }),
        &[
            "delimiter = \" \"",
            "comment = \"#\"",
            "columns = [\"c1\", \"c2\", \"c3\", \"c4\"]",
        ],
    );
    // Metres that increase downwards, a quaternion, presses with names.
    guessed(
        &pressed("t,depth_m,qx,qy,qz,qw,taxel0,taxel1,label", &|[t, z, _, a, b]| {
            let (depth, press) = ((3.0 - z) / 1e3, (t / 1.08) as u32);
            format!("{t:.3},{depth:.6},0,0,0,1,{a:.0},{b:.0},press{press}")
        }),
        &[
            "unit = \"m\"",
            "z_points = \"down\"",
            "rotation =",
            "column = \"label\"",
        ],
    );
}

#[test]
fn a_letter_is_no_log() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("letter.txt");
    std::fs::write(&path, "Dear Sir,\nno numbers.\n").unwrap();
    let error = guess_import(&path).unwrap_err().to_string();
    assert!(error.contains("no rows of numbers"), "{error}");
}
