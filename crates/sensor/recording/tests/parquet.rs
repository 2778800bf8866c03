//! Recordings written to Parquet files and read back.

#![allow(clippy::unwrap_used)] // also in the helpers of tests

use std::path::{Path, PathBuf};

use glam::{DQuat, DVec3};
use proptest::prelude::*;
use tempfile::TempDir;
use twintac_recording::{Column, Control, Press, Provenance, Recording};
use twintac_shape::Pose;

fn number() -> impl Strategy<Value = f64> {
    prop_oneof![
        -1e3..1e3,
        Just(0.0),
        Just(-0.0),
        Just(f64::MIN_POSITIVE),
        Just(1e300)
    ]
}

fn press(taxels: usize) -> impl Strategy<Value = Press> {
    let mm = || prop_oneof![-1e4..1e4, Just(-0.0)];
    let reading = || prop_oneof![4 => number(), 1 => Just(f64::NAN)];
    let taxel = (reading(), reading(), any::<bool>()).prop_map(|(kpa, raw, valid)| {
        let is_there = !kpa.is_nan() && !raw.is_nan();
        (kpa, raw, valid && is_there)
    });
    let frame = (
        1e-6..10.0,
        [mm(), mm(), mm()],
        [-3.0..3.0, -3.0..3.0, -3.0..3.0],
        number(),
        proptest::collection::vec(taxel, taxels),
    );
    let frames = proptest::collection::vec(frame, 1..30);
    ("\\PC{0,12}", "\\PC{1,8}", any::<bool>(), any::<bool>(), frames).prop_map(
        move |(mounting, indenter, is_force, has_force, frames)| {
            let mut time_s = 0.0;
            let times = frames.iter().map(|frame| {
                time_s += frame.0;
                time_s
            });
            let pose = |position: [f64; 3], angles: [f64; 3]| Pose {
                position_mm: DVec3::from(position),
                rotation: DQuat::from_scaled_axis(DVec3::from(angles)),
            };
            Press {
                name: String::new(),
                mounting,
                indenter,
                control: if is_force { Control::Force } else { Control::Pose },
                time_s: times.collect(),
                gel_from_indenter: frames.iter().map(|frame| pose(frame.1, frame.2)).collect(),
                force_n: has_force.then(|| frames.iter().map(|frame| frame.3).collect()),
                taxels_kpa: frames
                    .iter()
                    .map(|frame| frame.4.iter().map(|taxel| taxel.0).collect())
                    .collect(),
                temperature_c: (has_force && taxels > 0).then(|| {
                    let of_taxel = |taxel: &(f64, f64, bool)| if taxel.2 { 20.0 } else { 25.5 };
                    let rows = frames.iter().map(|frame| frame.4.iter().map(of_taxel).collect());
                    rows.collect()
                }),
                taxels_raw: frames
                    .iter()
                    .map(|frame| frame.4.iter().map(|taxel| taxel.1).collect())
                    .collect(),
                valid: frames
                    .iter()
                    .map(|frame| frame.4.iter().map(|taxel| taxel.2).collect())
                    .collect(),
            }
        },
    )
}

fn recording() -> impl Strategy<Value = Recording> {
    let provenance = prop_oneof![
        Just(Provenance::Real),
        Just(Provenance::Emulated),
        Just(Provenance::Simulated)
    ];
    (0_usize..4).prop_flat_map(move |taxels| {
        (
            "\\PC{0,12}",
            provenance.clone(),
            proptest::collection::vec(press(taxels), 1..5),
        )
            .prop_map(move |(sensor, provenance, mut presses)| {
                for (index, press) in presses.iter_mut().enumerate() {
                    press.name = format!("press#{}", index + 1);
                }
                let taxels = (0..taxels).map(|taxel| format!("s{taxel}")).collect();
                Recording {
                    sensor,
                    provenance,
                    taxels,
                    presses,
                }
            })
    })
}

