//! Readings of the surrogate lead back to the contact that caused them.

#![allow(clippy::unwrap_used)] // also in the helpers of tests

use std::f64::consts::PI;
use std::sync::LazyLock;

use glam::DVec2;
use rand::Rng;
use twintac_config::Checked;
use twintac_fast::FastGel;
use twintac_inverse::{
    ContactModel, FastModel, Inverse, InverseError, InverseSettings, KnownShape, Press, ReadingTable,
    TableModel,
};
use twintac_random::{normal, stream};
use twintac_shape::{Shape, Surfaces};

const EDGE_MM: f64 = 0.8;

/// Settings for a forward model without error: all residuals are noise.
fn settings() -> InverseSettings {
    InverseSettings {
        noise_kpa: 0.1,
        model_part: 0.0,
        model_part_of_largest: 0.0,
        force_part: 0.0,
        ..InverseSettings::default()
    }
}

fn shapes() -> Vec<KnownShape> {
    let known = |name: &str, shape| KnownShape {
        name: name.into(),
        shape,
    };
    let ball = Shape::Sphere { radius_mm: 5.0 };
    let bar = Shape::Box {
        size_mm: [14.0, 5.0, 10.0],
        edge_radius_mm: EDGE_MM,
    };
    let ring = Shape::Ring {
        outer_radius_mm: 7.0,
        inner_radius_mm: 4.0,
        height_mm: 10.0,
        edge_radius_mm: EDGE_MM,
    };
    vec![known("ball", ball), known("bar", bar), known("ring", ring)]
}

static KNOWN: LazyLock<Inverse<FastModel>> = LazyLock::new(|| {
    let gel = FastGel::phystac().unwrap();
    Inverse::of_fast_gel(&gel, &shapes(), &Surfaces::new(), settings()).unwrap()
});

/// The readings of a press, kPa, and its force, N.
fn read(shape: usize, press: &Press) -> ([f64; 8], f64) {
    let mut readings_kpa = [0.0; 8];
    let force_n = KNOWN.model().clone().read(shape, press, &mut readings_kpa);
    (readings_kpa.map(f64::from), force_n)
}

fn noisy(readings_kpa: [f64; 8], random: &mut impl Rng) -> [f64; 8] {
    readings_kpa.map(|reading_kpa| reading_kpa + normal(random, 0.1))
}

/// A random press over the taxels.
fn drawn(random: &mut impl Rng) -> Press {
    Press {
        place_mm: DVec2::new(random.random_range(-10.0..10.0), random.random_range(-4.0..4.0)),
        depth_mm: random.random_range(1.0..3.0),
        yaw_rad: random.random_range(0.0..PI),
    }
}

#[test]
fn place_depth_force_and_shape_are_found() {
    let random = &mut stream(1, "presses of a test");
    let (mut n_told, mut n_within, mut place_errors_mm) = (0, 0, Vec::new());
    for number in 0..60 {
        let (shape, press) = (number % 3, drawn(random));
        let (readings_kpa, force_n) = read(shape, &press);
        let mut tracker = KNOWN.start();
        for _ in 0..30 {
            tracker.update(0.02, &noisy(readings_kpa, random)).unwrap();
        }
        let contact = tracker
            .update(0.02, &noisy(readings_kpa, random))
            .unwrap()
            .unwrap();
        assert!((contact.shape_probabilities.iter().sum::<f64>() - 1.0).abs() < 1e-9);
        if contact.shape != shape {
            // A bar across the sensor gives nearly the readings of a ball.
            continue;
        }
        n_told += 1;
        let (error, deviation) = (contact.place_mm - press.place_mm, contact.place_deviation_mm);
        let turn = if shape == 1 {
            contact.yaw_rad - press.yaw_rad
        } else {
            0.0
        };
        let errors = [
            (error.x, deviation.x),
            (error.y, deviation.y),
            (contact.depth_mm - press.depth_mm, contact.depth_deviation_mm),
            (contact.force_n - force_n, contact.force_deviation_n),
            (turn - PI * (turn / PI).round(), contact.yaw_deviation_rad + 1e-9),
        ];
        n_within += usize::from(
            errors
                .iter()
                .all(|(error, deviation)| error.abs() < 4.0 * deviation),
        );
        place_errors_mm.push(error.length());
    }
    place_errors_mm.sort_by(f64::total_cmp);
    assert!(place_errors_mm[n_told / 2] < 0.15, "{place_errors_mm:?}");
    // A bar near an edge that is rotated and moved together gives nearly the same readings, and the
    // estimated deviations are too small there.
    assert!(
        n_within + 3 >= n_told,
        "{n_within} of {n_told} within four deviations"
    );
    assert!(n_told >= 50, "{n_told} of 60 shapes told");
}

