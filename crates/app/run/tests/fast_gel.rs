//! A fast gel is trained in a folder, taken up again, and makes a run's tables.

#![allow(clippy::unwrap_used)] // a test that cannot set itself up has failed

use std::path::Path;

use twintac_fast::TrainSettings;
use twintac_run::fast::{FAST_GEL, FastSettings, train_fast};
use twintac_run::{Caller, Run, RunSettings, SensorFile, Silent};

/// PhysTac, pressed so little that a lesson is solved at once.
fn shallow() -> SensorFile {
    let text = SensorFile::phystac().unwrap().text;
    let text = text.replace("depth_mm = 5.0", "depth_mm = 0.5");
    SensorFile::parse(Path::new("shallow.toml"), &text).unwrap()
}

#[test]
fn lessons_are_kept_and_tables_follow_from_them() {
    let sensor = shallow();
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    let settings = FastSettings {
        n_lessons: 20,
        n_exams: 2,
        n_slides: 0,
        n_strange: 0,
        own_indenters: true,
        train: TrainSettings {
            n_steps: 200,
            ..TrainSettings::default()
        },
    };
    let train = |seed: u64| train_fast(&sensor, folder, &settings, seed, &Silent);
    let found = train(1).unwrap();
    assert_eq!(found.n_taught + found.held_out.overall.n_frames.min(1), 20);
    assert!(found.exams.overall.nearest_percent < 50.0, "{found:?}");
    let bytes = std::fs::read(folder.join(FAST_GEL)).unwrap();
    assert!(folder.join("judgement.png").exists());

    // A lesson that is there is not solved again: this one is now another.
    let lesson = |number: u32| folder.join(format!("lessons/{number:06}.json"));
    std::fs::copy(lesson(3), lesson(4)).unwrap();
    assert_ne!(train(1).unwrap(), found);
    assert_ne!(std::fs::read(folder.join(FAST_GEL)).unwrap(), bytes);
    let error = train(2).unwrap_err().to_string();
    assert!(error.contains("presses of another seed"), "{error}");

    // A run takes the fast gel of its own sensor, and no other.
    let run = folder.join("run");
    let start = |sensor: SensorFile| {
        let settings = RunSettings {
            fast_gel: Some(folder.join(FAST_GEL)),
            ..RunSettings::default()
        };
        Run::start(&run, sensor, "a test", 1, settings, Caller::default())
    };
    start(sensor.clone()).unwrap();
    assert!(run.join(FAST_GEL).exists());
    let tip = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../../sensors/phystac-tip.toml");
    let tip = SensorFile::read(&tip).unwrap();
    let error = start(tip).unwrap_err().to_string();
    assert!(error.contains("ports are elsewhere"), "{error}");
}