fn example() -> Recording {
    let press = |name: &str, force_n: Option<Vec<f64>>| Press {
        name: name.to_owned(),
        mounting: "bench.csv".to_owned(),
        indenter: "tip".to_owned(),
        control: Control::Pose,
        time_s: vec![0.0, 0.1, 0.2],
        gel_from_indenter: vec![Pose::from_position(DVec3::new(1.0, 2.0, 6.0)); 3],
        force_n,
        taxels_kpa: vec![vec![0.0, 0.5], vec![1.5, 2.5], vec![-0.1, 0.0]],
        temperature_c: None,
        taxels_raw: vec![vec![100.0, 200.0], vec![101.5, 202.0], vec![99.9, 199.5]],
        valid: vec![vec![true, true], vec![true, false], vec![true, true]],
    };
    Recording {
        sensor: "pair".to_owned(),
        provenance: Provenance::Simulated,
        taxels: vec!["S0".to_owned(), "S1".to_owned()],
        presses: vec![
            press("bench#1", None),
            press("bench#2", Some(vec![0.0, 1.0, 0.5])),
        ],
    }
}

fn file() -> (TempDir, PathBuf) {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("recording.parquet");
    (folder, path)
}

fn written(recording: &Recording) -> Vec<u8> {
    let (_folder, path) = file();
    recording.write_parquet(&path).unwrap();
    std::fs::read(&path).unwrap()
}

/// The error of reading a file with these bytes.
fn error(bytes: &[u8]) -> String {
    let (_folder, path) = file();
    std::fs::write(&path, bytes).unwrap();
    Recording::read_parquet(&path).unwrap_err().to_string()
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(64))]

    #[test]
    fn recordings_come_back_bit_for_bit(recording in recording()) {
        let (_folder, path) = file();
        recording.write_parquet(&path).unwrap();
        let back = Recording::read_parquet(&path).unwrap();
        // Debug text distinguishes 0 from -0, which are equal.
        prop_assert_eq!(format!("{:?}", back), format!("{:?}", recording));
        let json = serde_json::to_string(&recording.presses).unwrap();
        let back: Vec<Press> = serde_json::from_str(&json).unwrap();
        prop_assert_eq!(&back, &recording.presses);
    }

    #[test]
    fn random_bytes_are_an_error(mut bytes in proptest::collection::vec(any::<u8>(), 0..300), framed in any::<bool>()) {
        if framed {
            bytes.splice(0..0, *b"PAR1");
            bytes.extend((bytes.len() as u32 / 2).to_le_bytes());
            bytes.extend(b"PAR1");
        }
        prop_assert!(error(&bytes).contains("not a readable recording"));
    }
}

#[test]
fn every_flipped_byte_is_found_or_does_no_harm() {
    let recording = example();
    let bytes = written(&recording);
    let (_folder, path) = file();
    let mut harmless = 0;
    for place in 0..bytes.len() {
        let mut bytes = bytes.clone();
        bytes[place] ^= 0x55;
        std::fs::write(&path, bytes).unwrap();
        // Only the mark of the checksum contains nothing of the recording.
        match Recording::read_parquet(&path) {
            Ok(back) => {
                assert_eq!(back, recording, "byte {place}");
                harmless += 1;
            }
            Err(error) => assert!(error.to_string().contains("not a readable recording"), "{error}"),
        }
    }
    assert_eq!(harmless, 8);
}

#[test]
fn every_truncation_is_found() {
    let bytes = written(&example());
    for length in 0..bytes.len() {
        let error = error(&bytes[..length]);
        assert!(
            error.contains("truncated") || error.contains("does not start"),
            "{length}: {error}"
        );
    }
}

#[test]
fn the_same_recording_gives_the_same_bytes_and_leaves_no_partial_file() {
    let (folder, path) = file();
    example().write_parquet(&path).unwrap();
    let first = std::fs::read(&path).unwrap();
    example().write_parquet(&path).unwrap();
    assert_eq!(std::fs::read(&path).unwrap(), first);
    assert_eq!(std::fs::read_dir(folder.path()).unwrap().count(), 1);
}

#[test]
fn files_that_cannot_be_opened_are_named() {
    let path = Path::new("/nowhere/recording.parquet");
    let error = example().write_parquet(path).unwrap_err().to_string();
    assert!(
        error.starts_with("cannot write /nowhere/recording.parquet"),
        "{error}"
    );
    let error = Recording::read_parquet(path).unwrap_err().to_string();
    assert!(
        error.starts_with("cannot read /nowhere/recording.parquet"),
        "{error}"
    );
}

