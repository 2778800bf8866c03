//! Runs the examples.

#![allow(clippy::unwrap_used)] // a test that cannot set itself up has failed
#![allow(dead_code, unreachable_pub)] // each example has a `main` of its own

use twintac::SensorVariation;

#[path = "../examples/predict_along_a_press.rs"]
mod predict_along_a_press;
#[path = "../examples/press_a_ball.rs"]
mod press_a_ball;
#[path = "../examples/read_a_sensor.rs"]
mod read_a_sensor;
#[path = "../examples/step_a_twin.rs"]
mod step_a_twin;
#[path = "../examples/touch_for_learning.rs"]
mod touch_for_learning;
#[path = "../examples/train_from_csv.rs"]
mod train_from_csv;

#[test]
fn a_ball_is_pressed() {
    press_a_ball::main().unwrap();
}

#[test]
fn a_sensor_is_read() {
    read_a_sensor::read(None, None).unwrap();
}

#[test]
fn a_thousand_sensors_feel_what_presses_them() {
    let variation = SensorVariation {
        gain_deviation: 0.05,
        ..SensorVariation::default()
    };
    let read = |variation: SensorVariation| touch_for_learning::step(variation, 2).unwrap().0;
    let [perfect_kpa, imperfect_kpa] = [SensorVariation::default(), variation].map(read);
    assert_ne!(perfect_kpa, imperfect_kpa);
    for readings_kpa in perfect_kpa.chunks_exact(8).chain(imperfect_kpa.chunks_exact(8)) {
        let largest = readings_kpa.iter().copied().fold(f32::NEG_INFINITY, f32::max);
        assert!((0.5..50.0).contains(&largest), "{readings_kpa:?}");
    }
}

#[test]
fn a_twin_is_trained_and_predicts() {
    let folder = tempfile::tempdir().unwrap();
    let metrics = train_from_csv::train(folder.path()).unwrap();
    let figures = [&metrics.twin.overall, &metrics.baselines.zero];
    let [twin, zero] = figures.map(|figures| figures.nearest_in_contact_percent.unwrap());
    assert!(twin < 0.5 * zero);
    let predicted = predict_along_a_press::predict(&folder.path().join("model")).unwrap();
    let loudest = |row: &Vec<f64>| row.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    let held = predicted.readings_kpa.len() / 2;
    assert!(loudest(&predicted.readings_kpa[held]) > 1.0, "{predicted:?}");
    let pressed_kpa = step_a_twin::step(&folder.path().join("model")).unwrap();
    assert!(loudest(&pressed_kpa) > 1.0, "{pressed_kpa:?}");
}