#[test]
fn errors_are_as_large_as_is_said() {
    let gel = FastGel::phystac().unwrap();
    // Each frame is solved by itself until it converges, so that the errors of frames are
    // independent.
    let alone = InverseSettings {
        correlated_s: 1e-3,
        n_steps: 8,
        ..settings()
    };
    let inverse = Inverse::of_fast_gel(&gel, &shapes()[..1], &Surfaces::new(), alone).unwrap();
    let random = &mut stream(2, "presses of a test");
    let mut over_deviation: [Vec<f64>; 4] = Default::default();
    for _ in 0..150 {
        let press = Press {
            place_mm: DVec2::new(random.random_range(-10.0..10.0), random.random_range(-4.0..4.0)),
            depth_mm: random.random_range(0.8..3.0),
            yaw_rad: 0.0,
        };
        let (readings_kpa, force_n) = read(0, &press);
        let mut tracker = inverse.start();
        let contact = tracker
            .update(1.0, &noisy(readings_kpa, random))
            .unwrap()
            .unwrap();
        let error = contact.place_mm - press.place_mm;
        let deviation = contact.place_deviation_mm;
        over_deviation[0].push(error.x / deviation.x);
        over_deviation[1].push(error.y / deviation.y);
        over_deviation[2].push((contact.depth_mm - press.depth_mm) / contact.depth_deviation_mm);
        over_deviation[3].push((contact.force_n - force_n) / contact.force_deviation_n);
    }
    for (number, errors) in over_deviation.iter().enumerate() {
        let within = |deviations: f64| {
            let n = errors.iter().filter(|error| error.abs() < deviations).count();
            n as f64 / errors.len() as f64
        };
        assert!(
            (0.55..0.85).contains(&within(1.0)),
            "{number}: {} within one",
            within(1.0)
        );
        assert!(within(2.0) > 0.88, "{number}: {} within two", within(2.0));
    }
}

#[test]
fn nothing_touches_an_untouched_sensor() {
    let random = &mut stream(3, "noise of a test");
    let mut tracker = KNOWN.start();
    for _ in 0..2000 {
        assert_eq!(tracker.update(0.001, &noisy([0.0; 8], random)), Ok(None));
    }
    let press = Press {
        depth_mm: 1.0,
        ..Press::default()
    };
    assert!(tracker.update(0.001, &read(0, &press).0).unwrap().is_some());
    assert_eq!(tracker.update(0.001, &noisy([0.0; 8], random)), Ok(None));
}

#[test]
fn a_contact_that_slides_is_followed() {
    let random = &mut stream(4, "noise of a test");
    let mut tracker = KNOWN.start();
    let mut farthest_mm: f64 = 0.0;
    for frame in 0..1000 {
        let at = f64::from(frame) / 1000.0;
        let press = Press {
            place_mm: DVec2::new(-8.0 + 16.0 * at, 3.0 - 6.0 * at),
            depth_mm: 1.5 + at,
            yaw_rad: 0.0,
        };
        let contact = tracker
            .update(0.002, &noisy(read(0, &press).0, random))
            .unwrap()
            .unwrap();
        // At first it may be taken for another shape at another location.
        if frame > 300 {
            farthest_mm = farthest_mm.max(contact.place_mm.distance(press.place_mm));
        }
    }
    assert!(farthest_mm < 0.6, "{farthest_mm} mm");
}

#[test]
fn the_floor_is_highest_below_the_contact() {
    let press = Press {
        place_mm: DVec2::new(-3.0, 1.0),
        depth_mm: 2.0,
        yaw_rad: 0.0,
    };
    let mut tracker = KNOWN.start();
    let (readings_kpa, _) = read(0, &press);
    for _ in 0..20 {
        tracker.update(0.1, &readings_kpa).unwrap();
    }
    let contact = tracker.update(0.1, &readings_kpa).unwrap().unwrap();
    let mut map = KNOWN.floor_map(0.5).unwrap();
    assert_eq!(map.n(), [64, 32]);
    let floor_kpa = map.read(contact).to_vec();
    let largest = (0..floor_kpa.len())
        .max_by(|a, b| floor_kpa[*a].total_cmp(&floor_kpa[*b]))
        .unwrap();
    let at = map.place_mm(largest % 64, largest / 64);
    assert!(at.distance(press.place_mm) < 1.0, "{at}");
    // The rows at the sides, 7 and 9 mm away, have less than half of it.
    let sides = floor_kpa[..64].iter().chain(&floor_kpa[64 * 31..]);
    let most_kpa = sides.copied().fold(0.0, f32::max);
    assert!(most_kpa < 0.5 * floor_kpa[largest], "{most_kpa}");
}

#[test]
fn what_is_too_large_to_be_searched_is_an_error() {
    let floor = FastGel::phystac()
        .unwrap()
        .with_ports(&vec![DVec2::ZERO; 1_000_000])
        .unwrap();
    let error = Inverse::of_fast_gel(&floor, &shapes(), &Surfaces::new(), settings()).unwrap_err();
    assert!(
        matches!(
            error,
            InverseError::TooLarge {
                readings: 1_000_000,
                ..
            }
        ),
        "{error}"
    );
    let far = ReadingTable {
        first_mm: [0.0; 3],
        step_mm: [1e12, 1.0, 1.0],
        n: [2, 1, 1],
        readings_kpa: vec![vec![1.0]; 2],
        force_n: vec![1.0; 2],
    };
    let error = Inverse::new(TableModel::new(vec![far]), settings()).unwrap_err();
    assert!(
        matches!(error, InverseError::TooLarge { readings: 1, .. }),
        "{error}"
    );
}

