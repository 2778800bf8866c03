//! Thin bodies, and bodies whose top is below the gel's surface, press like bodies that continue
//! upward; bodies too narrow for the grid have an OOD score above 1.

#![allow(clippy::unwrap_used)] // also in the helpers of tests

use std::sync::Arc;

use glam::{DQuat, DVec3};
use twintac_fast::{Body, FastGel, FastReader};
use twintac_sensor::SensorFile;
use twintac_shape::{Part, Pose, Shape, SurfaceFile, Surfaces, TriangleSurface};

/// Height of PhysTac's gel, mm.
const TOP_MM: f64 = 8.5;
/// On points of the grid, and between them, mm.
const PLACES_MM: [[f64; 2]; 2] = [[0.0, 0.0], [0.7, 0.4]];
const THIN_MM: [f64; 4] = [0.3, 0.5, 1.0, 3.0];
const DEPTHS_MM: [f64; 8] = [0.2, 0.5, 0.8, 1.1, 1.5, 2.0, 2.5, 3.0];
/// Height of bodies whose top never goes below the surface, mm.
const TALL_MM: f64 = 14.0;

fn body(shape: &Shape) -> Body {
    Body::new(shape, &Surfaces::new()).unwrap()
}

fn plate(size_mm: [f64; 3]) -> Shape {
    Shape::Box {
        size_mm,
        edge_radius_mm: 0.0,
    }
}

fn coin(height_mm: f64) -> Shape {
    Shape::Cylinder {
        radius_mm: 6.0,
        height_mm,
        edge_radius_mm: 0.0,
    }
}

fn ring(wall_mm: f64, height_mm: f64) -> Shape {
    Shape::Ring {
        outer_radius_mm: 6.5,
        inner_radius_mm: 6.5 - wall_mm,
        height_mm,
        edge_radius_mm: 0.0,
    }
}

/// The same shape, known by samples instead of a formula.
fn sampled(shape: Shape) -> Shape {
    union(vec![(shape, DVec3::ZERO)])
}

fn union(parts: Vec<(Shape, DVec3)>) -> Shape {
    let part = |(shape, at_mm)| Part {
        shape,
        whole_from_part: Pose::from_position(at_mm),
    };
    Shape::Union {
        parts: parts.into_iter().map(part).collect(),
    }
}

fn flat(height_mm: f64) -> Vec<(&'static str, Shape)> {
    vec![
        ("plate", plate([10.0, 8.0, height_mm])),
        ("coin", coin(height_mm)),
        ("ring", ring(3.0, height_mm)),
        ("sampled plate", sampled(plate([10.0, 8.0, height_mm]))),
        ("sampled coin", sampled(coin(height_mm))),
    ]
}

fn at(place_mm: [f64; 2], depth_mm: f64, tilt: f64) -> Pose {
    Pose {
        position_mm: DVec3::new(place_mm[0], place_mm[1], TOP_MM - depth_mm),
        rotation: DQuat::from_rotation_y(tilt),
    }
}

/// All locations and depths.
fn each() -> impl Iterator<Item = ([f64; 2], f64)> {
    PLACES_MM
        .into_iter()
        .flat_map(|place_mm| DEPTHS_MM.map(|depth_mm| (place_mm, depth_mm)))
}

fn force_n(reader: &mut FastReader, body: &Body, pose: Pose) -> f32 {
    let (mut pressure_kpa, mut wrench) = ([0.0; 8], [0.0; 6]);
    reader.read(&[(body, pose)], &mut pressure_kpa, &mut wrench);
    -wrench[2]
}

/// A surface of boxes; the triangles of the first face outward, those of the others inward.
fn boxes(boxes: &[([f64; 3], f64)]) -> (Shape, Surfaces) {
    let mut triangles = Vec::new();
    for (half_mm, middle_mm) in boxes {
        let corner = |number: usize| {
            let side = |axis: usize| {
                if number >> axis & 1 == 1 {
                    half_mm[axis]
                } else {
                    -half_mm[axis]
                }
            };
            DVec3::new(side(0), side(1), side(2) + middle_mm)
        };
        for [a, b, c, d] in [
            [0, 2, 3, 1],
            [4, 5, 7, 6],
            [0, 1, 5, 4],
            [2, 6, 7, 3],
            [0, 4, 6, 2],
            [1, 3, 7, 5],
        ] {
            triangles.push([a, b, c].map(corner));
            triangles.push([a, c, d].map(corner));
        }
    }
    let inner = triangles.split_off(12);
    triangles.extend(inner.into_iter().map(|[a, b, c]| [a, c, b]));
    let surface = TriangleSurface::from_triangles(&triangles).unwrap();
    let file = SurfaceFile::new("boxes.stl");
    let surfaces = Surfaces::from([(file.name().to_string(), Arc::new(surface))]);
    (Shape::Stl(file), surfaces)
}

