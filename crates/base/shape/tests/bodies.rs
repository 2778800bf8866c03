//! Surfaces of several bodies, surfaces that face the wrong way, and surfaces without an interior.

#![allow(clippy::unwrap_used)] // also in the helpers of tests

mod common;

use std::f64::consts::TAU;
use std::sync::Arc;

use common::{ball_triangles, box_triangles, moved, turned};
use glam::{DVec2, DVec3};
use twintac_shape::{Shape, SignedDistance, SurfaceError, SurfaceFile, Surfaces, TriangleSurface};

type Triangles = Vec<[DVec3; 3]>;

fn surface(bodies: &[Triangles]) -> TriangleSurface {
    TriangleSurface::from_triangles(&bodies.concat()).unwrap()
}

fn error(bodies: &[Triangles]) -> SurfaceError {
    let surface = TriangleSurface::from_triangles(&bodies.concat());
    surface.map(|surface| surface.volume_mm3()).unwrap_err()
}

fn cube(half_mm: f64, at_mm: [f64; 3]) -> Triangles {
    moved(&box_triangles(DVec3::splat(half_mm)), at_mm.into())
}

/// The same box, with the other diagonals of its faces.
fn other_diagonals(triangles: &Triangles) -> Triangles {
    let sides = triangles.chunks_exact(2).map(|pair| {
        let ([a, b, c], [_, _, d]) = (pair[0], pair[1]);
        [[b, c, d], [b, d, a]]
    });
    sides.flatten().collect()
}

fn distance_mm(surface: &TriangleSurface, x: f64, y: f64, z: f64) -> f64 {
    surface.signed_distance(DVec3::new(x, y, z)).distance_mm
}

#[test]
fn bodies_that_face_inwards_are_turned() {
    let (one, other) = (cube(1.0, [0.0; 3]), cube(2.0, [5.0, 0.0, 0.0]));
    let right = surface(&[one.clone(), other.clone()]);
    for bodies in [
        [turned(&one), other.clone()],
        [one.clone(), turned(&other)],
        [turned(&one), turned(&other)],
    ] {
        let mended = surface(&bodies);
        assert!((mended.volume_mm3() - 72.0).abs() < 1e-12);
        for at in 0..40 {
            let x = -2.0 + 0.25 * f64::from(at);
            let found = mended.signed_distance(DVec3::new(x, 0.3, 0.2));
            assert_eq!(found, right.signed_distance(DVec3::new(x, 0.3, 0.2)), "{x}");
        }
    }
    // Some triangles that face another way than the rest.
    let mut some = ball_triangles(3.0, 12);
    let volume_mm3 = surface(&[some.clone()]).volume_mm3();
    for triangle in some.iter_mut().step_by(7) {
        triangle.swap(0, 1);
    }
    assert!((surface(&[some]).volume_mm3() / volume_mm3 - 1.0).abs() < 1e-12);
}

#[test]
fn a_body_within_another_is_a_cavity_if_it_faces_against_it() {
    let (outer, inner) = (cube(5.0, [0.0; 3]), cube(2.0, [1.0, 0.5, 0.0]));
    for bodies in [
        [outer.clone(), turned(&inner)],
        [turned(&inner), outer.clone()],
        [turned(&outer), inner.clone()],
    ] {
        let hollow = surface(&bodies);
        assert!((hollow.volume_mm3() - (1000.0 - 64.0)).abs() < 1e-9);
        assert!(
            (distance_mm(&hollow, 1.0, 0.5, 0.0) - 2.0).abs() < 1e-12,
            "air in the middle"
        );
        assert!(
            (distance_mm(&hollow, -2.0, 0.0, 0.0) + 1.0).abs() < 1e-12,
            "material beside it"
        );
        assert_eq!(hollow.bodies_meet_at_mm(), None);
        // A ball inside of the cavity is again a body.
        let ball = moved(&ball_triangles(1.0, 20), DVec3::new(1.0, 0.5, 0.0));
        let outer_faces_out = bodies.contains(&outer);
        let filled = surface(&[
            bodies.concat(),
            if outer_faces_out { ball } else { turned(&ball) },
        ]);
        assert!(distance_mm(&filled, 1.0, 0.5, 0.0) < -0.9);
    }
    let full = surface(&[outer.clone(), inner.clone()]);
    assert!(
        (distance_mm(&full, 1.0, 0.5, 0.0) + 4.0).abs() < 1e-12,
        "nothing but material"
    );
    assert!(full.bodies_meet_at_mm().is_some());
    let nested = error(&[outer, turned(&inner), turned(&cube(1.0, [1.0, 0.5, 0.0]))]);
    assert!(matches!(nested, SurfaceError::Nested { body: 2, .. }), "{nested}");
}

