//! A fast gel that learned a few invented lessons: what readings have to obey whatever was learned.

#![allow(clippy::unwrap_used)] // also in the helpers of tests

use glam::{DQuat, DVec2, DVec3};
use twintac_fast::{Body, FastGel, Lesson, LessonFrame, Touch, TrainSettings, lesson_places_mm};
use twintac_sensor::{Sensor, SensorFile};
use twintac_shape::{Pose, Shape, Surfaces};

/// A gel whose floor reads how deep a ball is, the less the further away.
fn lessons(sensor: &Sensor) -> Vec<Lesson> {
    let places = lesson_places_mm(sensor);
    let top_mm = sensor.gel.solid.bounds_mm(&sensor.surfaces).1.z;
    let lesson = |number: u32| {
        let at = DVec3::new(
            f64::from(number % 5) * 6.0 - 12.0,
            f64::from(number % 3) * 5.0 - 5.0,
            top_mm,
        );
        let frame = |depth_mm: f64| {
            let gel_from_indenter = Pose::from_position(at - DVec3::Z * depth_mm);
            let falls = |place: &glam::DVec2| (-place.distance_squared(at.truncate()) / 30.0).exp();
            LessonFrame {
                gel_from_indenter,
                force_n: DVec3::new(0.0, 0.0, -2.0 * depth_mm),
                torque_n_mm: at.cross(DVec3::new(0.0, 0.0, -2.0 * depth_mm)),
                floor_kpa: places
                    .iter()
                    .map(|place| (10.0 * depth_mm * falls(place)) as f32)
                    .collect(),
            }
        };
        Lesson {
            shape: Shape::Sphere { radius_mm: 5.0 },
            edge_mm: 0.7,
            frames: [1.0, 2.0, 3.0].map(frame).to_vec(),
        }
    };
    (0..15).map(lesson).collect()
}

fn gel(n_steps: usize) -> (FastGel, Vec<Lesson>) {
    gel_of(&SensorFile::phystac().unwrap().sensor, n_steps)
}

fn gel_of(sensor: &Sensor, n_steps: usize) -> (FastGel, Vec<Lesson>) {
    let settings = TrainSettings {
        n_steps,
        n_frames: 16,
        ..TrainSettings::default()
    };
    let lessons = lessons(sensor);
    let gel = FastGel::train(sensor, &lessons, &settings, 1, &mut |_| ()).unwrap();
    (gel, lessons)
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
fn lessons_are_learned() {
    let (gel, lessons) = gel(400);
    let judged = gel.judge(&lessons, &Surfaces::new()).unwrap();
    assert!(judged.overall.nearest_percent < 12.0, "{judged:?}");
    assert!(judged.overall.force_percent < 25.0, "{judged:?}");
    assert_eq!(judged.by_shape.keys().collect::<Vec<_>>(), ["sphere"]);
    assert_eq!(judged.overall.n_frames, 45);
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
    let (gel, lessons) = gel_of(&sensor, 200);
    let judged = gel.judge(&lessons, &Surfaces::new()).unwrap();
    assert!(judged.overall.nearest_percent < 12.0, "{judged:?}");

    let again = FastGel::from_bytes(&gel.to_bytes().unwrap()).unwrap();
    assert_eq!(again, gel);
    let ball = ball();
    let there = [(&ball, Pose::from_position(DVec3::new(-4.0, 4.0, 17.0)))];
    let own = read(&gel, &there);
    assert_eq!(read(&again, &there), own);

    // Other places are read by the network of all places, the force as before.
    let (as_places_kpa, wrench) = read(&gel.with_ports(gel.ports_mm()), &there);
    assert_ne!(as_places_kpa, own.0);
    assert_eq!(wrench, own.1);

    // A sensor of many reads what it reads alone.
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
    let number = br#"\"version\":5"#;
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
        assert!(error.contains("not a fast twin"), "{error}");
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
    // The third of each five sensors is touched by nothing, the others by one or two bodies.
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
        let mut reader = gel.with_ports(places_mm).reader();
        reader.read(&there, &mut pressure_kpa, &mut [0.0; 6]);
        pressure_kpa
    };
    let taxels = [-12.0, -4.0, 4.0, 12.0].map(|x| DVec2::new(x, -4.0));
    assert_eq!(pressures(&taxels), read(&gel, &there).0[..4]);
    // Places equally far behind their points share rows: each reads what it reads alone.
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
fn a_contact_unlike_what_was_taught_is_new() {
    let (gel, _) = gel(3);
    let mut reader = gel.reader();
    let thin = Body::new(&Shape::Sphere { radius_mm: 1.0 }, &Surfaces::new()).unwrap();
    let at = |z_mm: f64| Pose::from_position(DVec3::new(0.0, 0.0, z_mm));
    // A lesson presses a ball 1, 2 and 3 mm deep there.
    assert!(reader.novelty(&[(&ball(), at(7.5))]) < 1.0);
    assert!(reader.novelty(&[(&thin, at(7.5))]) > 1.0);
    assert!(reader.novelty(&[(&ball(), at(3.5))]) > 1.0);
    assert_eq!(reader.novelty(&[(&ball(), at(12.0))]), 0.0);
    // Between the points of the grid, none of which is inside it.
    let between = Pose::from_position(DVec3::new(1.0, 1.0, 8.0));
    assert!(reader.novelty(&[(&thin, between)]) > 1.0);
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
    // A ball of this size on a half-space with these constants (Hertz, 1882): 4/3 E / (1 - nu^2) sqrt(R d^3).
    let hertz_n = 4.0 / 3.0 * 45.4e-3 / (1.0 - 0.495_f32.powi(2)) * (6.0_f32 * 1.5_f32.powi(3)).sqrt();
    assert!(
        (0.6..1.4).contains(&(shallow_n / hertz_n)),
        "{shallow_n} {hertz_n}"
    );
}
