//! The engine gives the results of the library, and its errors have the texts of the command line.

#![allow(clippy::unwrap_used)] // also in the helpers of tests

use serde_json::{Value, json};
use twintac_engine::{Array, Engine};
use twintac_fast::{Body, FastGel};
use twintac_protocol::PressPath;
use twintac_sensor::{Sensor, SensorFile};
use twintac_shape::Pose;
use twintac_simulate::{Gel, SimulateSettings};

const SURROGATE: &[u8] = include_bytes!("../../../twin/fast/built_in/phystac.safetensors");
const PHYSTAC: &str = include_str!("../../../../sensors/phystac.toml");

fn ask(engine: &mut Engine, request: &Value) -> Value {
    serde_json::from_str(&engine.answer(&request.to_string(), &[])).unwrap()
}

fn opened() -> Engine {
    let mut engine = Engine::default();
    let sensor = ask(
        &mut engine,
        &json!({"do": "open", "file": "phystac.toml", "text": PHYSTAC}),
    );
    assert_eq!(sensor["taxels"].as_array().unwrap().len(), 8, "{sensor}");
    engine
}

fn prepare(indenter: &str) -> Value {
    json!({"do": "prepare", "indenter": indenter, "depth_mm": 2.0, "max_nodes": 800})
}

fn step(position_mm: [f64; 3]) -> Value {
    let pose = json!({"position_mm": position_mm, "rotation": [0.0, 0.0, 0.0, 1.0]});
    json!({"do": "step", "since_s": 0.02, "gel_from_indenter": pose})
}

/// A press on the engine's fine mesh gives the result of the library, within the difference of the
/// meshes.
#[test]
fn a_press_is_that_of_the_library() {
    let mut engine = opened();
    let prepared = ask(
        &mut engine,
        &json!({"do": "prepare", "indenter": "sphere-25", "depth_mm": 2.0, "max_nodes": 2000}),
    );
    let touch_mm = prepared["touch_mm"].as_f64().unwrap();
    let settings = SimulateSettings {
        max_path_nodes: 7000,
        ..SimulateSettings::default()
    };
    let gel = Gel::new(SensorFile::phystac().unwrap().sensor, settings);
    let at = |depth_mm: f64| Pose::from_position(glam::DVec3::new(2.0, 1.0, touch_mm - depth_mm));
    let path = PressPath::through(
        "sphere-25",
        (1..=4).map(|i| (f64::from(i), at(0.4 * f64::from(i)))),
    );
    let followed = gel
        .follow(gel.shape("sphere-25").unwrap(), &path, &mut || {
            std::ops::ControlFlow::Continue(())
        })
        .unwrap();
    let expected = followed.frames.last().unwrap();
    let mut found = Value::Null;
    for i in 1..=4 {
        found = ask(&mut engine, &step([2.0, 1.0, touch_mm - 0.4 * f64::from(i)]));
    }
    let force_n = found["force_n"][2].as_f64().unwrap();
    assert!(
        (force_n / expected.force_n.z - 1.0).abs() < 0.05,
        "{force_n} N, {} N",
        expected.force_n.z
    );
    let largest_kpa = expected.pressure_kpa.values().copied().fold(0.0, f64::max);
    let found_kpa = found["pressure_kpa"].as_array().unwrap();
    for (found, (taxel, expected)) in found_kpa.iter().zip(&expected.pressure_kpa) {
        let off = (found.as_f64().unwrap() - expected).abs() / largest_kpa;
        assert!(off < 0.08, "{taxel}: {found} kPa, {expected} kPa");
    }
    assert_eq!(found["provenance"], "simulated");
}

#[test]
fn arrays_are_of_one_mesh_and_move_with_the_indenter() {
    let mut engine = opened();
    let prepared = ask(&mut engine, &prepare("cylinder"));
    let n_nodes = prepared["n_nodes"].as_u64().unwrap() as usize;
    let touch_mm = prepared["touch_mm"].as_f64().unwrap();
    let frame = ask(&mut engine, &step([0.0, 0.0, touch_mm - 0.5]));
    assert!(frame["contact_mm2"].as_f64().unwrap() > 20.0, "{frame}");
    let arrays = engine.arrays();
    for array in [Array::RestMm, Array::DisplacementsMm] {
        assert_eq!(arrays.numbers(array).len(), 3 * n_nodes);
    }
    for array in [Array::PressureKpa, Array::VonMisesKpa] {
        assert_eq!(arrays.numbers(array).len(), n_nodes);
    }
    assert_eq!(arrays.numbers(Array::MapKpa).len(), 64 * 64);
    for array in [Array::SurfaceTriangles, Array::Tets] {
        assert!(
            arrays
                .indices(array)
                .iter()
                .all(|node| (*node as usize) < n_nodes)
        );
    }
    let lowest = arrays
        .numbers(Array::DisplacementsMm)
        .iter()
        .copied()
        .fold(0.0, f32::min);
    assert!((lowest + 0.5).abs() < 0.03, "{lowest} mm");
    ask(&mut engine, &json!({"do": "rest"}));
    assert!(
        engine
            .arrays()
            .numbers(Array::DisplacementsMm)
            .iter()
            .all(|moved| *moved == 0.0)
    );
}

