//! Triangle surfaces, compared with the shapes that they approximate.

#![allow(clippy::unwrap_used)] // also in the helpers of tests

mod common;

use std::f64::consts::PI;
use std::sync::{Arc, LazyLock};

use common::{ascii, ball_triangles, binary, box_triangles};
use glam::{DVec2, DVec3};
use proptest::prelude::*;
use twintac_shape::{Shape, SignedDistance, Solid, SurfaceError, SurfaceFile, Surfaces, TriangleSurface};

static A_BOX: LazyLock<TriangleSurface> =
    LazyLock::new(|| TriangleSurface::from_triangles(&box_triangles(DVec3::new(2.0, 3.0, 1.5))).unwrap());

static FINE_BALL: LazyLock<TriangleSurface> =
    LazyLock::new(|| TriangleSurface::from_triangles(&ball_triangles(3.0, 40)).unwrap());

fn near() -> impl Strategy<Value = DVec3> {
    let coordinate = || prop_oneof![4 => -6.0..6.0, 1 => (-6i32..=6).prop_map(f64::from)];
    (coordinate(), coordinate(), coordinate()).prop_map(|(x, y, z)| DVec3::new(x, y, z))
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 2000, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn a_box_of_triangles_is_a_box(p in near()) {
        let (half, surface) = (DVec3::new(2.0, 3.0, 1.5), &*A_BOX);
        let shape = Shape::Box { size_mm: (2.0 * half).to_array(), edge_radius_mm: 0.0 };
        let shape = shape.signed_distance_field(&Surfaces::new()).unwrap();
        let (found, expected) = (surface.signed_distance(p), shape.signed_distance(p + DVec3::Z * half.z));
        prop_assert!((found.distance_mm - expected.distance_mm).abs() < 1e-12, "{:?}, expected {:?}", found, expected);
        prop_assert!((found.gradient.length() - 1.0).abs() < 1e-12);
    }

    #[test]
    fn a_ball_of_triangles_is_nearly_a_ball(p in near()) {
        let (radius_mm, n) = (3.0, 40);
        let found = FINE_BALL.signed_distance(p);
        // Facets lie inside of the ball by less than the sagitta of their diagonal.
        let sagitta_mm = radius_mm * (1.0 - (PI / f64::from(n) / 2f64.sqrt()).cos());
        let error_mm = found.distance_mm - (p.length() - radius_mm);
        prop_assert!(error_mm > -1e-12 && error_mm < 1.01 * sagitta_mm, "{} mm off, sagitta {}", error_mm, sagitta_mm);
        if found.distance_mm > 0.0 {
            prop_assert!(found.gradient.angle_between(p) < 0.1);
            let rest = FINE_BALL.signed_distance(p - found.gradient * found.distance_mm).distance_mm;
            prop_assert!(rest.abs() < 1e-9);
        }
    }

    #[test]
    fn the_distance_has_no_steps(p in near(), q in near()) {
        let change = FINE_BALL.signed_distance(p).distance_mm - FINE_BALL.signed_distance(q).distance_mm;
        prop_assert!(change.abs() <= p.distance(q) + 1e-12);
    }

    #[test]
    fn no_bytes_make_it_panic(bytes in prop::collection::vec(any::<u8>(), 0..300), is_text in any::<bool>()) {
        let bytes = if is_text { [b"solid ".to_vec(), bytes].concat() } else { bytes };
        prop_assert!(TriangleSurface::from_stl(&bytes, 1.0).is_err());
    }
}

#[test]
fn volumes_and_tops() {
    let surface = TriangleSurface::from_triangles(&box_triangles(DVec3::new(2.0, 3.0, 1.5))).unwrap();
    assert!((surface.volume_mm3() - 72.0).abs() < 1e-12);
    assert_eq!((surface.vertices_mm().len(), surface.triangles().len()), (8, 12));
    assert_eq!(surface.top_height_mm(DVec2::new(0.3, 0.4)), Some(1.5));
    assert_eq!(surface.top_height_mm(DVec2::new(2.1, 0.0)), None);
    let ball = TriangleSurface::from_triangles(&ball_triangles(3.0, 60)).unwrap();
    assert!((ball.volume_mm3() / (4.0 / 3.0 * PI * 27.0) - 1.0).abs() < 0.003);
    assert!((ball.top_height_mm(DVec2::new(1.0, 1.0)).unwrap() - 7f64.sqrt()).abs() < 0.01);
}

