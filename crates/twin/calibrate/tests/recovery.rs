//! Materials are recovered from simulated curves with noise.

#![allow(clippy::unwrap_used, clippy::print_stdout)] // helpers of tests

use std::sync::Arc;

use glam::DQuat;
use rand::SeedableRng;
use twintac_calibrate::{
    CalibrateError, Curve, Fit, FitSettings, Material, Model, Parameter, PronyTerm, Quantity, Signal, fit,
};
use twintac_random::{RandomStream, normal};
use twintac_sensor::Sensor;
use twintac_shape::Shape;
use twintac_simulate::{Gel, Keyframe, PressPlace, SimulateSettings};

const SENSOR: &str = r#"
name = "block"
summary = "a bonded block"
source = "made for this test"

[gel.solid]
kind = "block"
size_mm = [16.0, 14.0, 6.0]

[gel.material]
shear_modulus_kpa = 20.0
poissons_ratio = 0.47
source = "made for this test"

[readout]
min_kpa = 0.0
max_kpa = 1500.0
resolution_kpa = 0.01
rate_hz = 55.0

[[taxels]]
name = "left"
position_mm = [-3.0, 0.0, 0.0]
port_radius_mm = 0.8
channel = 0

[[taxels]]
name = "right"
position_mm = [3.0, 0.0, 0.0]
port_radius_mm = 0.8
channel = 1
"#;

fn gel(material: &Material) -> Gel {
    let none = |path: &str| Err(std::io::Error::other(path.to_owned()));
    let sensor = Sensor::parse("block", SENSOR, &none).unwrap();
    let mut settings = SimulateSettings {
        edges_per_height: 3.0,
        edges_per_contact_radius: 3.0,
        max_nodes: 1500,
        ..SimulateSettings::fine()
    };
    settings.solver.tolerance = 1e-6;
    // The length of steps must not matter through the penetration that they leave.
    settings.solver.penetration_mm = 5e-4;
    Gel::new(Arc::new(sensor), settings).with_material(material.clone())
}

/// A model from JSON, as in files.
fn model(json: &str) -> Model {
    serde_json::from_str(json).unwrap()
}

/// A simulated measurement: down to this depth at constant speed, a hold, and up, with noise of 1 %
/// of the largest force.
fn measured(material: &Material, depth_mm: f64, hold_s: f64, n: usize, seed: u64) -> Curve {
    let ball = Shape::Sphere { radius_mm: 4.0 };
    measured_with(ball, &gel(material), depth_mm, hold_s, n, seed)
}

/// As [`measured`], with any shape on any gel.
fn measured_with(shape: Shape, gel: &Gel, depth_mm: f64, hold_s: f64, n: usize, seed: u64) -> Curve {
    let duration_s = 2.0 + hold_s;
    let time_s: Vec<f64> = (0..n).map(|i| duration_s * i as f64 / (n - 1) as f64).collect();
    let depth = |t: f64| {
        if hold_s == 0.0 {
            depth_mm * t / duration_s
        } else {
            depth_mm * t.min(1.0).min(duration_s - t)
        }
    };
    let depths: Vec<f64> = time_s.iter().map(|t| depth(*t)).collect();
    let place = PressPlace {
        indenter: "ball".into(),
        shape: shape.clone(),
        x_mm: 0.0,
        y_mm: 0.0,
        rotation: DQuat::IDENTITY,
        depth_mm,
        enough_force_n: None,
    };
    let keyframes: Vec<Keyframe> = time_s
        .iter()
        .zip(&depths)
        .map(|(&time_s, &depth_mm)| Keyframe { time_s, depth_mm })
        .collect();
    let history = gel.press(&place, &keyframes).unwrap();
    assert_eq!(history.failure, None);
    let largest_n = history
        .frames
        .iter()
        .map(|frame| frame.force_n)
        .fold(0.0, f64::max);
    let largest_kpa = history
        .frames
        .iter()
        .flat_map(|frame| frame.port_pressure_kpa.iter().copied())
        .fold(0.0, f64::max);
    let mut random = RandomStream::seed_from_u64(seed);
    let gains = [1.4, 0.6];
    let mut signals = vec![Signal {
        quantity: Quantity::Force,
        values: history
            .frames
            .iter()
            .map(|frame| frame.force_n + 0.01 * largest_n * normal(&mut random, 1.0))
            .collect(),
    }];
    for (taxel, gain) in gains.into_iter().enumerate() {
        signals.push(Signal {
            quantity: Quantity::Taxel(taxel),
            values: history
                .frames
                .iter()
                .map(|frame| {
                    gain * frame.port_pressure_kpa[taxel] + 0.005 * largest_kpa * normal(&mut random, 1.0)
                })
                .collect(),
        });
    }
    Curve {
        friction: 0.0,
        name: format!("press {seed}"),
        shape,
        x_mm: 0.0,
        y_mm: 0.0,
        rotation: DQuat::IDENTITY,
        time_s,
        depth_mm: depths,
        signals,
    }
}

