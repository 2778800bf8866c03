//! Recordings as data sets of LeRobot, where readings are missing and names are odd.

#![allow(clippy::unwrap_used)] // also in the helpers of tests

use glam::DVec3;
use serde_json::Value;
use twintac_recording::{Control, Press, Provenance, Recording};
use twintac_shape::Pose;

/// 268 frames of two taxels; the first gave nothing in 61 of them.
fn recording() -> Recording {
    let n = 268;
    let is_missing = |frame: usize| (100..161).contains(&frame);
    let kpa = |frame: usize| frame as f64 / 100.0;
    let row = |frame: usize, more: f64| {
        let first = if is_missing(frame) {
            f64::NAN
        } else {
            kpa(frame) + more
        };
        vec![first, kpa(frame) + more]
    };
    Recording {
        sensor: "pair".to_owned(),
        provenance: Provenance::Emulated,
        taxels: vec!["S0".to_owned(), "S1".to_owned()],
        presses: vec![Press {
            name: "ball#000".to_owned(),
            mounting: "ball".to_owned(),
            indenter: "ball".to_owned(),
            control: Control::Pose,
            time_s: (0..n).map(|frame| frame as f64 / 100.0).collect(),
            gel_from_indenter: vec![Pose::from_position(DVec3::new(0.0, 0.0, 6.0)); n],
            force_n: None,
            taxels_kpa: (0..n).map(|frame| row(frame, 0.0)).collect(),
            taxels_raw: (0..n).map(|frame| row(frame, 101.0)).collect(),
            valid: (0..n).map(|frame| vec![!is_missing(frame), true]).collect(),
        }],
    }
}

/// The folder's `meta/stats.json` and its card.
fn written(recording: &Recording) -> (Value, String) {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("dataset");
    recording.write_lerobot(&path, "By hand.").unwrap();
    let text = |name: &str| std::fs::read_to_string(path.join(name)).unwrap();
    (
        serde_json::from_str(&text("meta/stats.json")).unwrap(),
        text("README.md"),
    )
}

#[test]
fn statistics_are_of_the_readings_that_came() {
    let recording = recording();
    let (stats, card) = written(&recording);
    let tactile = &stats["observation.tactile"];
    let rows = recording.presses[0].taxels_kpa.iter();
    let came: Vec<f64> = rows.map(|row| row[0]).filter(|kpa| !kpa.is_nan()).collect();
    let mean = came.iter().sum::<f64>() / came.len() as f64;
    assert!(
        (tactile["mean"][0].as_f64().unwrap() - mean).abs() < 1e-12,
        "{tactile}"
    );
    assert_eq!(tactile["count"][0], 268);
    assert!(
        card.contains("Taxel S0 has no reading that can be used in 61 of 268 frames"),
        "{card}"
    );
    assert!(!card.contains("Taxel S1"));
}

#[test]
fn a_reading_that_cannot_be_used_does_not_count_and_a_silent_taxel_has_no_statistics() {
    let mut clipped = recording();
    clipped.presses[0].taxels_kpa[7][1] = 1e6;
    clipped.presses[0].valid[7][1] = false;
    let (stats, _) = written(&clipped);
    assert_eq!(stats["observation.tactile"]["max"][1], 2.67);
    for row in &mut clipped.presses[0].valid {
        row[0] = false;
    }
    let (stats, card) = written(&clipped);
    let tactile = stats["observation.tactile"].as_object().unwrap();
    let names = tactile.keys().filter(|name| *name != "count");
    assert!(
        names.into_iter().all(|name| tactile[name][0].is_null()),
        "{stats}"
    );
    assert!(card.contains("in 268 of 268 frames"), "{card}");
}

#[test]
fn names_are_text_in_the_card() {
    let mut odd = recording();
    odd.sensor = "x\"]<script>alert(1)</script>\u{1b}[2J".to_owned();
    odd.taxels[0] = "a|b\n# c".to_owned();
    let (_, card) = written(&odd);
    assert!(
        !card.contains("# Presses of the barometric touch sensor x\"]<script>"),
        "{card}"
    );
    assert!(
        card.contains("x\"\\]&lt;script&gt;") && card.contains("a\\|b # c_kpa"),
        "{card}"
    );
    assert!(!card.contains('\u{1b}'));
    assert!(
        card.contains(r#"LeRobotDataset("twintac/x\"]<script>"#),
        "a literal of Python: {card}"
    );
}
