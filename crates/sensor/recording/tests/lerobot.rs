//! Recordings as LeRobot data sets, with missing readings and unusual names.

#![allow(clippy::unwrap_used)] // also in the helpers of tests

use glam::DVec3;
use serde_json::Value;
use twintac_recording::{Control, Press, Provenance, Recording};
use twintac_shape::Pose;

/// 268 frames of two taxels; in 61 of them the first has no reading.
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
            temperature_c: None,
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

/// The numbers of frames of the recording, its rate, and its card.
fn rate(recording: &Recording) -> (twintac_recording::LeRobotSummary, Value, String) {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("dataset");
    let summary = recording.write_lerobot(&path, "By hand.").unwrap();
    let text = |name: &str| std::fs::read_to_string(path.join(name)).unwrap();
    let info: Value = serde_json::from_str(&text("meta/info.json")).unwrap();
    (summary, info["fps"].clone(), text("README.md"))
}

#[test]
fn frames_that_come_evenly_at_a_whole_rate_stay() {
    let (summary, fps, card) = rate(&recording());
    assert_eq!(
        (summary.frames, summary.fps, summary.resampled_from_hz),
        (268, 100, None)
    );
    assert!(
        fps.is_u64() && fps == 100 && !card.contains("resampled"),
        "{card}"
    );
}

#[test]
fn frames_at_another_rate_are_resampled_and_it_is_said() {
    // 55.56 Hz with jitter; readings rise linearly with time, and one second of the second taxel is
    // missing in the middle.
    let mut uneven = recording();
    let press = &mut uneven.presses[0];
    for (frame, time_s) in press.time_s.iter_mut().enumerate() {
        *time_s = 7.0 + 0.018 * (frame as f64 + if frame % 3 == 1 { 0.2 } else { 0.0 });
    }
    for (frame, time_s) in press.time_s.iter().enumerate() {
        press.taxels_kpa[frame] = vec![10.0 * time_s, 1.0];
        press.taxels_raw[frame] = vec![101.0; 2];
        press.valid[frame] = vec![true, !(2.0..3.0).contains(&(time_s - 7.0))];
    }
    let (summary, fps, card) = rate(&uneven);
    assert_eq!((fps, summary.fps), (Value::from(56), 56));
    assert!(
        (summary.resampled_from_hz.unwrap() - 1.0 / 0.018).abs() < 0.01,
        "{summary:?}"
    );
    assert_eq!(summary.frames, (0.018 * 267.0 * 56.0) as usize + 1);
    assert!(
        card.contains("resampled: they came at 55.56 Hz") && card.contains("at 56 Hz"),
        "{card}"
    );
    // One second of the taxel, and at most one more frame at either end.
    let unusable = card
        .split("Taxel S1 has no reading that can be used in ")
        .nth(1)
        .unwrap();
    let unusable: usize = unusable.split(' ').next().unwrap().parse().unwrap();
    assert!((56..=58).contains(&unusable), "{unusable}");
    let (stats, _) = written(&uneven);
    let first = &stats["observation.tactile"];
    assert!((first["min"][0].as_f64().unwrap() - 70.0).abs() < 1e-9, "{first}");
    assert!((stats["timestamp"]["max"][0].as_f64().unwrap() - 269.0 / 56.0).abs() < 1e-9);
}

#[test]
fn a_hole_between_frames_is_not_filled_with_readings() {
    let mut holed = recording();
    let press = &mut holed.presses[0];
    for time_s in &mut press.time_s[200..] {
        *time_s += 0.5;
    }
    let (summary, _, card) = rate(&holed);
    assert_eq!((summary.fps, summary.frames), (100, 318));
    assert!(
        card.contains("Taxel S1 has no reading that can be used in 50 of 318 frames"),
        "{card}"
    );
}
