//! A surrogate is trained in a folder, the training is repeated, and the surrogate makes a run's
//! tables.

#![allow(clippy::unwrap_used)] // a test that cannot set itself up has failed

use std::path::{Path, PathBuf};

use twintac_fast::TrainSettings;
use twintac_run::{Run, RunSettings};
use twintac_sensor::SensorFile;
use twintac_surrogate::{FastResult, FastSettings, train_fast};
use twintac_tables::FAST_GEL;
use twintac_work::Caller;

/// PhysTac with so small a depth limit that a training press is solved at once.
fn shallow() -> SensorFile {
    let text = SensorFile::phystac().unwrap().text;
    let text = text.replace("depth_mm = 5.0", "depth_mm = 0.5");
    SensorFile::parse(Path::new("shallow.toml"), &text).unwrap()
}

#[test]
fn training_presses_are_kept_and_tables_follow_from_them() {
    let sensor = shallow();
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    let settings = FastSettings {
        n_training_presses: 20,
        n_test_presses: 2,
        n_slides: 0,
        n_ood: 0,
        own_indenters: true,
        train: TrainSettings {
            n_steps: 200,
            ..TrainSettings::default()
        },
    };
    let train = |seed: u64| train_fast(&sensor, folder, &settings, seed, &Caller::default());
    let found = train(1).unwrap();
    // Of few training presses, one in five is held out.
    assert_eq!(found.n_trained_on, 16);
    assert!(
        found.held_out.overall.unwrap().nearest_percent < 50.0,
        "{found:?}"
    );
    let bytes = std::fs::read(folder.join(FAST_GEL)).unwrap();
    assert!(folder.join("evaluation.png").exists());

    // The fields' former names are read as well.
    let mut former = std::fs::read_to_string(folder.join("evaluation.json")).unwrap();
    for (name, former_name) in [
        ("n_trained_on", "n_taught"),
        ("test_presses", "exams"),
        ("out_of_distribution", "strange"),
        ("by_ood_score", "by_novelty"),
    ] {
        assert!(former.contains(name), "{name}");
        former = former.replace(&format!("\"{name}\":"), &format!("\"{former_name}\":"));
    }
    assert_eq!(serde_json::from_str::<FastResult>(&former).unwrap(), found);

    // A training press that exists is not solved again; a damaged one is.
    let presses = || {
        std::fs::read_dir(folder.join("presses"))
            .unwrap()
            .map(|entry| entry.unwrap().path())
    };
    let when = |path: &PathBuf| std::fs::metadata(path).unwrap().modified().unwrap();
    let before: Vec<_> = presses().map(|path| (when(&path), path)).collect();
    let (_, damaged) = &before[0];
    let text = std::fs::read_to_string(damaged).unwrap();
    std::fs::write(damaged, text.replacen('1', "2", 40)).unwrap();
    assert_eq!(train(1).unwrap(), found);
    assert_eq!(std::fs::read(folder.join(FAST_GEL)).unwrap(), bytes);
    assert_eq!(std::fs::read_to_string(damaged).unwrap(), text);
    assert!(before[1..].iter().all(|(earlier, path)| when(path) == *earlier));

    // Presses of another seed have files of their own.
    assert_ne!(train(2).unwrap(), found);
    assert_eq!(presses().count(), 2 * before.len());
    assert_eq!(train(1).unwrap(), found);

    // A run accepts the surrogate of its own sensor, and no other.
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
    assert!(error.contains("port 0: at [-12, -4, 0] mm"), "{error}");
}