#[test]
fn a_plate_that_is_deeper_than_it_is_thick_presses_like_a_block() {
    let mut reader = FastGel::phystac().unwrap().reader();
    let thin_n = force_n(
        &mut reader,
        &body(&plate([10.0, 8.0, 1.0])),
        at([0.0; 2], 1.5, 0.0),
    );
    let thick_n = force_n(
        &mut reader,
        &body(&plate([10.0, 8.0, 6.0])),
        at([0.0; 2], 1.5, 0.0),
    );
    assert!((thin_n / thick_n - 1.0).abs() < 1e-4, "{thin_n} {thick_n}");
}

#[test]
fn what_is_thin_presses_as_what_is_thick() {
    let mut reader = FastGel::phystac().unwrap().reader();
    for height_mm in THIN_MM {
        for ((name, thin), (_, tall)) in flat(height_mm).into_iter().zip(flat(TALL_MM)) {
            let (thin, tall) = (body(&thin), body(&tall));
            for (place_mm, tilt) in PLACES_MM
                .into_iter()
                .flat_map(|place_mm| [0.0, 0.1, 0.2].map(|tilt| (place_mm, tilt)))
            {
                for depth_mm in DEPTHS_MM {
                    let pose = at(place_mm, depth_mm, tilt);
                    let [thin_n, tall_n] = [&thin, &tall].map(|body| force_n(&mut reader, body, pose));
                    let ood_score = reader.ood_score(&[(&thin, pose)]);
                    assert!(
                        (thin_n / tall_n - 1.0).abs() < 0.05 || ood_score > 1.0,
                        "{name} of {height_mm} mm, {depth_mm} mm deep, tilted by {tilt}, at {place_mm:?}: {thin_n} N, {tall_n} N, {ood_score}"
                    );
                }
            }
        }
    }
}

#[test]
fn a_coin_that_is_pushed_rests_on_the_gel() {
    let mut reader = FastGel::phystac().unwrap().reader();
    let mut rests_mm = |height_mm: f64, push_n: f32| {
        let coin = body(&coin(height_mm));
        let mut depth_mm = 0.0;
        for _ in 0..400 {
            let more_n = push_n - force_n(&mut reader, &coin, at([1.0, 0.5], depth_mm, 0.02));
            depth_mm += 0.1 * f64::from(more_n).min(1.0);
        }
        depth_mm
    };
    for push_n in [0.5, 1.0, 2.0, 3.0] {
        let thick_mm = rests_mm(10.0, push_n);
        for height_mm in [0.3, 1.0] {
            let thin_mm = rests_mm(height_mm, push_n);
            assert!(
                (thin_mm - thick_mm).abs() < 0.02,
                "{height_mm} mm, {push_n} N: {thin_mm}, {thick_mm}"
            );
        }
    }
}

#[test]
fn closed_cavities_are_filled() {
    let mut reader = FastGel::phystac().unwrap().reader();
    for wall_mm in [0.1, 0.3, 1.0, 2.0] {
        let inner = ([5.0, 4.0, 3.0].map(|half: f64| half - wall_mm), 3.0);
        let [hollow, solid] =
            [vec![([5.0, 4.0, 3.0], 3.0), inner], vec![([5.0, 4.0, 3.0], 3.0)]].map(|parts| {
                let (shape, surfaces) = boxes(&parts);
                Body::new(&shape, &surfaces).unwrap()
            });
        for depth_mm in DEPTHS_MM {
            let pose = at([0.0; 2], depth_mm, 0.1);
            let [hollow_n, solid_n] = [&hollow, &solid].map(|body| force_n(&mut reader, body, pose));
            assert_eq!(hollow_n, solid_n, "{wall_mm} mm, {depth_mm} mm deep");
        }
    }
}

#[test]
fn nothing_is_lost_and_nothing_jumps_as_bodies_sink() {
    let mut reader = FastGel::phystac().unwrap().reader();
    let bodies = THIN_MM.into_iter().flat_map(flat);
    let balls = [1.0, 2.5].map(|radius_mm| ("ball", Shape::Sphere { radius_mm }));
    for (name, shape) in bodies.chain(balls) {
        let body = body(&shape);
        for (place_mm, tilt) in PLACES_MM.into_iter().zip([0.0, 0.15]) {
            let steps = (5..150).map(|step| 0.02 * f64::from(step));
            let forces_n: Vec<f32> = steps
                .map(|depth_mm| force_n(&mut reader, &body, at(place_mm, depth_mm, tilt)))
                .collect();
            for (step, two) in forces_n.windows(2).enumerate() {
                let more_n = two[1] - two[0];
                assert!(
                    more_n > -0.01 * two[0] && more_n < 0.12,
                    "{name} {shape:?}, step {step}, tilted by {tilt}: {two:?} N"
                );
            }
        }
    }
}