#[test]
fn what_is_drawn_is_the_shape() {
    let mut engine = opened();
    let radius_mm = 12.5;
    let shape = json!({"kind": "sphere", "radius_mm": radius_mm});
    ask(&mut engine, &json!({"do": "outline", "shape": shape}));
    let (corners, _) = engine.arrays().numbers(Array::OutlineMm).as_chunks::<3>();
    let (triangles, _) = engine.arrays().indices(Array::OutlineTriangles).as_chunks::<3>();
    let at = |corner: u32| glam::Vec3::from(corners[corner as usize]);
    for corner in 0..corners.len() as u32 {
        let off = at(corner).distance(glam::Vec3::Z * radius_mm) - radius_mm;
        assert!(off.abs() < 0.01, "{off} mm");
    }
    // The triangles face outward and close the surface: their volume is that of the ball.
    let volume: f32 = triangles
        .iter()
        .map(|[a, b, c]| at(*a).cross(at(*b)).dot(at(*c)) / 6.0)
        .sum();
    let expected = 4.0 / 3.0 * std::f32::consts::PI * radius_mm.powi(3);
    assert!(
        (volume / expected - 1.0).abs() < 0.01,
        "{volume} mm³, {expected} mm³"
    );
}

#[test]
fn errors_are_those_of_the_library_and_change_nothing() {
    let mut engine = opened();
    let broken = PHYSTAC.replace("size_mm = [34.0, 18.0, 8.5]", "size_mm = [34.0, -18.0, 8.5]");
    let refused = ask(
        &mut engine,
        &json!({"do": "open", "file": "phystac.toml", "text": broken}),
    );
    let expected = Sensor::parse("phystac.toml", &broken, &|_| unreachable!()).unwrap_err();
    assert_eq!(refused["error"], expected.to_string());
    let no_surface = "not an STL file";
    engine.answer(
        &json!({"do": "keep", "name": "tip.stl"}).to_string(),
        no_surface.as_bytes(),
    );
    let text = "name = \"tip\"\nshape = { kind = \"stl\", path = \"tip.stl\" }\n";
    let refused = ask(
        &mut engine,
        &json!({"do": "add", "file": "tip.toml", "text": text}),
    );
    let load = |_: &str| Ok(no_surface.as_bytes().to_owned());
    let expected = twintac_sensor::IndenterFile::parse("tip.toml", text, &load).unwrap_err();
    assert_eq!(refused["error"], expected.to_string());
    let refused = ask(
        &mut engine,
        &json!({"do": "prepare", "indenter": "cube", "depth_mm": 2.0, "max_nodes": 3}),
    );
    assert!(
        refused["error"].as_str().unwrap().starts_with("`max_nodes` is 3"),
        "{refused}"
    );
    let refused = ask(&mut engine, &step([0.0, 0.0, 0.0]));
    assert_eq!(refused["error"], "there is no mesh yet: prepare a press first");
    // The sensor is unchanged.
    assert!(ask(&mut engine, &prepare("cube"))["n_nodes"].is_number());
}

fn keep(engine: &mut Engine, name: &str, bytes: &[u8]) {
    let request = json!({"do": "keep", "name": name}).to_string();
    assert_eq!(engine.answer(&request, bytes), "{}");
}

fn touch(bodies: &[(&str, [f64; 3])]) -> Value {
    let bodies = bodies.iter().map(|(indenter, position_mm)| {
        let pose = json!({"position_mm": position_mm, "rotation": [0.0, 0.0, 0.0, 1.0]});
        let sensor = SensorFile::phystac().unwrap().sensor;
        let found = sensor
            .indenters
            .iter()
            .find(|found| found.name == *indenter)
            .unwrap();
        json!({"shape": found.shape, "gel_from_indenter": pose})
    });
    json!({"do": "touch", "surrogate": "phystac.safetensors", "bodies": bodies.collect::<Vec<_>>()})
}

