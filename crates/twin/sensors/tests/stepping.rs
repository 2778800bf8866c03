//! Sensors in a batch give the same readings as alone, and each deviation has the effect that is
//! described.

#![allow(clippy::unwrap_used)] // a test that cannot set itself up has failed

use glam::DVec3;
use proptest::prelude::*;
use twintac_fast::{Body, FastGel, Touch};
use twintac_sensors::{SensorBatch, SensorVariation};
use twintac_shape::{Pose, Shape, Surfaces};

const N_TAXELS: usize = 8;

fn ball() -> Vec<Body> {
    vec![Body::new(&Shape::Sphere { radius_mm: 6.0 }, &Surfaces::new()).unwrap()]
}

fn touch(x_mm: f64, depth_mm: f64) -> Touch {
    Touch {
        body: 0,
        gel_from_body: Pose::from_position(DVec3::new(x_mm, 3.0, 8.5 - depth_mm)),
    }
}

/// Readings of every step. `[n_steps][n_sensors * n_taxels]`
fn readings(
    variation: &SensorVariation,
    n_sensors: usize,
    n_threads: usize,
    seed: u64,
    depth_mm: &[f64],
) -> Vec<Vec<f32>> {
    let gel = FastGel::phystac().unwrap();
    let mut batch = SensorBatch::new(&gel, None, variation.clone(), [n_sensors, n_threads], seed);
    assert_eq!(batch.n_sensors(), n_sensors);
    let ends: Vec<usize> = (1..=n_sensors).collect();
    let bodies = ball();
    let step = |depth_mm: &f64| {
        let touches: Vec<Touch> = (0..n_sensors).map(|_| touch(2.0, *depth_mm)).collect();
        let (mut readings_kpa, mut wrench) = (vec![0.0; n_sensors * N_TAXELS], vec![[0.0; 6]; n_sensors]);
        batch.step(0.01, &bodies, &touches, &ends, &mut readings_kpa, &mut wrench);
        readings_kpa
    };
    depth_mm.iter().map(step).collect()
}

fn all_variations() -> SensorVariation {
    SensorVariation {
        gain_deviation: 0.05,
        growth_deviation_per_kpa: 0.01,
        offset_deviation_kpa: 0.2,
        drift_kpa_per_k: -0.1,
        drift_deviation_kpa_per_k: 0.05,
        temperature_deviation_k: 2.0,
        temperature_time_s: 60.0,
        cross_talk: 0.01,
        cross_talk_deviation: 0.005,
        noise_deviation_kpa: 0.05,
        quantum_kpa: 0.01,
        hysteresis: 0.03,
        dead_chance: 0.05,
        stuck_chance: 0.05,
        late_chance: 0.05,
        rate_hz: 60.0,
        jitter: 0.1,
        modulus_deviation: 0.3,
        height_deviation_mm: 0.05,
        place_deviation_mm: 0.3,
        turn_deviation_rad: 0.01,
        tilt_deviation_rad: 0.01,
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(8))]

    #[test]
    fn bits_do_not_depend_on_the_batch_or_the_threads(
        seed in 0..1000_u64,
        n_sensors in 2..40_usize,
        n_threads in 1..5_usize,
        depth_mm in prop::collection::vec(-0.5..3.0_f64, 1..8),
    ) {
        let variation = all_variations();
        let many = readings(&variation, n_sensors, n_threads, seed, &depth_mm);
        let few = readings(&variation, n_sensors / 2 + 1, 1, seed, &depth_mm);
        for (many, few) in many.iter().zip(&few) {
            prop_assert_eq!(&many[..few.len()], &few[..]);
        }
    }
}

#[test]
fn a_perfect_sensor_reads_the_pressure() {
    let found = readings(&SensorVariation::default(), 1, 1, 1, &[1.0]);
    let (mut pressure_kpa, mut wrench) = ([0.0; N_TAXELS], [0.0; 6]);
    let touch = touch(2.0, 1.0);
    FastGel::phystac().unwrap().reader().read(
        &[(&ball()[0], touch.gel_from_body)],
        &mut pressure_kpa,
        &mut wrench,
    );
    assert_eq!(found[0], pressure_kpa);
}

