//! Properties of predictions that hold for any trained surrogate, tested on one that is trained on
//! a few invented presses.

#![allow(clippy::unwrap_used)] // also in the helpers of tests

use glam::{DQuat, DVec2, DVec3};
use twintac_fast::{Body, FastGel, FemFrame, FemPress, Touch, TrainSettings, training_places_mm};
use twintac_sensor::{Sensor, SensorFile};
use twintac_shape::{Pose, Shape, Surfaces};

/// Presses in which the pressure at the base is proportional to the depth of a ball and decreases
/// with the distance from it.
fn presses(sensor: &Sensor) -> Vec<FemPress> {
    let places = training_places_mm(sensor);
    let top_mm = sensor.gel.solid.bounds_mm(&sensor.surfaces).1.z;
    let press = |number: u32| {
        let at = DVec3::new(
            f64::from(number % 5) * 6.0 - 12.0,
            f64::from(number % 3) * 5.0 - 5.0,
            top_mm,
        );
        let frame = |depth_mm: f64| {
            let gel_from_indenter = Pose::from_position(at - DVec3::Z * depth_mm);
            let falls = |place: &glam::DVec2| (-place.distance_squared(at.truncate()) / 30.0).exp();
            FemFrame {
                gel_from_indenter,
                force_n: DVec3::new(0.0, 0.0, -2.0 * depth_mm),
                torque_n_mm: at.cross(DVec3::new(0.0, 0.0, -2.0 * depth_mm)),
                floor_kpa: places
                    .iter()
                    .map(|place| (10.0 * depth_mm * falls(place)) as f32)
                    .collect(),
            }
        };
        FemPress {
            shape: Shape::Sphere { radius_mm: 5.0 },
            edge_mm: 0.7,
            frames: [1.0, 2.0, 3.0].map(frame).to_vec(),
        }
    };
    (0..15).map(press).collect()
}

fn gel(n_steps: usize) -> (FastGel, Vec<FemPress>) {
    gel_of(&SensorFile::phystac().unwrap().sensor, n_steps)
}

fn gel_of(sensor: &Sensor, n_steps: usize) -> (FastGel, Vec<FemPress>) {
    let settings = TrainSettings {
        n_steps,
        n_frames: 16,
        ..TrainSettings::default()
    };
    let presses = presses(sensor);
    let gel = FastGel::train(sensor, (&presses, &[]), &settings, 1, &mut |_| ()).unwrap();
    (gel, presses)
}

fn read(gel: &FastGel, bodies: &[(&Body, Pose)]) -> ([f32; 8], [f32; 6]) {
    let (mut pressure_kpa, mut wrench) = ([0.0; 8], [0.0; 6]);
    gel.reader().read(bodies, &mut pressure_kpa, &mut wrench);
    (pressure_kpa, wrench)
}

fn ball() -> Body {
    Body::new(&Shape::Sphere { radius_mm: 5.0 }, &Surfaces::new()).unwrap()
}

#[test]
fn training_presses_are_learned() {
    let (gel, presses) = gel(400);
    let evaluation = gel.evaluate(&presses, &Surfaces::new()).unwrap();
    let overall = evaluation.overall.unwrap();
    assert!(overall.nearest_percent < 12.0, "{evaluation:?}");
    assert!(overall.force_percent < 25.0, "{evaluation:?}");
    assert_eq!(evaluation.by_shape.keys().collect::<Vec<_>>(), ["sphere"]);
    assert_eq!(overall.n_frames, 45);
}

#[test]
fn a_file_reads_the_same_bits() {
    let (gel, _) = gel(3);
    let again = FastGel::from_bytes(&gel.to_bytes().unwrap()).unwrap();
    assert_eq!(again, gel);
    let (pose, ball) = (Pose::from_position(DVec3::new(-4.0, 4.0, 6.5)), ball());
    assert_eq!(read(&again, &[(&ball, pose)]), read(&gel, &[(&ball, pose)]));
}

