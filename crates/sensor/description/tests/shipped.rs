//! The shipped descriptions are valid and have the expected values.

#![allow(clippy::unwrap_used)] // also in the helpers of tests

use std::path::{Path, PathBuf};

use twintac_sensor::Sensor;
use twintac_shape::{Shape, Surfaces};

fn folder() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../../../sensors")
}

fn shipped() -> Vec<Sensor> {
    let mut paths: Vec<PathBuf> = std::fs::read_dir(folder())
        .unwrap()
        .map(|entry| entry.unwrap().path())
        .collect();
    paths.sort();
    paths
        .iter()
        .map(|path| Sensor::read(path).unwrap_or_else(|error| panic!("{error}")))
        .collect()
}

#[test]
fn all_are_read_and_bear_the_name_of_their_file() {
    let names: Vec<String> = shipped().into_iter().map(|sensor| sensor.name).collect();
    let expected = [
        "array8-ds10",
        "array8-ds20",
        "phystac-tip",
        "phystac",
        "strip4-gel-a",
        "strip4-gel-b",
        "strip4-gel-d",
    ];
    assert_eq!(names, expected);
    for name in names {
        assert_eq!(
            Sensor::read(folder().join(format!("{name}.toml"))).unwrap().name,
            name
        );
    }
}

#[test]
fn all_indenters_can_be_built_and_gels_have_a_top_above_every_taxel() {
    for sensor in shipped() {
        for indenter in &sensor.indenters {
            indenter.shape.signed_distance_field(&sensor.surfaces).unwrap();
        }
        for taxel in &sensor.taxels {
            let at = taxel.position_mm;
            let top_mm = sensor
                .gel
                .solid
                .top_height_mm(at.x, at.y, &sensor.surfaces)
                .unwrap();
            assert!(
                top_mm > at.z + 2.0,
                "{} of {} is {top_mm} mm below the top",
                taxel.name,
                sensor.name
            );
        }
    }
}

#[test]
fn phystac_is_what_the_paper_says() {
    let sensor = Sensor::read(folder().join("phystac.toml")).unwrap();
    assert_eq!(sensor.taxels.len(), 8);
    assert_eq!(
        (
            sensor.readout.min_kpa,
            sensor.readout.max_kpa,
            sensor.readout.rate_hz
        ),
        (50.0, 1500.0, 55.0)
    );
    assert_eq!(sensor.shell.as_ref().unwrap().gap_mm, 1.0);
    assert!(!sensor.is_inferred("shell.gap_mm") && sensor.is_inferred("taxels[3].position_mm"));
    assert!(sensor.indenter("sphere").is_none());
    let sphere = sensor.indenter("sphere-25").unwrap();
    assert_eq!(sphere.shape, Shape::Sphere { radius_mm: 12.5 });
    assert!((sensor.gel.solid.volume_mm3(&Surfaces::new()) - 34.0 * 18.0 * 8.5).abs() < 1e-9);
    let material = &sensor.gel.material;
    assert!((material.youngs_modulus_kpa() - 2.0 * 15.2 * 1.495).abs() < 1e-9);
    assert!((material.poissons_ratio() - 0.495).abs() < 1e-12);
}

#[test]
fn the_tip_falls_from_its_crown_as_described() {
    let sensor = Sensor::read(folder().join("phystac-tip.toml")).unwrap();
    let top_mm = |x_mm: f64, y_mm: f64| {
        sensor
            .gel
            .solid
            .top_height_mm(x_mm, y_mm, &Surfaces::new())
            .unwrap()
    };
    assert!((top_mm(0.0, 0.0) - 19.2).abs() < 1e-12);
    assert!((top_mm(0.0, 10.2) - 16.4).abs() < 1e-12);
    assert!((top_mm(20.3, -10.2) - 11.0).abs() < 1e-12);
}

#[test]
fn descriptions_have_units_and_mark_what_is_inferred() {
    let text = Sensor::read(folder().join("phystac.toml")).unwrap().describe();
    let line = |start: &str| {
        text.lines()
            .find(|line| line.trim_start().starts_with(start))
            .unwrap()
            .to_owned()
    };
    assert!(line("gel").contains("34 × 18 × 8.5 mm *"), "{text}");
    assert!(
        line("shell").contains("1 mm beside the gel, 3 mm * high"),
        "{text}"
    );
    assert!(
        line("read-out").contains("50 to 1500 kPa in steps of 0.01 kPa, 55 Hz"),
        "{text}"
    );
    assert!(line("t3").contains("(12.00, -4.00, 0.00) *"), "{text}");
    assert!(
        line("ring").contains("ring, r 4 to 7 mm, 10 mm high, edges r 0.8 mm *"),
        "{text}"
    );
    assert!(text.ends_with("* inferred, not stated by the source\n"));
    for sensor in shipped() {
        assert!(sensor.describe().lines().count() > 10);
    }
}

/// A sensor whose gel has the material of a file.
fn of_material(path: &str) -> Result<Sensor, twintac_sensor::SensorError> {
    Sensor::parse("strip.toml", &with_material(path), &load)
}

fn with_material(path: &str) -> String {
    let text = std::fs::read_to_string(folder().join("phystac.toml")).unwrap();
    let (head, rest) = text.split_once("[gel.material]").unwrap();
    let (_, tail) = rest.split_once("\n\n").unwrap();
    let head = head.replace(
        "[gel.solid]",
        &format!("[gel]\nmaterial = \"{path}\"\n\n[gel.solid]"),
    );
    let head: String = head
        .split_inclusive('\n')
        .filter(|line| !line.contains("\"gel.material"))
        .collect();
    format!("{head}\n{tail}")
}

fn load(path: &str) -> std::io::Result<Vec<u8>> {
    match path {
        "bad.toml" => Ok(b"model = \"ogden\"\nterms = [{ mu_kpa = 9.0, alpha = -2.0 }]\npoissons_ratio = 0.49\nsource = \"-\"".to_vec()),
        _ => std::fs::read(folder().join(path)),
    }
}

#[test]
fn materials_are_named_by_file() {
    let mut names = Vec::new();
    for entry in std::fs::read_dir(folder().join("../materials")).unwrap() {
        let name = entry.unwrap().file_name().into_string().unwrap();
        let path = format!("../materials/{name}");
        let material = of_material(&path).unwrap().gel.material;
        assert!(
            material.source.len() > 20 && material.poissons_ratio() >= 0.479,
            "{name}"
        );
        let expanded = Sensor::text_with_material("strip.toml", &with_material(&path), &load).unwrap();
        let again = Sensor::parse("strip.toml", &expanded, &|_| unreachable!()).unwrap();
        assert_eq!(again.gel.material, material);
        names.push(name);
    }
    assert!(names.contains(&"ecoflex-00-30-ogden.toml".to_owned()));
}

#[test]
fn errors_in_the_file_of_a_material_name_that_file() {
    let found = of_material("bad.toml").unwrap_err().to_string();
    assert!(
        found.starts_with("bad.toml:2: `terms` ") && found.contains("-18 kPa"),
        "{found}"
    );
    let found = of_material("none.toml").unwrap_err().to_string();
    assert!(
        found.contains("`gel.material` names `none.toml`, which cannot be read"),
        "{found}"
    );
}