#[test]
fn what_cannot_be_is_an_error() {
    let gel = FastGel::phystac().unwrap();
    let new =
        |shapes: &[KnownShape], settings| Inverse::of_fast_gel(&gel, shapes, &Surfaces::new(), settings);
    assert_eq!(new(&[], settings()).unwrap_err(), InverseError::NoShape);
    for (field, wrong) in [
        ("noise_kpa", serde_json::json!({"noise_kpa": 0.0})),
        ("deepest_mm", serde_json::json!({"deepest_mm": -1.0})),
        ("deepest_mm", serde_json::json!({"deepest_mm": 1000.0})),
        ("n_starts", serde_json::json!({"n_starts": 0})),
        ("n_starts", serde_json::json!({"n_starts": 1_000_000_000_000_u64})),
        ("n_steps", serde_json::json!({"n_steps": 101})),
        ("model_part", serde_json::json!({"model_part": -0.01})),
        (
            "model_part_of_largest",
            serde_json::json!({"model_part_of_largest": -0.01}),
        ),
        ("force_part", serde_json::json!({"force_part": -0.01})),
        ("place_walk_mm", serde_json::json!({"place_walk_mm": -3.0})),
        ("depth_walk_mm", serde_json::json!({"depth_walk_mm": -3.0})),
        ("yaw_walk_rad", serde_json::json!({"yaw_walk_rad": -3.0})),
    ] {
        let settings: InverseSettings = serde_json::from_value(wrong).unwrap();
        let error = new(&shapes(), settings).unwrap_err();
        assert!(
            matches!(&error, InverseError::Setting(problem) if problem.field == field),
            "{error}"
        );
    }
    let endless = InverseSettings {
        place_walk_mm: f64::INFINITY,
        correlated_s: f64::NAN,
        ..settings()
    };
    let error = new(&shapes(), endless).unwrap_err().to_string();
    assert!(error.contains("`correlated_s` is NaN"), "{error}");
    for spacing_mm in [0.0, -1.0, f64::NAN, f64::INFINITY, 1e-3] {
        let error = KNOWN.floor_map(spacing_mm).unwrap_err().to_string();
        assert!(error.contains("`spacing_mm`"), "{error}");
    }
}

/// Every setting in turn is set to absurd values. Each is either accepted with a meaning, or
/// refused with its name.
#[test]
fn every_setting_has_a_range() {
    let accepts_zero = [
        "model_part",
        "model_part_of_largest",
        "force_part",
        "place_walk_mm",
        "depth_walk_mm",
        "yaw_walk_rad",
    ];
    let defaults = serde_json::to_value(InverseSettings::default()).unwrap();
    for (field, default) in defaults.as_object().unwrap() {
        let mut tried = vec![serde_json::json!(0)];
        if default.is_f64() {
            tried.extend([-1.0, 1e300, 1e-300].map(|number| serde_json::json!(number)));
        } else {
            tried.push(serde_json::json!(u64::MAX));
        }
        for number in tried {
            let mut changed = defaults.clone();
            changed[field] = number.clone();
            let settings: InverseSettings = serde_json::from_value(changed).unwrap();
            match settings.checked() {
                Ok(()) => assert!(
                    number == 0 && accepts_zero.contains(&&field[..]),
                    "{field} = {number}"
                ),
                Err(problem) => assert_eq!(problem.field, *field),
            }
        }
    }
}

#[test]
fn a_frame_that_cannot_be_is_refused_and_the_contact_goes_on_as_if_it_had_not_come() {
    let press = Press {
        place_mm: DVec2::new(3.0, -1.0),
        depth_mm: 1.5,
        yaw_rad: 0.0,
    };
    let good = read(0, &press).0;
    let (mut tracker, mut other) = (KNOWN.start(), KNOWN.start());
    for frame in 0..5 {
        for (taxel, bad) in [f64::NAN, f64::INFINITY, 1e39, -1e300].into_iter().enumerate() {
            let mut wrong = good;
            wrong[taxel] = bad;
            let error = tracker.update(0.02, &wrong).unwrap_err();
            let InverseError::Frame(problem) = &error else {
                panic!("{error}")
            };
            assert_eq!(problem.field, format!("readings_kpa[{taxel}]"));
        }
        for (since_s, readings_kpa) in [(-0.1, &good[..]), (f64::NAN, &good[..]), (0.02, &good[..3])] {
            assert!(tracker.update(since_s, readings_kpa).is_err());
        }
        let (found, expected) = (tracker.update(0.02, &good), other.update(0.02, &good));
        assert_eq!(found, expected, "frame {frame}");
        assert!(found.unwrap().is_some());
    }
}