#[test]
fn indenters_and_gels_of_triangles() {
    let surface =
        Arc::new(TriangleSurface::from_triangles(&box_triangles(DVec3::new(2.0, 3.0, 1.5))).unwrap());
    let surfaces = Surfaces::from([("tip.stl".to_owned(), surface)]);
    let file = SurfaceFile::new("tip.stl");
    let shape = Shape::Stl(file.clone()).signed_distance_field(&surfaces).unwrap();
    assert_eq!(
        shape.bounds_mm(),
        (DVec3::new(-2.0, -3.0, 0.0), DVec3::new(2.0, 3.0, 3.0))
    );
    assert!((shape.signed_distance(-DVec3::Z).distance_mm - 1.0).abs() < 1e-12);
    let gel = Solid::Stl(file);
    assert!(gel.contains(DVec3::ZERO, 0.0, &surfaces) && !gel.contains(DVec3::Z * 2.0, 0.0, &surfaces));
    assert_eq!(gel.volume_mm3(&surfaces), 72.0);
}

#[test]
fn binary_and_text_files_hold_the_same() {
    let triangles = ball_triangles(2.0, 12);
    let from_binary = TriangleSurface::from_stl(&binary(&triangles), 1.0).unwrap();
    let rounded = triangles
        .iter()
        .map(|corners| corners.map(|corner| corner.as_vec3().as_dvec3()));
    let from_text = TriangleSurface::from_stl(ascii(&rounded.collect::<Vec<_>>()).as_bytes(), 1.0).unwrap();
    assert_eq!(from_binary.vertices_mm(), from_text.vertices_mm());
    assert_eq!(from_binary.triangles(), from_text.triangles());
    // Caps have a triangle without area in each quadrilateral, which is left out: 2 · 24 · 12 less
    // 2 · 24.
    assert_eq!(from_binary.triangles().len(), 528);
}

#[test]
fn broken_files_say_what_is_wrong() {
    let good = box_triangles(DVec3::ONE);
    let error = |bytes: &[u8]| TriangleSurface::from_stl(bytes, 1.0).unwrap_err();
    let bytes = binary(&good);
    for length in 1..bytes.len() {
        let found = error(&bytes[..length]);
        // The comment of the binary header alone is a text without triangles.
        let expected = match length {
            ..=81 => matches!(found, SurfaceError::Empty { .. } | SurfaceError::Length { .. }),
            _ => matches!(found, SurfaceError::Length { .. }),
        };
        assert!(expected, "{length}: {found}");
    }
    let mut unlike = bytes.clone();
    unlike[..5].copy_from_slice(b"cube ");
    assert_eq!(
        error(&unlike[..600]),
        SurfaceError::Length {
            expected_bytes: 684,
            found_bytes: 600
        }
    );

    let text = ascii(&good);
    assert!(matches!(
        error(&text.as_bytes()[..text.len() / 2]),
        SurfaceError::Text { .. }
    ));
    let wrong = error(text.replacen("vertex", "vertices", 1).as_bytes());
    assert_eq!(
        wrong.to_string(),
        "line 4: `vertices` is not expected in an STL file"
    );
    let short = error(text.replacen("vertex -1", "vertex", 1).as_bytes());
    assert_eq!(short.to_string(), "line 4: a vertex needs three numbers");
    let words = error(text.replacen("vertex -1", "vertex -1,0", 1).as_bytes());
    assert_eq!(
        words.to_string(),
        "line 4: a vertex needs three numbers, not `-1,0`"
    );
    let nowhere = error(text.replacen("vertex -1", "vertex nan", 1).as_bytes());
    assert_eq!(nowhere, SurfaceError::NotFinite { triangle: 0 });

    let surface_error = |triangles: &[[DVec3; 3]]| TriangleSurface::from_triangles(triangles).unwrap_err();
    assert!(matches!(
        surface_error(&good[1..]),
        SurfaceError::NotClosed { edges: 3, .. }
    ));
    assert_eq!(surface_error(&[]), SurfaceError::Empty { triangles: 0 });
}