fn forces(mut curve: Curve) -> Curve {
    curve.signals.truncate(1);
    curve
}

fn readings(mut curve: Curve) -> Curve {
    curve.signals.remove(0);
    curve
}

fn found(curves: &[Curve], start: &Material, free: &[&str]) -> Fit {
    let free: Vec<Parameter> = free.iter().map(|name| Parameter::named(name)).collect();
    let settings = FitSettings {
        most_frames: 30,
        ..FitSettings::default()
    };
    let fit = fit(&gel(start), curves, &free, settings, &mut |_| ()).unwrap();
    for unknown in &fit.unknowns {
        println!(
            "{} {:?}: {:.5} {:.5?}",
            unknown.name, unknown.start, unknown.value, unknown.interval_95
        );
    }
    println!(
        "{} iterations, condition {:.1}, {:?}",
        fit.iterations, fit.condition, fit.warnings
    );
    assert!(fit.converged);
    fit
}

#[track_caller]
fn assert_recovered(fit: &Fit, name: &str, truth: f64, within: f64) {
    let unknown = fit.unknowns.iter().find(|unknown| unknown.name == name).unwrap();
    let [low, high] = unknown.interval_95;
    assert!(
        (unknown.value / truth - 1.0).abs() < within,
        "{name} is {} for {truth}",
        unknown.value
    );
    assert!(low < truth && truth < high, "{name}: {low} to {high} for {truth}");
}

#[test]
fn stiffness_and_depth_offset_are_found() {
    let truth = Material::neo_hookean(60.0, 0.47);
    let mut curve = forces(measured(&truth, 2.0, 0.0, 150, 1));
    // The recorded depths assume a surface that is 0.05 mm lower than the true one.
    curve.depth_mm.iter_mut().for_each(|depth_mm| *depth_mm -= 0.05);
    let start = Material::neo_hookean(90.0, 0.47);
    let fit = found(&[curve], &start, &["shear_modulus_kpa", "depth_offset_mm"]);
    assert_recovered(&fit, "shear_modulus_kpa", 60.0 / 2.94, 0.02);
    assert_recovered(&fit, "depth_offset_mm", 0.05, 0.2);
    assert!((fit.poissons_ratio - 0.47).abs() < 1e-12);
    assert!((fit.noise_percent - 1.0).abs() < 0.3);
}

#[test]
fn friction_is_found_beside_stiffness() {
    let rough = gel(&Material::neo_hookean(60.0, 0.47)).with_friction(0.3);
    let ball = Shape::Sphere { radius_mm: 4.0 };
    let punch = Shape::Cylinder {
        radius_mm: 3.0,
        height_mm: 6.0,
        edge_radius_mm: 0.8,
    };
    let curves = [(ball, 2.0, 11), (punch, 1.2, 12)]
        .map(|(shape, depth_mm, seed)| forces(measured_with(shape, &rough, depth_mm, 0.0, 150, seed)));
    let start = Material::neo_hookean(75.0, 0.47);
    let fit = found(&curves, &start, &["shear_modulus_kpa", "friction"]);
    assert_recovered(&fit, "shear_modulus_kpa", 60.0 / 2.94, 0.02);
    assert_recovered(&fit, "friction", 0.3, 0.3);
}

