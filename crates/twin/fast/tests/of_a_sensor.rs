//! Which sensors a surrogate may be used with.

#![allow(clippy::unwrap_used)] // a test that cannot set itself up has failed

use glam::{DVec2, DVec3};
use twintac_fast::{FastGel, Friction};
use twintac_material::Material;
use twintac_sensor::{Inclusion, Sensor, SensorFile};
use twintac_shape::Solid;

fn phystac() -> Sensor {
    (*SensorFile::phystac().unwrap().sensor).clone()
}

/// The message of the built-in surrogate about PhysTac with a change; `None` without a difference.
fn said_of(change: impl FnOnce(&mut Sensor)) -> Option<String> {
    let mut sensor = phystac();
    change(&mut sensor);
    let gel = FastGel::phystac().unwrap();
    gel.check(&sensor).err().map(|mismatch| mismatch.to_string())
}

fn of_height(height_mm: f64) -> Solid {
    Solid::Block {
        size_mm: [34.0, 18.0, height_mm],
        center_mm: [0.0; 2],
        edge_radius_mm: 0.0,
    }
}

#[test]
fn the_gels_that_are_built_in_are_of_their_sensors() {
    let (gel, tip) = (FastGel::phystac().unwrap(), FastGel::phystac_tip().unwrap());
    let tip_sensor = SensorFile::phystac_tip().unwrap().sensor;
    gel.check(&phystac()).unwrap();
    tip.check(&tip_sensor).unwrap();
    assert!(gel.check(&tip_sensor).is_err() && tip.check(&phystac()).is_err());
}

#[test]
fn another_gel_is_refused_and_the_difference_is_named() {
    let stiffer = said_of(|sensor| {
        let stiff = Material::neo_hookean(193.0, 0.495);
        sensor.gel.material.model = stiff.model;
        sensor.gel.material.bulk_modulus_kpa = stiff.bulk_modulus_kpa;
    });
    let stiffer = stiffer.unwrap();
    assert!(
        stiffer.contains("of 45.4 kPa") && stiffer.contains("of 193.0 kPa"),
        "{stiffer}"
    );

    let lower = said_of(|sensor| sensor.gel.solid = of_height(4.0)).unwrap();
    for part in [
        "`phystac`",
        "34 x 18 mm and 8.5 mm high",
        "and 4 mm high",
        "twintac fast train",
    ] {
        assert!(lower.contains(part), "{lower}");
    }
    assert!(!lower.contains("material"), "{lower}");

    type Change = (&'static str, fn(&mut Sensor));
    let changes: [Change; 8] = [
        ("material", |sensor| sensor.gel.material.bulk_modulus_kpa *= 0.9),
        ("about [0, 0.1] mm", |sensor| {
            sensor.gel.solid = Solid::Block {
                size_mm: [34.0, 18.0, 8.5],
                center_mm: [0.0, 0.1],
                edge_radius_mm: 0.0,
            }
        }),
        ("shell", |sensor| sensor.shell = None),
        ("boxes in the gel", |sensor| {
            sensor.inclusions.push(Inclusion {
                name: "chip".to_owned(),
                min_mm: DVec3::new(-1.0, -1.0, 0.0),
                max_mm: DVec3::new(1.0, 1.0, 1.0),
            });
        }),
        ("port 2", |sensor| sensor.taxels[2].position_mm.x += 1e-3),
        ("radius of 0.8 mm", |sensor| sensor.taxels[7].port_radius_mm = 0.8),
        ("port 0", |sensor| sensor.taxels.swap(0, 1)),
        ("number of ports: 8, the sensor's 7", |sensor| {
            sensor.taxels.pop();
        }),
    ];
    for (expected, change) in changes {
        let said = said_of(change).unwrap();
        assert!(said.contains(expected), "{expected}: {said}");
    }
}

#[test]
fn what_a_fast_gel_does_not_know_may_differ() {
    let same = said_of(|sensor| {
        sensor.name = "mine".to_owned();
        sensor.summary.clear();
        sensor.source.clear();
        sensor.inferred.clear();
        sensor.gel.material.source.clear();
        sensor.gel.material.bulk_modulus_kpa *= 1.0 + 1e-14;
        sensor.indenters.clear();
        sensor.limits = None;
        sensor.readout.rate_hz = 10.0;
        for taxel in &mut sensor.taxels {
            taxel.name += "x";
            taxel.channel = None;
            taxel.doubtful = Some("a reason".to_owned());
        }
    });
    assert_eq!(same, None);
}

#[test]
fn ports_that_were_moved_are_not_the_sensors() {
    let gel = FastGel::phystac().unwrap();
    let moved = gel.with_ports(&[DVec2::ZERO]).unwrap();
    assert!(moved.check(&phystac()).is_err());
    let back = moved.with_ports(gel.ports_mm()).unwrap();
    assert_eq!(back.check(&phystac()), Ok(()));
}

#[test]
fn friction_is_on_one_gel() {
    let (gel, tip) = (FastGel::phystac().unwrap(), FastGel::phystac_tip().unwrap());
    let mut friction = Friction::on(&phystac(), 0.5);
    let mismatch = friction.check(&tip.reader()).unwrap_err();
    assert_eq!(
        (&mismatch.of[..], &mismatch.sensor[..]),
        ("phystac-tip", "phystac")
    );
    // The ports do not matter.
    let moved = gel.with_ports(&[DVec2::ZERO]).unwrap();
    assert_eq!(friction.check(&moved.reader()), Ok(()));
}

#[test]
fn ports_are_where_a_port_is_within_the_gel() {
    let gel = FastGel::phystac().unwrap();
    let [low, high] = gel.port_bounds_mm().unwrap();
    assert_eq!([low, high], [DVec2::new(-16.0, -8.0), DVec2::new(16.0, 8.0)]);
    for place_mm in [DVec2::ZERO, low, high, DVec2::new(low.x, high.y)] {
        assert!(gel.with_ports(&[place_mm]).is_ok(), "{place_mm}");
    }
    for place_mm in [
        DVec2::new(0.0, 8.1),
        DVec2::new(-16.1, 0.0),
        DVec2::new(0.0, f64::NAN),
    ] {
        let error = gel.with_ports(&[DVec2::ZERO, place_mm]).unwrap_err();
        assert!(
            error.to_string().contains("from (-16, -8) to (16, 8) mm"),
            "{error}"
        );
    }
    // Taxels that reach over the side of the fingertip were trained, and the base up to its side.
    let tip = FastGel::phystac_tip().unwrap();
    let moved = tip.with_ports(tip.ports_mm()).unwrap();
    let [low, _] = tip.port_bounds_mm().unwrap();
    assert!(moved.has_port_at(DVec2::new(low.x, 0.0)) && !moved.has_port_at(low - 0.1));
    assert_eq!(moved.port_bounds_mm(), tip.port_bounds_mm());
}