#[test]
fn several_shapes_press_as_by_the_surrogate() {
    let mut engine = opened();
    keep(&mut engine, "phystac.safetensors", SURROGATE);
    let touch_mm = ask(&mut engine, &prepare("sphere-25"))["touch_mm"]
        .as_f64()
        .unwrap();
    let placed = [
        ("sphere-25", [-8.0, 0.0, touch_mm - 1.0]),
        ("cube", [8.0, 1.0, touch_mm - 0.5]),
    ];
    let found = ask(&mut engine, &touch(&placed));
    assert_eq!(found["provenance"], "simulated");
    assert!(
        (found["depth_mm"].as_f64().unwrap() - 1.0).abs() < 1e-9,
        "{found}"
    );

    let sensor = SensorFile::phystac().unwrap().sensor;
    let gel = Gel::new(std::sync::Arc::clone(&sensor), SimulateSettings::default());
    let bodies = placed.map(|(name, position_mm)| {
        let body = Body::new(gel.shape(name).unwrap(), &sensor.surfaces).unwrap();
        (body, Pose::from_position(position_mm.into()))
    });
    let bodies = bodies.each_ref().map(|(body, pose)| (body, *pose));
    let mut reader = FastGel::phystac().unwrap().reader();
    let (mut pressures, mut wrench) = ([0.0; 8], [0.0; 6]);
    reader.read(&bodies, &mut pressures, &mut wrench);
    assert_eq!(found["pressure_kpa"], json!(pressures.map(f64::from)));
    assert_eq!(
        found["force_n"],
        json!([0, 1, 2].map(|axis| f64::from(wrench[axis])))
    );
    assert_eq!(
        found["ood_score"].as_f64().unwrap() as f32,
        reader.ood_score(&bodies)
    );
    // Both have a force, and the drawn gel follows both down.
    let alone = ask(&mut engine, &touch(&placed[..1]));
    let force_n = |frame: &Value| -frame["force_n"][2].as_f64().unwrap();
    assert!(force_n(&alone) > 0.05 && force_n(&found) > 1.2 * force_n(&alone));
    ask(&mut engine, &touch(&placed));
    let (rest, _) = engine.arrays().numbers(Array::RestMm).as_chunks::<3>();
    let (moved, _) = engine.arrays().numbers(Array::DisplacementsMm).as_chunks::<3>();
    for (sign, depth_mm) in [(-1.0, 1.0), (1.0, 0.5)] {
        let on_side = rest.iter().zip(moved).filter(|(rest, _)| sign * rest[0] > 3.0);
        let lowest = on_side.map(|(_, moved)| moved[2]).fold(0.0, f32::min);
        assert!(
            (-depth_mm - 0.02..-0.6 * depth_mm).contains(&lowest),
            "{lowest} mm"
        );
    }
    // The torque is about the origin of the first: straight below a ball it has none across.
    let middle = ask(&mut engine, &touch(&[("sphere-25", [0.0, 0.0, touch_mm - 1.0])]));
    for axis in 0..2 {
        assert!(
            middle["torque_n_mm"][axis].as_f64().unwrap().abs() < 0.3,
            "{middle}"
        );
    }
}

#[test]
fn a_surrogate_is_refused_for_another_gel_and_read_again_when_it_is_stored_again() {
    let mut engine = opened();
    ask(&mut engine, &prepare("sphere-25"));
    let press = touch(&[("sphere-25", [0.0, 0.0, 8.0])]);
    let missing = ask(&mut engine, &press);
    assert_eq!(missing["error"], "drop `phystac.safetensors` on the page as well");
    keep(&mut engine, "phystac.safetensors", SURROGATE);
    assert!(ask(&mut engine, &press)["force_n"].is_array());
    keep(&mut engine, "phystac.safetensors", b"torn");
    let torn = ask(&mut engine, &press);
    assert!(
        torn["error"]
            .as_str()
            .unwrap()
            .starts_with("phystac.safetensors: "),
        "{torn}"
    );
    keep(&mut engine, "phystac.safetensors", SURROGATE);
    let twisted = press.to_string().replace("0.0,1.0]", "0.0,2.0]");
    let twisted = ask(&mut engine, &serde_json::from_str(&twisted).unwrap());
    assert_eq!(twisted["error"], "`rotation` is 2; give a quaternion of length 1");
    assert!(ask(&mut engine, &press)["force_n"].is_array());

    let softer = PHYSTAC.replace("size_mm = [34.0, 18.0, 8.5]", "size_mm = [34.0, 18.0, 8.0]");
    let request = json!({"do": "open", "file": "phystac.toml", "text": softer});
    assert!(ask(&mut engine, &request)["error"].is_null());
    ask(&mut engine, &prepare("sphere-25"));
    let refused = ask(&mut engine, &press)["error"].as_str().unwrap().to_owned();
    assert!(refused.contains("8.5"), "{refused}");
}