#[test]
fn taxels_that_reach_over_the_gels_side_are_read_together() {
    let sensor = SensorFile::phystac_tip().unwrap().sensor;
    let (gel, presses) = gel_of(&sensor, 200);
    let evaluation = gel.evaluate(&presses, &Surfaces::new()).unwrap();
    assert!(
        evaluation.overall.unwrap().nearest_percent < 12.0,
        "{evaluation:?}"
    );

    let again = FastGel::from_bytes(&gel.to_bytes().unwrap()).unwrap();
    assert_eq!(again, gel);
    let ball = ball();
    let there = [(&ball, Pose::from_position(DVec3::new(-4.0, 4.0, 17.0)))];
    let own = read(&gel, &there);
    assert_eq!(read(&again, &there), own);

    // Other locations use the network of all locations; the force stays the same.
    let (as_places_kpa, wrench) = read(&gel.with_ports(gel.ports_mm()).unwrap(), &there);
    assert_ne!(as_places_kpa, own.0);
    assert_eq!(wrench, own.1);

    // One of many sensors gives the same numbers as the sensor alone.
    let bodies = [ball.clone()];
    let touch = |sensor: u32| Touch {
        body: 0,
        gel_from_body: Pose::from_position(DVec3::new(f64::from(sensor) - 8.0, 2.0, 17.0)),
    };
    let touches: Vec<Touch> = (0..21).map(touch).collect();
    let ends: Vec<usize> = (1..=21).collect();
    let (mut pressure_kpa, mut wrench) = (vec![0.0; 8 * 21], vec![[0.0; 6]; 21]);
    gel.reader()
        .read_many(&bodies, &touches, &ends, &mut pressure_kpa, &mut wrench);
    for (sensor, pressure_kpa) in pressure_kpa.chunks_exact(8).enumerate() {
        let alone = read(&gel, &[(&ball, touches[sensor].gel_from_body)]);
        assert_eq!((pressure_kpa, wrench[sensor]), (&alone.0[..], alone.1));
    }
}

#[test]
fn a_file_of_another_version_says_what_to_do() {
    let mut bytes = gel(3).0.to_bytes().unwrap();
    let number = br#"\"version\":6"#;
    let at = bytes
        .windows(number.len())
        .position(|window| window == number)
        .unwrap();
    bytes[at + number.len() - 1] = b'2';
    let error = FastGel::from_bytes(&bytes).unwrap_err().to_string();
    assert!(
        error.contains("version is 2") && error.contains("fast train"),
        "{error}"
    );
}

#[test]
fn bytes_that_are_no_fast_gel_are_an_error() {
    let (gel, _) = gel(1);
    let bytes = gel.to_bytes().unwrap();
    for broken in [&bytes[..0], &bytes[..100], &bytes[..bytes.len() - 4]] {
        let error = FastGel::from_bytes(broken).unwrap_err().to_string();
        assert!(error.contains("not a readable surrogate"), "{error}");
    }
}

#[test]
fn what_does_not_touch_is_not_felt() {
    let (gel, _) = gel(3);
    let ball = ball();
    let nothing = read(&gel, &[]);
    let far_above = Pose::from_position(DVec3::new(0.0, 0.0, 12.0));
    assert_eq!(read(&gel, &[(&ball, far_above)]), nothing);
    let beside = Pose::from_position(DVec3::new(40.0, 0.0, 6.0));
    assert_eq!(read(&gel, &[(&ball, beside)]), nothing);
}

#[test]
fn order_and_division_of_bodies_do_not_matter() {
    let (gel, _) = gel(3);
    let ball = ball();
    let cube = Shape::Box {
        size_mm: [8.0; 3],
        edge_radius_mm: 1.0,
    };
    let cube = Body::new(&cube, &Surfaces::new()).unwrap();
    let on_the_left = Pose::from_position(DVec3::new(-9.0, 0.0, 6.5));
    let on_the_right = Pose {
        position_mm: DVec3::new(9.0, 2.0, 7.0),
        rotation: DQuat::from_rotation_z(0.5),
    };
    let there = [(&ball, on_the_left), (&cube, on_the_right)];
    let back = [(&cube, on_the_right), (&ball, on_the_left)];
    assert_eq!(read(&gel, &there), read(&gel, &back));
}

