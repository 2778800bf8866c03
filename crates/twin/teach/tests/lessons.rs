//! Presses are reproducible, and the built-in surrogate agrees with test presses.

#![allow(clippy::unwrap_used)] // a test that cannot set itself up has failed

use twintac_fast::{FastGel, lesson_places_mm};
use twintac_sensor::SensorFile;
use twintac_teach::{Teacher, exam_surfaces};

#[test]
fn the_built_in_gel_agrees_with_presses_that_it_was_not_taught() {
    let sensor = SensorFile::phystac().unwrap().sensor;
    let teacher = Teacher::new(&sensor, &lesson_places_mm(&sensor)).unwrap();
    let exams: Vec<_> = (0..4).map(|number| teacher.exam(2, number).unwrap()).collect();
    let judged = FastGel::phystac()
        .unwrap()
        .judge(&exams, &exam_surfaces().unwrap())
        .unwrap();
    let overall = judged.overall.unwrap();
    assert!(overall.n_frames > 15, "{judged:?}");
    assert!(overall.nearest_percent < 4.0, "{judged:?}");
    assert!(overall.force_percent < 6.0, "{judged:?}");
}

#[test]
fn a_number_is_a_lesson() {
    let sensor = SensorFile::phystac().unwrap().sensor;
    let teacher = Teacher::new(&sensor, &lesson_places_mm(&sensor)[..8]).unwrap();
    let lesson = teacher.lesson(1, 5).unwrap();
    assert_eq!(teacher.lesson(1, 5).unwrap(), lesson);
    assert_ne!(teacher.lesson(1, 6).unwrap().shape, lesson.shape);
    assert_ne!(teacher.exam(1, 5).unwrap().shape, lesson.shape);
    let slide = teacher.slide(1, 0).unwrap();
    let [down, after] = [4, 5].map(|frame: usize| slide.frames[frame].gel_from_indenter.position_mm);
    assert!((down - after).truncate().length() > 0.3 && down.z == after.z);
}