#[test]
fn widths_are_those_that_were_asked_for() {
    let deviation = |values: &[f64]| {
        let mean = values.iter().sum::<f64>() / values.len() as f64;
        let square = values.iter().map(|value| (value - mean).powi(2)).sum::<f64>();
        (square / values.len() as f64).sqrt()
    };
    let untouched = |variation: SensorVariation| -> Vec<f64> {
        let found = readings(&variation, 500, 1, 3, &[-5.0]);
        found[0].iter().map(|reading| f64::from(*reading)).collect()
    };
    for (variation, expected) in [
        (
            SensorVariation {
                offset_deviation_kpa: 0.4,
                ..SensorVariation::default()
            },
            0.4,
        ),
        (
            SensorVariation {
                noise_deviation_kpa: 0.2,
                ..SensorVariation::default()
            },
            0.2,
        ),
    ] {
        let found = deviation(&untouched(variation));
        assert!((found / expected - 1.0).abs() < 0.05, "{found} {expected}");
    }
    let quantized = untouched(SensorVariation {
        noise_deviation_kpa: 0.5,
        quantum_kpa: 0.25,
        ..SensorVariation::default()
    });
    assert!(quantized.iter().all(|reading| (reading * 4.0).fract() == 0.0));
    let dead = SensorVariation {
        dead_chance: 0.2,
        ..SensorVariation::default()
    };
    let touched = readings(&dead, 500, 1, 3, &[2.0]);
    let perfect = readings(&SensorVariation::default(), 500, 1, 3, &[2.0]);
    let felt = || {
        touched[0]
            .iter()
            .zip(&perfect[0])
            .filter(|(_, perfect)| **perfect != 0.0)
    };
    let part = felt().filter(|(reading, _)| **reading == 0.0).count() as f64 / felt().count() as f64;
    assert!((part - 0.2).abs() < 0.03, "{part}");
}

#[test]
fn all_taxels_drift_alike_and_grow_in_their_own_way() {
    let warm = SensorVariation {
        drift_kpa_per_k: -0.5,
        temperature_deviation_k: 2.0,
        temperature_time_s: 60.0,
        ..SensorVariation::default()
    };
    let found = readings(&warm, 500, 1, 3, &[-5.0]);
    let sensors: Vec<&[f32]> = found[0].chunks(N_TAXELS).collect();
    assert!(
        sensors
            .iter()
            .all(|taxels| taxels.iter().all(|reading| *reading == taxels[0]))
    );
    let square = sensors
        .iter()
        .map(|taxels| f64::from(taxels[0]).powi(2))
        .sum::<f64>();
    assert!(((square / 500.0).sqrt() - 1.0).abs() < 0.1, "{square}");
    let growing = SensorVariation {
        growth_deviation_per_kpa: 0.01,
        ..SensorVariation::default()
    };
    let depths_mm = [1.0, 2.0];
    let perfect = readings(&SensorVariation::default(), 1, 1, 3, &depths_mm);
    let found = readings(&growing, 1, 1, 3, &depths_mm);
    for taxel in 0..N_TAXELS {
        let per_kpa = [0, 1].map(|step: usize| {
            let (perfect_kpa, found_kpa) = (perfect[step][taxel], found[step][taxel]);
            (found_kpa / perfect_kpa - 1.0) / perfect_kpa
        });
        if perfect[0][taxel] > 1.0 {
            assert!(
                per_kpa[0] != 0.0 && (per_kpa[1] / per_kpa[0] - 1.0).abs() < 0.01,
                "{per_kpa:?}"
            );
        }
    }
}