#[test]
fn a_sunk_plate_is_felt_in_every_position() {
    let mut reader = FastGel::phystac().unwrap().reader();
    for shape in [
        plate([10.0, 8.0, 0.5]),
        sampled(plate([10.0, 8.0, 1.0])),
        coin(0.3),
    ] {
        let body = body(&shape);
        let mut before_n: Option<f32> = None;
        // Moved in from the side, 2 mm deep.
        for step in 0..200 {
            let now_n = force_n(
                &mut reader,
                &body,
                at([-24.0 + 0.1 * f64::from(step), 0.3], 2.0, 0.0),
            );
            assert!(
                (now_n - before_n.unwrap_or(now_n)).abs() < 0.15,
                "{shape:?} {step}"
            );
            before_n = Some(now_n);
        }
        assert!(before_n > Some(1.5), "{shape:?}: {before_n:?}");
        // Turned over about its middle, which stays 3 mm below the surface.
        for step in 0..=180 {
            let rotation = DQuat::from_rotation_y(f64::from(step).to_radians());
            let middle_mm = DVec3::new(0.3, 0.2, TOP_MM - 3.0);
            let pose = Pose {
                position_mm: middle_mm - rotation * DVec3::new(0.0, 0.0, 0.25),
                rotation,
            };
            let now_n = force_n(&mut reader, &body, pose);
            // On its edge the plate may lie between the points of the grid.
            assert!(
                now_n > 0.1 || reader.ood_score(&[(&body, pose)]) > 1.0,
                "{shape:?} turned by {step}: {now_n}"
            );
        }
    }
}

#[test]
fn what_is_stacked_presses_as_its_lowest_part() {
    let mut reader = FastGel::phystac().unwrap().reader();
    let stack = |n: u32| {
        let part = |number: u32| (coin(1.0), DVec3::new(0.0, 0.0, 2.0 * f64::from(number)));
        body(&union((0..n).map(part).collect()))
    };
    let (one, three) = (stack(1), stack(3));
    for depth_mm in DEPTHS_MM {
        let [one_n, three_n] =
            [&one, &three].map(|body| force_n(&mut reader, body, at([0.0; 2], depth_mm, 0.0)));
        assert!(
            (three_n / one_n - 1.0).abs() < 0.05,
            "{depth_mm} mm: {one_n} N, {three_n} N"
        );
    }
}

#[test]
fn what_is_narrower_than_the_grid_is_new() {
    let mut reader = FastGel::phystac().unwrap().reader();
    let pin = |radius_mm: f64| Shape::Cylinder {
        radius_mm,
        height_mm: TALL_MM,
        edge_radius_mm: 0.0,
    };
    let narrow = [
        ring(0.3, 14.0),
        ring(1.0, 3.0),
        plate([0.3, 10.0, 14.0]),
        plate([1.5, 10.0, 14.0]),
        pin(0.2),
        pin(0.8),
    ];
    for (place_mm, depth_mm) in each() {
        let pose = at(place_mm, depth_mm, 0.0);
        for shape in &narrow {
            let ood_score = reader.ood_score(&[(&body(shape), pose)]);
            assert!(ood_score > 1.0, "{shape:?}, {depth_mm} mm deep: {ood_score}");
        }
    }
}

/// A box without a lid, made of sheets.
fn tray(sheet_mm: f64) -> Shape {
    let sheet = |size_mm: [f64; 3], x_mm: f64, y_mm: f64| (plate(size_mm), DVec3::new(x_mm, y_mm, 0.0));
    let [x_mm, y_mm] = [5.0, 4.0].map(|half| half - 0.5 * sheet_mm);
    union(vec![
        sheet([10.0, 8.0, sheet_mm], 0.0, 0.0),
        sheet([sheet_mm, 8.0, 6.0], x_mm, 0.0),
        sheet([sheet_mm, 8.0, 6.0], -x_mm, 0.0),
        sheet([10.0, sheet_mm, 6.0], 0.0, y_mm),
        sheet([10.0, sheet_mm, 6.0], 0.0, -y_mm),
    ])
}

#[test]
fn a_tray_presses_as_a_block_or_is_new() {
    let mut reader = FastGel::phystac().unwrap().reader();
    let block = body(&plate([10.0, 8.0, TALL_MM]));
    for sheet_mm in THIN_MM {
        let tray = body(&tray(sheet_mm));
        for (place_mm, depth_mm) in each() {
            let pose = at(place_mm, depth_mm, 0.0);
            let [tray_n, block_n] = [&tray, &block].map(|body| force_n(&mut reader, body, pose));
            let ood_score = reader.ood_score(&[(&tray, pose)]);
            assert!(
                (tray_n / block_n - 1.0).abs() < 0.05 || ood_score > 1.0,
                "{sheet_mm} mm, {depth_mm} mm deep: {tray_n} N, {block_n} N, {ood_score}"
            );
        }
    }
}

#[test]
fn widths_of_training_presses_are_in_distribution() {
    let mut reader = FastGel::phystac().unwrap().reader();
    for indenter in &SensorFile::phystac().unwrap().sensor.indenters {
        let body = body(&indenter.shape);
        for tilt in [0.0, 0.1, 0.3] {
            let ood_score = reader.ood_score(&[(&body, at([0.7, 0.4], 1.0, tilt))]);
            assert!(
                ood_score < 1.0,
                "{}, tilted by {tilt}: {ood_score}",
                indenter.name
            );
        }
    }
}