#[test]
fn inconsistent_recordings_are_not_written() {
    let spoiled = |spoil: fn(&mut Recording)| {
        let mut recording = example();
        spoil(&mut recording);
        let (_folder, path) = file();
        let error = recording.write_parquet(&path).unwrap_err().to_string();
        assert!(!path.exists());
        error
    };
    let error = spoiled(|r| r.presses[1].time_s[2] = 0.05);
    assert_eq!(
        error,
        "press `bench#2`, frame 2: time 0.05 s follows 0.1 s, expected times to increase"
    );
    let missing = "press `bench#1`, frame 1: the reading of `S0` is missing, but marked as valid";
    assert_eq!(spoiled(|r| r.presses[0].taxels_kpa[1][0] = f64::NAN), missing);
    assert_eq!(spoiled(|r| r.presses[0].taxels_raw[1][0] = f64::NAN), missing);
    let error = spoiled(|r| r.presses[0].taxels_raw[1][1] = f64::INFINITY);
    assert_eq!(
        error,
        "press `bench#1`, frame 1: the reading of `S1` is infinite; one that is missing is NaN"
    );
    let error = spoiled(|r| r.presses[0].gel_from_indenter[2].position_mm.z = -1e300);
    assert!(
        error.starts_with("press `bench#1`, frame 2: the indenter is 1")
            && error.contains("are its lengths in mm?"),
        "{error}"
    );
    let error = spoiled(|r| r.presses[0].time_s[0] = f64::NAN);
    assert_eq!(
        error,
        "press `bench#1`, frame 0: `time_s` is NaN, expected a finite number"
    );
    let error = spoiled(|r| r.presses[0].valid[1] = vec![true]);
    assert_eq!(
        error,
        "press `bench#1`, frame 1: expected 2 taxels, found [2, 2, 1] (kPa, raw, valid)"
    );
    let error = spoiled(|r| r.presses[1].force_n = Some(vec![1.0]));
    assert_eq!(error, "press `bench#2`: `force_n` has 1 frames, `time_s` 3");
    let error =
        spoiled(|r| r.presses[1].gel_from_indenter[0].rotation = DQuat::from_xyzw(0.0, 0.0, 0.0, 2.0));
    assert_eq!(
        error,
        "press `bench#2`, frame 0: the rotation's quaternion has length 2, expected 1"
    );
    let error = spoiled(|r| r.presses[1].name = "bench#1".to_owned());
    assert_eq!(error, "recording: press name `bench#1` is given twice");
    let error = spoiled(|r| r.taxels[1] = "S0".to_owned());
    assert_eq!(error, "recording: taxel name `S0` is empty or given twice");
}

#[test]
fn a_table_without_presses_is_an_error() {
    let (_folder, path) = file();
    let mut empty = example();
    empty.presses.clear();
    empty.write_parquet(&path).unwrap();
    let error = Recording::read_parquet(&path).unwrap_err().to_string();
    let expected = format!(
        "{}: found no presses in 0 rows: the table is empty",
        path.display()
    );
    assert_eq!(error, expected);
}

/// A missing reading: NaN in memory, null in the table.
fn example_with_a_gap() -> Recording {
    let mut recording = example();
    let press = &mut recording.presses[0];
    (press.taxels_kpa[1][1], press.taxels_raw[1][1]) = (f64::NAN, f64::NAN);
    recording
}

#[test]
fn a_missing_reading_is_missing_in_columns_and_files() {
    let recording = example_with_a_gap();
    let columns = recording.columns();
    for name in ["S1_kpa", "S1_raw"] {
        let (_, Column::Known(readings)) = columns.iter().find(|(other, _)| other == name).unwrap() else {
            panic!("{name} has no gaps");
        };
        let missing: Vec<usize> = (0..readings.len())
            .filter(|&row| readings[row].is_none())
            .collect();
        assert_eq!(missing, [1]);
    }
    let (_folder, path) = file();
    recording.write_parquet(&path).unwrap();
    let back = Recording::read_parquet(&path).unwrap();
    assert_eq!(back, recording);
    assert!(back.presses[0].taxels_kpa[1][1].is_nan());
    assert_ne!(back, example());
}