#[test]
fn a_stiffer_gel_presses_back_and_reads_more_by_the_same_factor() {
    let gel = FastGel::phystac().unwrap();
    let n_sensors = 300;
    let [perfect, stiff] = [0.0, 0.4].map(|modulus_deviation| {
        let variation = SensorVariation {
            modulus_deviation,
            ..SensorVariation::default()
        };
        let mut batch = SensorBatch::new(&gel, None, variation, [n_sensors, 1], 3);
        let (mut readings_kpa, mut wrench) = (vec![0.0; n_sensors * N_TAXELS], vec![[0.0; 6]; n_sensors]);
        let ends: Vec<usize> = (1..=n_sensors).collect();
        let touches = vec![touch(2.0, 1.5); n_sensors];
        batch.step(0.01, &ball(), &touches, &ends, &mut readings_kpa, &mut wrench);
        (readings_kpa, wrench)
    });
    let mut logarithms = Vec::new();
    for sensor in 0..n_sensors {
        let factor = stiff.1[sensor][2] / perfect.1[sensor][2];
        let taxels = sensor * N_TAXELS..(sensor + 1) * N_TAXELS;
        let readings = stiff.0[taxels.clone()].iter().zip(&perfect.0[taxels]);
        for (found, before) in readings.chain(stiff.1[sensor].iter().zip(&perfect.1[sensor])) {
            assert!(
                (found - factor * before).abs() <= 1e-5 * found.abs() + 1e-7,
                "{found} {before} {factor}"
            );
        }
        logarithms.push(f64::from(factor).ln());
    }
    let square = logarithms.iter().map(|logarithm| logarithm.powi(2)).sum::<f64>() / n_sensors as f64;
    assert!((square.sqrt() / 0.4 - 1.0).abs() < 0.1, "{square}");
}

#[test]
fn a_part_of_what_the_others_feel_is_read_too() {
    let talking = |cross_talk: f64, cross_talk_deviation: f64| SensorVariation {
        cross_talk,
        cross_talk_deviation,
        ..SensorVariation::default()
    };
    let perfect = &readings(&SensorVariation::default(), 1, 1, 3, &[1.5])[0];
    let all_kpa: f32 = perfect.iter().sum();
    let found = &readings(&talking(0.1, 0.0), 1, 1, 3, &[1.5])[0];
    for (found_kpa, perfect_kpa) in found.iter().zip(perfect) {
        let expected_kpa = perfect_kpa + 0.1 * (all_kpa - perfect_kpa);
        assert!(
            (found_kpa - expected_kpa).abs() < 1e-4,
            "{found_kpa}, not {expected_kpa}"
        );
    }
    // Deviations from pair to pair: over many sensors, the fractions have mean zero and the given
    // standard deviation.
    let of_sensors = &readings(&talking(0.0, 0.02), 500, 1, 3, &[1.5])[0];
    let strongest = (0..N_TAXELS)
        .max_by(|a, b| perfect[*a].total_cmp(&perfect[*b]))
        .unwrap();
    let others = perfect
        .iter()
        .enumerate()
        .filter(|(taxel, _)| *taxel != strongest);
    let expected_kpa = 0.02 * others.map(|(_, kpa)| f64::from(*kpa).powi(2)).sum::<f64>().sqrt();
    let changes: Vec<f64> = of_sensors
        .chunks(N_TAXELS)
        .map(|taxels| f64::from(taxels[strongest] - perfect[strongest]))
        .collect();
    let square = changes.iter().map(|change| change.powi(2)).sum::<f64>() / 500.0;
    assert!(
        (square.sqrt() / expected_kpa - 1.0).abs() < 0.1,
        "{square} {expected_kpa}"
    );
}

#[test]
fn unloading_reads_more_than_loading() {
    let hysteresis = SensorVariation {
        hysteresis: 0.1,
        ..SensorVariation::default()
    };
    let perfect = readings(&SensorVariation::default(), 1, 1, 1, &[1.0, 2.0, 1.0]);
    let found = readings(&hysteresis, 1, 1, 1, &[1.0, 2.0, 1.0]);
    for taxel in 0..N_TAXELS {
        let (perfect_kpa, [up, down]) = (perfect[0][taxel], [0, 2].map(|step: usize| found[step][taxel]));
        if perfect_kpa > 0.5 {
            assert!((up / perfect_kpa - 0.9).abs() < 1e-5, "{up} {perfect_kpa}");
            assert!((down / perfect_kpa - 1.1).abs() < 1e-5, "{down} {perfect_kpa}");
        }
    }
}

