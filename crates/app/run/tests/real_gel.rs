//! Regression test of the headline figure on a real gel: a twin of the urethane strip, trained and
//! evaluated as `reproduce` does, without perceptrons.

#![allow(clippy::unwrap_used, clippy::print_stderr)] // also in the helpers of tests

use std::path::{Path, PathBuf};

use digitac::{BenchSettings, TrainSettings, Variant};
use twintac_model::Locator;
use twintac_run::{Run, RunSettings, read_recordings};
use twintac_sensor::SensorFile;
use twintac_work::{Caller, Silent};

/// Largest accepted error of the nearest taxel in contact, % of each file's largest reading. The
/// parametric baseline has 1.0, and predicting zero 48.
const LARGEST_PERCENT: f64 = 1.2;

/// Largest accepted medians of the errors of contact estimation from readings: location, mm, and
/// depth, % of each press's deepest.
const LARGEST_PLACE_MM: f64 = 0.4;
const LARGEST_DEPTH_PERCENT: f64 = 4.0;

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
            variants: Some(vec![Variant::PressureMemory]),
            ..TrainSettings::default()
        },
        ..RunSettings::default()
    };
    let sensor = SensorFile::read(&root().join("sensors/strip4-gel-d.toml")).unwrap();
    let folder = tempfile::tempdir().unwrap();
    let run = Run::start(folder.path(), sensor, "gel D", 1, settings, Caller::default()).unwrap();
    run.import(&root().join("imports/strip4.toml"), &files).unwrap();
    let metrics = run.finish().unwrap();
    let percent = metrics.twin.overall.nearest_in_contact_percent.unwrap();
    assert!(percent < LARGEST_PERCENT, "{percent} %");
    assert_eq!(metrics.twin.frames_not_simulated, 0);
    finds_places_and_depths(folder.path());
}

/// Test presses are located from their readings, frame by frame, and the errors are known.
fn finds_places_and_depths(run: &Path) {
    let settings = Locator::settings(None).unwrap();
    let locator = Locator::open(&run.join("training/held-out"), &[], settings, &Silent).unwrap();
    let recording = read_recordings(&[run.join("recordings/presses.parquet")]).unwrap();
    let found = locator.locate(&recording).unwrap();
    let errors = found.unseen.unwrap();
    assert!(errors.presses >= 10 && errors.frames > 1000, "{errors:?}");
    assert!(errors.frames_missed * 50 < errors.frames, "{errors:?}");
    let is_below = |median: Option<f64>, largest: f64| assert!(median.unwrap() < largest, "{errors:?}");
    is_below(errors.place_mm.median, LARGEST_PLACE_MM);
    is_below(errors.depth_percent.median, LARGEST_DEPTH_PERCENT);
    is_below(errors.depth_at_peak_percent.median, LARGEST_DEPTH_PERCENT);
    let within = [
        errors.place_within_two_deviations_percent,
        errors.depth_within_two_deviations_percent,
    ];
    assert!(within.iter().all(|percent| percent.unwrap() > 80.0), "{errors:?}");
    // Away from the gel, no contact is found.
    let frames = found.presses.iter().flat_map(|press| &press.frames);
    let above: Vec<_> = frames
        .filter(|frame| frame.true_depth_mm.is_some_and(|depth_mm| depth_mm < -1.0))
        .collect();
    let n_found = above.iter().filter(|frame| frame.place_mm.is_some()).count();
    assert!(
        n_found * 50 < above.len(),
        "{n_found} of {} frames above the gel",
        above.len()
    );
}