#[test]
fn cavities_of_what_presses_are_filled() {
    let hollow = surface(&[
        cube(5.0, [0.0; 3]),
        turned(&cube(4.0, [0.0; 3])),
        cube(1.0, [0.0; 3]),
    ]);
    assert!((distance_mm(&hollow, 4.8, 0.0, 0.0) + 0.2).abs() < 1e-12);
    assert!(distance_mm(&hollow, 3.0, 0.0, 0.0) > 0.0);
    let surfaces = Surfaces::from([("hollow.stl".to_owned(), Arc::new(hollow))]);
    let shape = Shape::Stl(SurfaceFile::new("hollow.stl"));
    let presses = shape.signed_distance_field(&surfaces).unwrap();
    // Its lowest point is at z = 0.
    let distance_mm = |x_mm: f64| presses.signed_distance(DVec3::new(x_mm, 0.0, 5.0)).distance_mm;
    assert!((distance_mm(3.0) + 2.0).abs() < 1e-12);
    assert!((distance_mm(4.8) + 0.2).abs() < 1e-12);
    assert!((distance_mm(6.0) - 1.0).abs() < 1e-12);
}

#[test]
fn bodies_that_overlap_are_united() {
    // Tilted, and with faces in common planes.
    for (size, other) in [
        (2.0, [3.1, 2.9, 3.3]),
        (2.0, [2.0, 0.0, 0.0]),
        (2.0, [2.5, 2.5, 0.0]),
    ] {
        let (one, other) = (cube(size, [0.0; 3]), cube(size, other));
        let both = surface(&[one.clone(), other.clone()]);
        let (alone, beside) = (surface(&[one]), surface(&[other]));
        for at in 0..4000 {
            let part = |prime: f64| -3.0 + 9.0 * (f64::from(at) * prime).fract();
            let point = DVec3::new(part(0.618_034), part(0.754_878), part(0.569_84));
            let (a, b) = (
                alone.signed_distance(point).distance_mm,
                beside.signed_distance(point).distance_mm,
            );
            assert!(
                (both.signed_distance(point).distance_mm - a.min(b)).abs() < 1e-12,
                "{point}"
            );
        }
        assert!(both.bodies_meet_at_mm().is_some());
    }
    assert_eq!(
        surface(&[cube(1.0, [0.0; 3]), cube(1.0, [2.5, 0.0, 0.0])]).bodies_meet_at_mm(),
        None
    );
}

#[test]
fn boxes_that_share_a_face_are_read() {
    let (left, right) = (cube(2.0, [-2.0, 0.0, 0.0]), cube(2.0, [2.0, 0.0, 0.0]));
    let whole = TriangleSurface::from_triangles(&box_triangles(DVec3::new(4.0, 2.0, 2.0))).unwrap();
    for (name, right) in [
        ("the same diagonals", right.clone()),
        ("other diagonals", other_diagonals(&right)),
        ("a smaller face", cube(1.0, [1.0, 0.5, 0.0])),
        ("an edge", cube(2.0, [2.0, 4.0, 0.0])),
        ("a corner", cube(2.0, [2.0, 4.0, 4.0])),
    ] {
        let both = surface(&[left.clone(), right.clone()]);
        let [one, other] = [&left, &right].map(|body| surface(std::slice::from_ref(body)));
        let apart = other.volume_mm3();
        assert!(
            (both.volume_mm3() - 64.0 - apart).abs() < 1e-9,
            "{name}: {}",
            both.volume_mm3()
        );
        for at in 0..2000 {
            let part = |prime: f64| -6.0 + 12.0 * (f64::from(at) * prime).fract();
            let point = DVec3::new(part(0.618_034), part(0.754_878), part(0.569_84));
            let found = both.signed_distance(point).distance_mm;
            let expected = one
                .signed_distance(point)
                .distance_mm
                .min(other.signed_distance(point).distance_mm);
            assert!(
                found <= 0.0 || (found - expected).abs() < 1e-12,
                "{name}: {found} at {point}"
            );
            assert_eq!(
                found < 0.0,
                expected < 0.0,
                "{name}: {found}, {expected} at {point}"
            );
            if name.contains("diagonals") && found > 0.0 {
                assert!(
                    (found - whole.signed_distance(point).distance_mm).abs() < 1e-12,
                    "{name}"
                );
            }
        }
    }
    // Where the triangles are the same, no wall remains between the bodies.
    let joined = surface(&[left.clone(), right.clone()]);
    assert!((distance_mm(&joined, 0.0, 0.0, 0.0) + 2.0).abs() < 1e-12);
    assert_eq!(joined.bodies_meet_at_mm(), None);
    assert!(
        surface(&[left, other_diagonals(&right)])
            .bodies_meet_at_mm()
            .is_some()
    );
}

