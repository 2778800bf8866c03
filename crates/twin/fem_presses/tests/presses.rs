//! Presses are reproducible, and the built-in surrogate agrees with test presses.

#![allow(clippy::unwrap_used)] // a test that cannot set itself up has failed

use twintac_fast::{FastGel, training_places_mm};
use twintac_fem_presses::{FemPresses, test_surfaces};
use twintac_sensor::SensorFile;

#[test]
fn the_built_in_surrogate_agrees_with_presses_that_it_was_not_trained_on() {
    let sensor = SensorFile::phystac().unwrap().sensor;
    let fem_presses = FemPresses::new(&sensor, &training_places_mm(&sensor)).unwrap();
    let test_presses: Vec<_> = (0..4)
        .map(|number| fem_presses.test_press(2, number).unwrap())
        .collect();
    let evaluation = FastGel::phystac()
        .unwrap()
        .evaluate(&test_presses, &test_surfaces().unwrap())
        .unwrap();
    let overall = evaluation.overall.unwrap();
    assert!(overall.n_frames > 15, "{evaluation:?}");
    assert!(overall.nearest_percent < 4.0, "{evaluation:?}");
    assert!(overall.force_percent < 6.0, "{evaluation:?}");
}

#[test]
fn a_number_is_a_press() {
    let sensor = SensorFile::phystac().unwrap().sensor;
    let fem_presses = FemPresses::new(&sensor, &training_places_mm(&sensor)[..8]).unwrap();
    let press = fem_presses.training_press(1, 5).unwrap();
    assert_eq!(fem_presses.training_press(1, 5).unwrap(), press);
    assert_ne!(fem_presses.training_press(1, 6).unwrap().shape, press.shape);
    assert_ne!(fem_presses.test_press(1, 5).unwrap().shape, press.shape);
    let slide = fem_presses.slide(1, 0).unwrap();
    let [down, after] = [4, 5].map(|frame: usize| slide.frames[frame].gel_from_indenter.position_mm);
    assert!((down - after).truncate().length() > 0.3 && down.z == after.z);
}
