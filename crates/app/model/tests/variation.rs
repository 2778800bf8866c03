//! Sensors with known variation are drawn, pressed and recorded, and the variation is estimated
//! from the recordings.

#![allow(clippy::unwrap_used)] // also in the helpers of tests

use std::path::Path;

use glam::DVec3;
use twintac_fast::{Body, FastGel, Touch};
use twintac_model::{FoundVariation, VariationSources, find_variation};
use twintac_recorded::Recorded;
use twintac_recording::{Control, Press, Provenance, Recording};
use twintac_sensor::SensorFile;
use twintac_sensors::{SensorBatch, SensorVariation};
use twintac_shape::Pose;

const STEP_S: f64 = 0.001;
/// Time without contact before and after a press, s.
const REST_S: f64 = 1.0;
const SPEED_MM_PER_S: f64 = 0.5;
const DEPTH_MM: f64 = 1.5;

/// Height above the gel at a time, mm: down from 1 mm above, and up again.
fn height_mm(time_s: f64) -> f64 {
    let down_s = (1.0 + DEPTH_MM) / SPEED_MM_PER_S;
    let from_turn_s = (time_s - REST_S - down_s).abs().min(down_s);
    from_turn_s * SPEED_MM_PER_S - DEPTH_MM
}

/// Recordings of a sensor with this variation, pressed slowly above each taxel.
fn recorded(variation: &SensorVariation, sensor: &SensorFile, seed: u64) -> Recorded {
    let sensor = &sensor.sensor;
    let indenter = sensor.indenter("sphere-25").unwrap();
    let body = [Body::new(&indenter.shape, &sensor.surfaces).unwrap()];
    let gel = FastGel::phystac().unwrap();
    let n_taxels = sensor.taxels.len();
    let mut batch = SensorBatch::new(&gel, None, variation.clone(), [1, 1], seed);
    let top_mm = sensor
        .gel
        .solid
        .top_height_mm(0.0, 0.0, &sensor.surfaces)
        .unwrap();
    let presses = sensor.taxels.iter().map(|taxel| {
        batch.rest(0);
        let mut press = Press {
            name: format!("{}#1", taxel.name),
            mounting: "drawn".into(),
            indenter: "sphere-25".into(),
            control: Control::Pose,
            time_s: Vec::new(),
            gel_from_indenter: Vec::new(),
            force_n: Some(Vec::new()),
            taxels_kpa: Vec::new(),
            temperature_c: None,
            taxels_raw: Vec::new(),
            valid: Vec::new(),
        };
        let (mut readings_kpa, mut wrench) = (vec![0.0_f32; n_taxels], [[0.0_f32; 6]]);
        let n_steps = ((2.0 * REST_S + 2.0 * (1.0 + DEPTH_MM) / SPEED_MM_PER_S) / STEP_S) as usize;
        for step in 0..n_steps {
            let time_s = step as f64 * STEP_S;
            let at_mm = DVec3::new(
                taxel.position_mm.x,
                taxel.position_mm.y,
                top_mm + height_mm(time_s),
            );
            let touch = [Touch {
                body: 0,
                gel_from_body: Pose::from_position(at_mm),
            }];
            let before_kpa = readings_kpa.clone();
            batch.step(STEP_S, &body, &touch, &[1], &mut readings_kpa, &mut wrench);
            if readings_kpa == before_kpa {
                continue; // the bus has delivered nothing new
            }
            let row: Vec<f64> = readings_kpa.iter().map(|kpa| f64::from(*kpa)).collect();
            press.time_s.push(time_s);
            press.gel_from_indenter.push(touch[0].gel_from_body);
            press.force_n.as_mut().unwrap().push(f64::from(-wrench[0][2]));
            press.taxels_raw.push(row.clone());
            press.taxels_kpa.push(row);
            press.valid.push(vec![true; n_taxels]);
        }
        press
    });
    let recording = Recording {
        sensor: sensor.name.clone(),
        provenance: Provenance::Simulated,
        taxels: sensor.taxels.iter().map(|taxel| taxel.name.clone()).collect(),
        presses: presses.collect(),
    };
    Recorded {
        recording,
        logs: Vec::new(),
    }
}