#[test]
fn nearly_equal_corners_are_welded_and_open_edges_are_not() {
    let mut off = cube(5.0, [0.0; 3]);
    for (index, corner) in off.iter_mut().flatten().enumerate() {
        let nudge = |prime: f64| 1e-5 * ((index as f64 * prime).fract() - 0.5);
        *corner += DVec3::new(nudge(0.618_034), nudge(0.754_878), nudge(0.569_84));
    }
    let welded = surface(&[off.clone()]);
    assert_eq!((welded.vertices_mm().len(), welded.triangles().len()), (8, 12));
    assert!((welded.volume_mm3() - 1000.0).abs() < 0.01);
    // A gap of 0.05 mm is not closed by welding.
    off[0][0] += DVec3::new(0.05, 0.0, 0.0);
    assert!(matches!(error(&[off]), SurfaceError::NotClosed { .. }));
    let mut open = cube(5.0, [0.0; 3]);
    open.pop();
    assert!(matches!(error(&[open]), SurfaceError::NotClosed { edges: 3, .. }));
}

#[test]
fn triangles_twice_and_without_area_are_left_out() {
    let good = cube(2.0, [0.0; 3]);
    let mut more = [good.clone(), good.clone(), good[3..5].to_vec()].concat();
    let [a, b, _] = good[0];
    more.extend([[a, a, b], [a, b, a], [b, b, b]]);
    let surface = surface(&[more]);
    assert_eq!(surface.triangles().len(), 12);
    assert!((surface.volume_mm3() - 64.0).abs() < 1e-12);
}

#[test]
fn what_encloses_nothing_is_refused() {
    let square = [DVec3::ZERO, DVec3::X, DVec3::new(1.0, 1.0, 0.0), DVec3::Y].map(|corner| 5.0 * corner);
    let sheet: Triangles = vec![
        [square[0], square[1], square[2]],
        [square[0], square[2], square[3]],
    ];
    assert!(matches!(
        error(std::slice::from_ref(&sheet)),
        SurfaceError::Empty { triangles: 2 }
    ));
    assert!(matches!(
        error(&[sheet.clone(), turned(&sheet)]),
        SurfaceError::Empty { triangles: 0 }
    ));
    let other_way: Triangles = vec![
        [square[1], square[0], square[3]],
        [square[1], square[3], square[2]],
    ];
    let flat = error(&[cube(1.0, [9.0, 0.0, 0.0]), sheet, other_way]);
    assert!(matches!(flat, SurfaceError::Flat { body: 1, .. }), "{flat}");
    let line: Triangles = (0..6)
        .map(|i| [0, 1, 2].map(|j| DVec3::X * f64::from(i + j)))
        .collect();
    assert!(TriangleSurface::from_triangles(&line).is_err());
    let nowhere = vec![[DVec3::NAN; 3]; 12];
    assert!(matches!(
        error(&[nowhere]),
        SurfaceError::NotFinite { triangle: 0 }
    ));
}

