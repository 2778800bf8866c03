//! The headline on a real gel, guarded: a twin of the urethane strip, made and judged as `reproduce` does, without perceptrons.

#![allow(clippy::unwrap_used, clippy::print_stderr)] // also in the helpers of tests

use std::path::{Path, PathBuf};

use digitac::{BenchSettings, TrainSettings, Variant};
use twintac_run::{Caller, Run, RunSettings, SensorFile};

/// Largest error of the nearest taxel in contact, % of each file's largest reading. A curve without physics has 1.0, predicting nothing 48.
const LARGEST_PERCENT: f64 = 1.2;

fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../../..")
}

#[test]
fn a_twin_of_a_real_gel_stays_under_its_error() {
    let recordings = root().join("../shared/data/strip4");
    let Ok(folder) = std::fs::read_dir(&recordings) else {
        eprintln!("skipped: {} is not there", recordings.display());
        return;
    };
    let mut files: Vec<PathBuf> = folder
        .map(|entry| entry.unwrap().path())
        .filter(|path| {
            path.file_name()
                .unwrap()
                .to_string_lossy()
                .starts_with("gelD_test_")
        })
        .collect();
    files.sort();
    assert_eq!(files.len(), 3, "{files:?}");
    let settings = RunSettings {
        bench: BenchSettings {
            n_blocks: 0,
            ..BenchSettings::default()
        },
        train: TrainSettings {
            variants: vec![Variant::PressureMemory],
            ..TrainSettings::default()
        },
        ..RunSettings::default()
    };
    let sensor = SensorFile::read(&root().join("sensors/strip4-gel-d.toml")).unwrap();
    let folder = tempfile::tempdir().unwrap();
    let run = Run::start(folder.path(), sensor, "gel D", 1, settings, Caller::default()).unwrap();
    run.import(&root().join("imports/strip4.toml"), &files).unwrap();
    let metrics = run.finish().unwrap();
    let percent = metrics.twin.overall.nearest_in_contact_percent;
    assert!(percent < LARGEST_PERCENT, "{percent} %");
    assert_eq!(metrics.twin.frames_not_simulated, 0);
}