/// For an untouched sensor: the number of taxels that read zero, and of those that repeat another
/// value.
fn failing(variation: &SensorVariation, seed: u64) -> [usize; 2] {
    let gel = FastGel::phystac().unwrap();
    let mut batch = SensorBatch::new(&gel, None, variation.clone(), [1, 1], seed);
    let rows: Vec<[f32; 8]> = (0..5)
        .map(|_| {
            let (mut readings_kpa, mut wrench) = ([0.0; 8], [[0.0; 6]]);
            batch.step(0.1, &[], &[], &[0], &mut readings_kpa, &mut wrench);
            readings_kpa
        })
        .collect();
    let same = (0..8).filter(|&taxel: &usize| rows.iter().all(|row| row[taxel] == rows[0][taxel]));
    let (dead, stuck): (Vec<usize>, Vec<usize>) = same.partition(|&taxel| rows[0][taxel] == 0.0);
    [dead.len(), stuck.len()]
}

fn find(recorded: &Recorded, sensor: &SensorFile) -> FoundVariation {
    let sources = VariationSources {
        sensor,
        model: None,
        recorded: Some(recorded),
        command: "a test",
    };
    find_variation(&sources).unwrap()
}

#[test]
fn known_variations_are_found_again() {
    let sensor = SensorFile::phystac().unwrap();
    let drawn = SensorVariation {
        gain_deviation: 0.1,
        offset_deviation_kpa: 0.5,
        noise_deviation_kpa: 0.02,
        quantum_kpa: 0.01,
        hysteresis: 0.05,
        dead_chance: 0.2,
        stuck_chance: 0.2,
        rate_hz: 50.0,
        jitter: 0.1,
        ..SensorVariation::default()
    };
    // A sensor with both faults.
    let seed = (1..100)
        .find(|seed| failing(&drawn, *seed).iter().all(|n| *n > 0))
        .unwrap();
    let recorded = recorded(&drawn, &sensor, seed);
    let found = find(&recorded, &sensor);
    let variation = &found.variation;
    for (name, found, expected, tolerance) in [
        ("noise", variation.noise_deviation_kpa, 0.02, 0.05),
        ("quantum", variation.quantum_kpa, 0.01, 0.001),
        ("hysteresis", variation.hysteresis, 0.05, 0.1),
        ("rate", variation.rate_hz, 50.0, 0.01),
        ("jitter", variation.jitter, 0.1, 0.1),
    ] {
        assert!(
            (found / expected - 1.0).abs() < tolerance,
            "{name}: {found}, not {expected}"
        );
    }
    let chances = [variation.dead_chance, variation.stuck_chance];
    for (chance, n) in chances.into_iter().zip(failing(&drawn, seed)) {
        assert!((chance - (n + 1) as f64 / 12.0).abs() < 1e-3, "{chance} {n}");
    }
    let others = [
        "gain_deviation",
        "drift_kpa_per_k",
        "temperature_time_s",
        "tilt_deviation_rad",
    ];
    for field in others {
        assert!(found.left_out.contains(&field), "{field}");
        assert!(
            found.text.contains(&format!("# {field} is left out: ")),
            "{}",
            found.text
        );
    }
    assert_eq!(found.found.len() + found.left_out.len(), 22);
}

#[test]
fn nothing_to_find_from_and_another_sensor_are_refused() {
    let sensor = SensorFile::phystac().unwrap();
    let nothing = VariationSources {
        sensor: &sensor,
        model: None,
        recorded: None,
        command: "a test",
    };
    let error = find_variation(&nothing).unwrap_err().to_string();
    assert!(error.contains("model, recordings, or both"), "{error}");
    let other = Recorded {
        recording: Recording {
            sensor: "other".into(),
            provenance: Provenance::Real,
            taxels: vec!["a".into()],
            presses: Vec::new(),
        },
        logs: Vec::new(),
    };
    let sources = VariationSources {
        recorded: Some(&other),
        ..nothing
    };
    let error = find_variation(&sources).unwrap_err().to_string();
    assert!(error.contains("other"), "{error}");
}

/// The files of this project, made by `twintac fast variation`.
#[test]
fn what_is_shipped_can_be_read_and_says_where_it_comes_from() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../../variations");
    let files: Vec<_> = std::fs::read_dir(folder)
        .unwrap()
        .map(|file| file.unwrap().path())
        .collect();
    assert!(!files.is_empty());
    for file in files {
        let text = std::fs::read_to_string(&file).unwrap();
        let name = file.display().to_string();
        let found = SensorVariation::parse(&name, &text).unwrap();
        assert!(
            found.gain_deviation > 0.0 && found.noise_deviation_kpa > 0.0,
            "{found:?}"
        );
        assert!(text.contains("twintac fast variation --model"), "{name}");
        // No values that were fitted to other people's recordings are shipped.
        assert!(text.contains("emulated (") && !text.contains("real ("), "{name}");
    }
}