#[test]
fn a_stiffening_law_is_found() {
    let yeoh = |c10_kpa: f64, c20_kpa: f64| Material {
        model: model(&format!(
            r#"{{"model": "yeoh", "c10_kpa": {c10_kpa}, "c20_kpa": {c20_kpa}, "c30_kpa": 0.0}}"#
        )),
        bulk_modulus_kpa: 30.0 * c10_kpa,
        prony: Vec::new(),
    };
    let curve = forces(measured(&yeoh(10.0, 6.0), 3.0, 0.0, 150, 2));
    let fit = found(&[curve], &yeoh(14.0, 0.0), &["c10_kpa", "c20_kpa"]);
    assert_recovered(&fit, "c10_kpa", 10.0, 0.02);
    assert_recovered(&fit, "c20_kpa", 6.0, 0.1);
}

#[test]
fn relaxation_is_found() {
    let relaxing = |shear_kpa, weight, time_s| Material {
        prony: vec![PronyTerm { weight, time_s }],
        ..Material::neo_hookean(2.94 * shear_kpa, 0.47)
    };
    let curve = forces(measured(&relaxing(20.0, 0.3, 1.0), 1.5, 3.0, 60, 3));
    let free = ["shear_modulus_kpa", "prony[0].weight", "prony[0].time_s"];
    let fit = found(&[curve], &relaxing(15.0, 0.1, 3.0), &free);
    assert_recovered(&fit, "shear_modulus_kpa", 20.0, 0.02);
    assert_recovered(&fit, "prony[0].weight", 0.3, 0.05);
    assert_recovered(&fit, "prony[0].time_s", 1.0, 0.15);
}

#[test]
fn exponents_and_laws_with_a_volume_of_their_own_are_found() {
    let ogden = |mu_kpa: f64, alpha: f64| Material {
        model: model(&format!(
            r#"{{"model": "ogden", "terms": [{{"mu_kpa": {mu_kpa}, "alpha": {alpha}}}]}}"#
        )),
        bulk_modulus_kpa: 300.0,
        prony: Vec::new(),
    };
    let curve = forces(measured(&ogden(9.0, 5.0), 3.0, 0.0, 150, 7));
    let fit = found(
        &[curve],
        &ogden(14.0, 3.0),
        &["terms[0].mu_kpa", "terms[0].alpha"],
    );
    assert_recovered(&fit, "terms[0].mu_kpa", 9.0, 0.1);
    assert_recovered(&fit, "terms[0].alpha", 5.0, 0.1);

    for name in ["logarithmic-neo-hookean", "stable-neo-hookean"] {
        let gel = |shear_kpa: f64| Material {
            model: model(&format!(
                r#"{{"model": "{name}", "shear_modulus_kpa": {shear_kpa}}}"#
            )),
            bulk_modulus_kpa: 15.0 * shear_kpa,
            prony: Vec::new(),
        };
        let curve = forces(measured(&gel(20.0), 2.0, 0.0, 150, 8));
        let fit = found(&[curve], &gel(35.0), &["shear_modulus_kpa"]);
        assert_recovered(&fit, "shear_modulus_kpa", 20.0, 0.01);
    }
}

#[test]
fn readings_tell_the_shape_of_the_law_and_no_stiffness() {
    let truth = Material::neo_hookean(60.0, 0.45);
    let start = Material::neo_hookean(60.0, 0.48);
    let curve = readings(measured(&truth, 2.0, 0.0, 40, 4));
    let curves = [curve];
    let fit = found(&curves, &start, &["poissons_ratio"]);
    assert_recovered(&fit, "poissons_ratio", 0.45, 0.05);
    let refused = twintac_calibrate::fit(
        &gel(&start),
        &curves,
        &[Parameter::named("shear_modulus_kpa")],
        FitSettings::default(),
        &mut |_| (),
    );
    assert!(matches!(refused, Err(CalibrateError::NotFree { .. })));
}

#[test]
fn what_the_data_do_not_tell_is_said() {
    let truth = Material::neo_hookean(60.0, 0.47);
    let curve = forces(measured(&truth, 1.0, 0.0, 12, 5));
    let fit = found(&[curve], &truth, &["shear_modulus_kpa", "force_scale"]);
    assert!(fit.unknowns.iter().all(|unknown| !unknown.identified));
    assert!(
        fit.warnings
            .iter()
            .any(|warning| warning.contains("do not determine"))
    );
}