/// A strip around the z axis that makes this number of half turns on its way.
fn strip(half_turns: f64) -> Triangles {
    let n = 60;
    let edge = |step: usize, side: f64| {
        let share = (step % n) as f64 / n as f64;
        // With an odd number of half turns, the sides of the last step are exchanged where it meets
        // the first.
        let side = if step == n && half_turns.fract() == 0.0 && half_turns as i32 % 2 == 1 {
            -side
        } else {
            side
        };
        let (turn, lean) = (TAU * share, 0.5 * TAU * half_turns * share);
        let out = DVec2::from_angle(turn);
        (out * (8.0 + side * lean.cos())).extend(side * lean.sin())
    };
    let quads = (0..n).map(|step| {
        [
            edge(step, -1.0),
            edge(step, 1.0),
            edge(step + 1, 1.0),
            edge(step + 1, -1.0),
        ]
    });
    quads.flat_map(|[a, b, c, d]| [[a, b, c], [a, c, d]]).collect()
}

/// A tube around the z axis whose end meets its start mirrored: a Klein bottle.
fn klein_bottle() -> Triangles {
    let (n, m) = (40, 12);
    let point = |step: usize, around: usize| {
        let share = step as f64 / n as f64;
        let around = if step == n {
            (m - around % m) % m
        } else {
            around % m
        };
        let angle = TAU * around as f64 / m as f64;
        // The tube is narrow at the seam, where it meets itself.
        let out = DVec2::from_angle(TAU * if step == n { 0.0 } else { share });
        (out * (8.0 + 2.0 * angle.cos())).extend(2.0 * angle.sin())
    };
    let cells = (0..n).flat_map(|step| (0..m).map(move |around| (step, around)));
    cells
        .flat_map(|(i, j)| {
            let (a, b, c, d) = (point(i, j), point(i + 1, j), point(i + 1, j + 1), point(i, j + 1));
            [[a, b, c], [a, c, d]]
        })
        .collect()
}

#[test]
fn one_sided_surfaces_are_refused() {
    assert!(matches!(
        error(&[strip(1.0)]),
        SurfaceError::NotClosed { .. } | SurfaceError::OneSided { .. }
    ));
    assert!(matches!(error(&[klein_bottle()]), SurfaceError::OneSided { .. }));
}

#[test]
fn a_body_that_runs_through_itself_is_refused() {
    let tube = |middle: &dyn Fn(f64) -> DVec2| -> Triangles {
        let (n, m) = (96, 24);
        let point = |step: usize, around: usize| {
            let share = |index: usize, n: usize| TAU * (index % n) as f64 / n as f64;
            let (at, angle) = (share(step, n), share(around, m));
            let along = middle(at + 1e-6) - middle(at - 1e-6);
            let out = DVec2::new(along.y, -along.x).normalize();
            (middle(at) + out * angle.cos()).extend(angle.sin())
        };
        let cells = (0..n).flat_map(|step| (0..m).map(move |around| (step, around)));
        let quads = cells.map(|(i, j)| [point(i, j), point(i + 1, j), point(i + 1, j + 1), point(i, j + 1)]);
        quads.flat_map(|[a, b, c, d]| [[a, b, c], [a, c, d]]).collect()
    };
    let ring = surface(&[tube(&|at| 6.0 * DVec2::from_angle(at))]);
    assert!((ring.volume_mm3() / (0.5 * TAU * TAU * 6.0) - 1.0).abs() < 0.03);
    let eight = error(&[tube(&|at| DVec2::new(12.0 * at.sin(), 8.0 * (2.0 * at).sin()))]);
    assert!(
        matches!(eight, SurfaceError::SelfOverlap { body: 0, share, .. } if share > 0.01),
        "{eight}"
    );
    // Two cones that meet at a common tip; one of them is inside out.
    let rim = |step: usize, z: f64| (2.0 * DVec2::from_angle(TAU * (step % 24) as f64 / 24.0)).extend(z);
    let mut glass: Triangles = Vec::new();
    for step in 0..24 {
        let [low, low_next, high, high_next] = [
            rim(step, -2.0),
            rim(step + 1, -2.0),
            rim(step + 12, 2.0),
            rim(step + 13, 2.0),
        ];
        glass.extend([
            [DVec3::NEG_Z * 2.0, low_next, low],
            [DVec3::Z * 2.0, high, high_next],
        ]);
        glass.extend([[low, low_next, high_next], [low, high_next, high]]);
    }
    let glass = error(&[glass]);
    assert!(
        matches!(
            glass,
            SurfaceError::SelfOverlap { .. } | SurfaceError::Flat { .. }
        ),
        "{glass}"
    );
}
