//! Files of other programs, without a seal and with any content.

use glam::DVec3;
use twintac_shape::Pose;

use super::schema;
use crate::{Control, Press, Provenance, Recording};

fn recording() -> Recording {
    let press = |name: &str| Press {
        name: name.to_owned(),
        mounting: "bench.csv".to_owned(),
        indenter: "tip".to_owned(),
        control: Control::Force,
        time_s: vec![0.125, 0.25],
        gel_from_indenter: vec![Pose::from_position(DVec3::new(1.0, 2.0, 6.0)); 2],
        force_n: Some(vec![7.0, 9.0]),
        taxels_kpa: vec![vec![3.0], vec![5.0]],
        temperature_c: None,
        taxels_raw: vec![vec![100.0], vec![101.0]],
        valid: vec![vec![true], vec![false]],
    };
    Recording {
        sensor: "one".to_owned(),
        provenance: Provenance::Emulated,
        taxels: vec!["S0".to_owned()],
        presses: vec![press("bench#1"), press("bench#2")],
    }
}

fn read(bytes: &[u8]) -> Result<Recording, String> {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("foreign.parquet");
    std::fs::write(&path, bytes).unwrap();
    Recording::read_parquet(&path).map_err(|e| e.to_string())
}

/// The error of reading a file in which all occurrences of some bytes were replaced by other bytes.
fn error_with(old: &[u8], new: &[u8]) -> String {
    assert_eq!(old.len(), new.len());
    let mut bytes = recording().to_parquet(schema::MOUNTING).unwrap();
    let places: Vec<usize> = (0..bytes.len())
        .filter(|&at| bytes[at..].starts_with(old))
        .collect();
    assert!(!places.is_empty());
    for at in places {
        bytes[at..at + old.len()].copy_from_slice(new);
    }
    let error = read(&bytes).unwrap_err();
    error
        .rsplit_once("recording: ")
        .map_or(error.clone(), |(_, tail)| tail.to_owned())
}

#[test]
fn a_file_without_a_seal_is_read() {
    assert_eq!(
        read(&recording().to_parquet(schema::MOUNTING).unwrap()).unwrap(),
        recording()
    );
}

#[test]
fn the_mounting_may_have_its_old_name() {
    let old = recording().to_parquet(schema::OLD_MOUNTING).unwrap();
    assert!(!old.windows(8).any(|bytes| bytes == b"mounting"));
    assert_eq!(read(&old).unwrap(), recording());
}

#[test]
fn what_is_wrong_is_named() {
    assert_eq!(error_with(b"time_s", b"when_s"), "it has no column `time_s`");
    assert_eq!(error_with(b"S0_raw", b"S0_sad"), "it has no column `S0_raw`");
    assert_eq!(
        error_with(b"twintac.sensor", b"twintac.sentry"),
        "its metadata has no `twintac.sensor`"
    );
    let unknown = "its provenance is `imagined`, expected `real`, `emulated` or `simulated`";
    assert_eq!(error_with(b"emulated", b"imagined"), unknown);
    assert_eq!(
        error_with(b"\x05\0\0\0force", b"\x05\0\0\0farce"),
        "column `control` says `farce`, expected `pose` or `force`"
    );
}

#[test]
fn impossible_numbers_are_named() {
    let with = |old: f64, new: f64| error_with(&old.to_le_bytes(), &new.to_le_bytes());
    assert!(
        with(9.0, f64::NAN).contains("frame 1: `force_n` is NaN"),
        "{}",
        with(9.0, f64::NAN)
    );
    assert!(with(3.0, f64::NAN).contains("frame 0: the reading of `S0` is missing, but marked as valid"));
    assert!(with(5.0, f64::NEG_INFINITY).contains("frame 1: the reading of `S0` is infinite"));
    assert!(with(0.25, 0.0).contains("frame 1: time 0 s follows 0.125 s"));
    assert!(with(6.0, f64::INFINITY).contains("the pose is not finite"));
}

#[test]
fn no_altered_byte_makes_the_reader_panic() {
    let whole = recording().to_parquet(schema::MOUNTING).unwrap();
    for place in 0..whole.len() {
        let mut bytes = whole.clone();
        bytes[place] ^= [0x01, 0x80, 0xff][place % 3];
        // Without a seal a changed number may be unnoticed, but what is read meets the conditions
        // of a recording.
        if let Ok(recording) = read(&bytes) {
            recording.check().unwrap();
        }
    }
}

#[test]
fn a_long_recording_has_several_row_groups_and_reads_back() {
    let mut long = recording();
    for press in &mut long.presses {
        let n = 140_000;
        press.time_s = (0..n).map(|frame| f64::from(frame) / 64.0).collect();
        press.gel_from_indenter = vec![press.gel_from_indenter[0]; n as usize];
        press.force_n = Some(vec![7.0; n as usize]);
        press.taxels_kpa = (0..n).map(|frame| vec![f64::from(frame)]).collect();
        press.taxels_raw = press.taxels_kpa.clone();
        press.valid = vec![vec![true]; n as usize];
    }
    let bytes = long.to_parquet(schema::MOUNTING).unwrap();
    let columns = super::column::Columns::open(bytes.clone()).unwrap();
    assert_eq!(columns.n_row_groups(), 2);
    assert_eq!(read(&bytes).unwrap(), long);
}