#[test]
fn a_sensor_of_a_batch_reads_what_it_reads_alone() {
    let (gel, _) = gel(3);
    let bodies = [ball(), ball()];
    let touch = |number: usize| Touch {
        body: (number % 2) as u32,
        gel_from_body: Pose::from_position(DVec3::new(
            (number as f64 * 0.7).sin() * 15.0,
            (number as f64 * 0.3).cos() * 7.0,
            6.5,
        )),
    };
    // The third of every five sensors is touched by nothing, the others by one or two bodies.
    let of_sensor = |sensor: usize| if sensor % 5 == 2 { 0 } else { 1 + sensor % 2 };
    let ends: Vec<usize> = (0..101)
        .scan(0, |end, sensor| {
            *end += of_sensor(sensor);
            Some(*end)
        })
        .collect();
    let touches: Vec<Touch> = (0..ends[100]).map(touch).collect();
    for n_threads in [1, 2, 7, 200] {
        let (mut pressure_kpa, mut wrench) = (vec![0.0; 8 * 101], vec![[0.0; 6]; 101]);
        gel.batch(n_threads)
            .read(&bodies, &touches, &ends, &mut pressure_kpa, &mut wrench);
        for sensor in 0..101 {
            let start = if sensor == 0 { 0 } else { ends[sensor - 1] };
            let own: Vec<(&Body, Pose)> = touches[start..ends[sensor]]
                .iter()
                .map(|touch| (&bodies[touch.body as usize], touch.gel_from_body))
                .collect();
            let alone = read(&gel, &own);
            assert_eq!(pressure_kpa[8 * sensor..8 * (sensor + 1)], alone.0);
            assert_eq!(wrench[sensor], alone.1);
        }
    }
}

#[test]
#[should_panic(expected = "a pose of finite numbers")]
fn a_pose_that_is_no_pose_is_not_read_as_nothing() {
    let (gel, _) = gel(1);
    let nowhere = Pose::from_position(DVec3::new(f64::NAN, 0.0, 6.0));
    read(&gel, &[(&ball(), nowhere)]);
}

#[test]
fn ports_may_be_anywhere_on_the_floor() {
    let (gel, _) = gel(400);
    let ball = ball();
    let there = [(&ball, Pose::from_position(DVec3::new(-3.0, 2.5, 6.5)))];
    let pressures = |places_mm: &[DVec2]| {
        let mut pressure_kpa = vec![0.0; places_mm.len()];
        let mut reader = gel.with_ports(places_mm).unwrap().reader();
        reader.read(&there, &mut pressure_kpa, &mut [0.0; 6]);
        pressure_kpa
    };
    let taxels = [-12.0, -4.0, 4.0, 12.0].map(|x| DVec2::new(x, -4.0));
    assert_eq!(pressures(&taxels), read(&gel, &there).0[..4]);
    // Locations with the same offset from their points share rows: each gives the same number as
    // alone.
    let rows = (-10..10).flat_map(|j| (-20..20).map(move |i| 0.5 * DVec2::new(f64::from(i), f64::from(j))));
    let places: Vec<DVec2> = rows.collect();
    let together = pressures(&places);
    for number in (0..places.len()).step_by(37) {
        assert_eq!(
            pressures(&places[number..=number]),
            together[number..=number],
            "{number} {}",
            places[number]
        );
    }
    let largest = (0..places.len())
        .max_by(|a, b| together[*a].total_cmp(&together[*b]))
        .unwrap();
    assert!(
        places[largest].distance(DVec2::new(-3.0, 2.5)) < 2.0,
        "{}",
        places[largest]
    );
}

#[test]
fn a_contact_unlike_the_training_presses_is_out_of_distribution() {
    let (gel, _) = gel(3);
    let mut reader = gel.reader();
    let thin = Body::new(&Shape::Sphere { radius_mm: 1.0 }, &Surfaces::new()).unwrap();
    let at = |z_mm: f64| Pose::from_position(DVec3::new(0.0, 0.0, z_mm));
    // A training press presses a ball 1, 2 and 3 mm deep there.
    assert!(reader.ood_score(&[(&ball(), at(7.5))]) < 1.0);
    assert!(reader.ood_score(&[(&thin, at(7.5))]) > 1.0);
    assert!(reader.ood_score(&[(&ball(), at(3.5))]) > 1.0);
    assert_eq!(reader.ood_score(&[(&ball(), at(12.0))]), 0.0);
    // Between the points of the grid, none of which is inside the ball.
    let between = Pose::from_position(DVec3::new(1.0, 1.0, 8.0));
    assert!(reader.ood_score(&[(&thin, between)]) > 1.0);
}