#[test]
fn a_slow_bus_repeats_and_a_late_taxel_is_a_frame_behind() {
    let slow = SensorVariation {
        rate_hz: 50.0,
        ..SensorVariation::default()
    };
    let depths_mm = [1.0, 1.2, 1.4, 1.6, 1.8];
    let perfect = readings(&SensorVariation::default(), 1, 1, 1, &depths_mm);
    let found = readings(&slow, 1, 1, 1, &depths_mm);
    for (step, delivered) in [0, 0, 2, 2, 4].into_iter().enumerate() {
        assert_eq!(found[step], perfect[delivered], "step {step}");
    }
    let late = SensorVariation {
        late_chance: 1.0,
        ..SensorVariation::default()
    };
    let found = readings(&late, 1, 1, 1, &depths_mm);
    assert_eq!(found[0], [0.0; N_TAXELS]);
    assert_eq!(found[1..], perfect[..4]);
}

#[test]
fn the_ground_truth_has_no_variation() {
    let gel = FastGel::phystac().unwrap();
    let step = |batch: &mut SensorBatch| {
        let (mut readings_kpa, mut wrench) = (vec![0.0; 3 * N_TAXELS], vec![[0.0; 6]; 3]);
        let touches: Vec<Touch> = (0..3).map(|number| touch(f64::from(number), 1.0)).collect();
        batch.step(
            0.01,
            &ball(),
            &touches,
            &[1, 2, 3],
            &mut readings_kpa,
            &mut wrench,
        );
        readings_kpa
    };
    let noisy = SensorVariation {
        gain_deviation: 0.1,
        noise_deviation_kpa: 0.1,
        ..SensorVariation::default()
    };
    let mut imperfect = SensorBatch::new(&gel, None, noisy, [3, 2], 1);
    let mut perfect = SensorBatch::new(&gel, None, SensorVariation::default(), [3, 2], 1);
    let expected = step(&mut perfect);
    assert_ne!(step(&mut imperfect), expected);
    assert_eq!(imperfect.ground_truth_kpa().collect::<Vec<f32>>(), expected);
}

#[test]
fn a_replaced_sensor_is_the_one_of_its_number() {
    let gel = FastGel::phystac().unwrap();
    let (bodies, variation) = (ball(), all_variations());
    let mut batch = SensorBatch::new(&gel, None, variation.clone(), [3, 2], 9);
    let mut other = SensorBatch::new(&gel, None, variation, [8, 1], 9);
    batch.replace(1, 7);
    let step = |batch: &mut SensorBatch| {
        let n = batch.n_sensors();
        let (touches, ends) = (vec![touch(0.0, 1.5); n], (1..=n).collect::<Vec<_>>());
        let (mut readings_kpa, mut wrench) = (vec![0.0; n * N_TAXELS], vec![[0.0; 6]; n]);
        batch.step(0.01, &bodies, &touches, &ends, &mut readings_kpa, &mut wrench);
        readings_kpa
    };
    assert_eq!(
        step(&mut batch)[N_TAXELS..2 * N_TAXELS],
        step(&mut other)[7 * N_TAXELS..]
    );
}

#[test]
fn to_stay_is_to_be_touched_in_the_same_way() {
    let gel = FastGel::phystac().unwrap();
    let (bodies, touches, ends) = (ball(), vec![touch(2.0, 1.5); 3], [1, 2, 3]);
    let stepped = |n_threads: usize, stays: bool| {
        let mut batch = SensorBatch::new(&gel, None, all_variations(), [3, n_threads], 5);
        let (mut readings_kpa, mut wrench) = (vec![0.0; 3 * N_TAXELS], vec![[0.0; 6]; 3]);
        batch.step(0.01, &bodies, &touches, &ends, &mut readings_kpa, &mut wrench);
        for _ in 0..4 {
            if stays {
                batch.stay(0.02, &mut readings_kpa);
            } else {
                batch.step(0.02, &bodies, &touches, &ends, &mut readings_kpa, &mut wrench);
            }
        }
        readings_kpa
    };
    assert_eq!(stepped(1, true), stepped(1, false));
    assert_eq!(stepped(2, true), stepped(1, false));
}