#[test]
fn the_built_in_fingertip_carries_a_ball_about_as_a_half_space_does() {
    let sensor = SensorFile::phystac_tip().unwrap().sensor;
    let gel = FastGel::phystac_tip().unwrap();
    assert_eq!(
        (gel.sensor(), gel.n_taxels()),
        (&sensor.name[..], sensor.taxels.len())
    );
    let ball = Body::new(&Shape::Sphere { radius_mm: 6.0 }, &Surfaces::new()).unwrap();
    let mut reader = gel.reader();
    let mut press = |depth_mm: f64| {
        let pose = Pose::from_position(DVec3::new(0.0, 0.0, 19.2 - depth_mm));
        let (mut pressure_kpa, mut wrench) = ([0.0; 8], [0.0; 6]);
        reader.read(&[(&ball, pose)], &mut pressure_kpa, &mut wrench);
        (pressure_kpa, -wrench[2])
    };
    assert_eq!(press(-2.0), ([0.0; 8], 0.0));
    let ((shallow_kpa, shallow_n), (deep_kpa, deep_n)) = (press(1.5), press(3.0));
    assert!(0.0 < shallow_n && shallow_n < deep_n, "{shallow_n} {deep_n}");
    assert!(
        shallow_kpa
            .iter()
            .zip(&deep_kpa)
            .all(|(shallow, deep)| shallow < deep),
        "{shallow_kpa:?} {deep_kpa:?}"
    );
    // A ball of this size on a half-space with these constants (Hertz, 1882): 4/3 E / (1 - nu^2)
    // sqrt(R d^3).
    let hertz_n = 4.0 / 3.0 * 45.4e-3 / (1.0 - 0.495_f32.powi(2)) * (6.0_f32 * 1.5_f32.powi(3)).sqrt();
    assert!(
        (0.6..1.4).contains(&(shallow_n / hertz_n)),
        "{shallow_n} {hertz_n}"
    );
}

/// The OOD score of a ball, from a surrogate that is trained on the presses at some locations only.
fn ood_score_of_a_ball(
    is_trained_on: impl Fn(&DVec3) -> bool,
    (n_steps, n_held_out): (usize, usize),
) -> impl FnMut(DVec3) -> f32 {
    let sensor = SensorFile::phystac().unwrap().sensor;
    let mut trained_on = presses(&sensor);
    trained_on.retain(|press| is_trained_on(&press.frames[0].gel_from_indenter.position_mm));
    let held_out = presses(&sensor)[..n_held_out].to_vec();
    let settings = TrainSettings {
        n_steps,
        n_frames: 16,
        ..TrainSettings::default()
    };
    let gel = FastGel::train(&sensor, (&trained_on, &held_out), &settings, 1, &mut |_| ()).unwrap();
    let (mut reader, ball) = (gel.reader(), ball());
    move |at_mm| reader.ood_score(&[(&ball, Pose::from_position(at_mm))])
}

#[test]
fn a_location_without_training_presses_is_out_of_distribution() {
    let (middle, edge) = (DVec3::new(0.0, 0.0, 7.5), DVec3::new(13.0, 0.0, 7.5));
    let mut in_the_middle = ood_score_of_a_ball(|at| at.x.abs() < 7.0, (3, 0));
    assert!(in_the_middle(middle) < 1.0 && in_the_middle(edge) > 1.0);
    let mut at_the_edge = ood_score_of_a_ball(|at| at.x.abs() > 7.0, (3, 0));
    assert!(at_the_edge(middle) > 1.0 && at_the_edge(edge) < 1.0);
    // A gel that is its own mirror image is also trained on the other side.
    let mut on_the_left = ood_score_of_a_ball(|at| at.x < -7.0, (3, 0));
    assert!(on_the_left(middle) > 1.0 && on_the_left(edge) < 1.0);
    // A ball above an untrained location has no contact.
    assert_eq!(on_the_left(DVec3::new(0.0, 0.0, 10.6)), 0.0);
}

#[test]
fn a_gel_that_learned_next_to_nothing_knows_nothing() {
    let place = DVec3::new(0.0, 0.0, 7.5);
    assert!(ood_score_of_a_ball(|_| true, (1, 0))(place) < 1.0);
    assert!(ood_score_of_a_ball(|_| true, (1, 15))(place) > 1.0);
}

#[test]
fn a_group_without_frames_has_no_figures() {
    let (gel, mut presses) = gel(3);
    presses.retain(|press| press.frames[0].gel_from_indenter.position_mm.x.abs() > 7.0);
    let evaluation = gel.evaluate(&presses, &Surfaces::new()).unwrap();
    let groups: Vec<(&str, bool)> = evaluation
        .by_place
        .iter()
        .map(|(name, errors)| (name.as_str(), errors.is_some()))
        .collect();
    let expected = [
        ("0 to 25 %", false),
        ("25 to 50 %", false),
        ("50 to 75 %", true),
        ("75 to 100 %", false),
    ];
    assert_eq!(groups, expected);
    assert!(evaluation.at_edge.is_some());
    assert!(evaluation.by_depth_mm[&0].is_none() && evaluation.by_depth_mm[&3].is_some());

    let none = gel.evaluate(&[], &Surfaces::new()).unwrap();
    let text = serde_json::to_string(&none).unwrap();
    assert!(
        text.contains(r#""overall":null"#) && text.contains(r#""0 to 25 %":null"#),
        "{text}"
    );
    assert!(
        text.contains(r#""untouched_percent":null"#) && !text.contains("0.0"),
        "{text}"
    );
}

#[test]
fn numbers_that_are_none_are_not_read() {
    let (gel, _) = gel(1);
    let mut bytes = gel.to_bytes().unwrap();
    // The last tensor ends the file.
    let at = bytes.len() - 4;
    bytes[at..].copy_from_slice(&f32::NAN.to_le_bytes());
    let error = FastGel::from_bytes(&bytes).unwrap_err().to_string();
    assert!(error.contains("numbers that are not finite"), "{error}");
}

#[test]
fn proximity_rises_from_the_reach_to_the_surface() {
    let (gel, _) = gel(1);
    let (bodies, mut reader) = ([ball()], gel.reader());
    // Over a point of the grid. The gel is 8.5 mm high; a ball stands on its origin.
    let gaps_mm = [3.0, 2.0, 1.5, 1.0, 0.5, 0.0, -1.0];
    let touches: Vec<Touch> = gaps_mm
        .iter()
        .map(|gap_mm| Touch {
            body: 0,
            gel_from_body: Pose::from_position(DVec3::new(0.0, 0.0, 8.5 + gap_mm)),
        })
        .collect();
    let ends: Vec<usize> = (1..=gaps_mm.len()).chain([gaps_mm.len()]).collect();
    let (mut pressure_kpa, mut wrench) = (vec![0.0; 8 * ends.len()], vec![[0.0; 6]; ends.len()]);
    reader.read_many(&bodies, &touches, &ends, &mut pressure_kpa, &mut wrench);
    let expected = [0.0, 0.0, 0.25, 0.5, 0.75, 1.0, 1.0, 0.0];
    assert_eq!(reader.proximity().len(), expected.len());
    for (found, expected) in reader.proximity().iter().zip(expected) {
        assert!((found - expected).abs() < 1e-5, "{:?}", reader.proximity());
    }
}

#[test]
fn what_is_behind_the_sensor_does_not_press_it() {
    let (gel, _) = gel(1);
    let mut reader = gel.reader();
    let shapes = [
        Shape::Sphere { radius_mm: 5.0 },
        Shape::Box {
            size_mm: [60.0, 60.0, 60.0],
            edge_radius_mm: 0.0,
        },
        Shape::Box {
            size_mm: [1000.0, 1000.0, 40.0],
            edge_radius_mm: 0.0,
        },
        Shape::Cylinder {
            radius_mm: 10.0,
            height_mm: 30.0,
            edge_radius_mm: 0.5,
        },
        Shape::Ring {
            outer_radius_mm: 6.0,
            inner_radius_mm: 2.0,
            height_mm: 8.0,
            edge_radius_mm: 0.3,
        },
    ];
    let tilts = [0.0, 0.1, 0.26].map(DQuat::from_rotation_y);
    for shape in &shapes {
        let body = Body::new(shape, &Surfaces::new()).unwrap();
        let height_mm = match shape {
            Shape::Sphere { radius_mm } => 2.0 * radius_mm,
            Shape::Box { size_mm, .. } => size_mm[2],
            Shape::Cylinder { height_mm, .. } | Shape::Ring { height_mm, .. } => *height_mm,
            _ => unreachable!("the shapes above"),
        };
        for tilt in tilts {
            for behind_mm in [2.0, 5.0, 20.0, 100.0, 1e6] {
                // The middle of its top is below the base.
                let top = tilt * DVec3::new(0.0, 0.0, height_mm);
                let pose = Pose {
                    position_mm: DVec3::new(0.0, 0.0, -behind_mm) - top,
                    rotation: tilt,
                };
                let (mut pressure_kpa, mut wrench) = ([0.0; 8], [0.0; 6]);
                reader.read(&[(&body, pose)], &mut pressure_kpa, &mut wrench);
                assert_eq!(
                    (pressure_kpa, wrench),
                    ([0.0; 8], [0.0; 6]),
                    "{shape:?} {behind_mm} mm behind"
                );
            }
        }
    }
}
