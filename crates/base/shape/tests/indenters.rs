//! Distances of indenters: closed forms, and properties that every distance must have.

#![allow(clippy::unwrap_used)] // also in the helpers of tests

use glam::{DQuat, DVec2, DVec3};
use proptest::prelude::*;
use twintac_shape::{Part, Pose, Shape, SignedDistance, SurfaceFile, Surfaces};

fn field(shape: &Shape) -> Box<dyn SignedDistance> {
    shape.signed_distance_field(&Surfaces::new()).unwrap()
}

fn shapes(edge_radius_mm: f64) -> Vec<Shape> {
    vec![
        Shape::Sphere { radius_mm: 4.0 },
        Shape::Cylinder {
            radius_mm: 5.0,
            height_mm: 6.0,
            edge_radius_mm,
        },
        Shape::Box {
            size_mm: [8.0, 5.0, 6.0],
            edge_radius_mm,
        },
        Shape::X {
            length_mm: 12.0,
            width_mm: 3.0,
            height_mm: 6.0,
            edge_radius_mm,
        },
        Shape::Ring {
            outer_radius_mm: 6.0,
            inner_radius_mm: 3.0,
            height_mm: 6.0,
            edge_radius_mm,
        },
        Shape::Triangle {
            side_mm: 10.0,
            height_mm: 6.0,
            edge_radius_mm,
        },
        Shape::Wedge {
            angle_rad: 1.2,
            length_mm: 9.0,
            height_mm: 6.0,
            edge_radius_mm,
        },
    ]
}

/// Whether a point is in the sharp shape, by the definition of the shape.
fn is_in(shape: &Shape, p: DVec3) -> bool {
    let within = |height: f64| (0.0..=height).contains(&p.z);
    let from_axis = p.truncate().length();
    match *shape {
        Shape::Sphere { radius_mm } => p.distance(DVec3::Z * radius_mm) <= radius_mm,
        Shape::Cylinder {
            radius_mm, height_mm, ..
        } => from_axis <= radius_mm && within(height_mm),
        Shape::Box {
            size_mm: [x, y, z], ..
        } => p.x.abs() <= 0.5 * x && p.y.abs() <= 0.5 * y && within(z),
        Shape::X {
            length_mm,
            width_mm,
            height_mm,
            ..
        } => {
            let (u, v) = ((p.x + p.y).abs() / 2f64.sqrt(), (p.x - p.y).abs() / 2f64.sqrt());
            within(height_mm) && u.max(v) <= 0.5 * length_mm && u.min(v) <= 0.5 * width_mm
        }
        Shape::Ring {
            outer_radius_mm,
            inner_radius_mm,
            height_mm,
            ..
        } => (inner_radius_mm..=outer_radius_mm).contains(&from_axis) && within(height_mm),
        Shape::Triangle {
            side_mm, height_mm, ..
        } => {
            let inradius = side_mm / (2.0 * 3f64.sqrt());
            let beyond = |degrees: f64| p.truncate().dot(DVec2::from_angle(degrees.to_radians())) > inradius;
            within(height_mm) && !beyond(60.0) && !beyond(180.0) && !beyond(300.0)
        }
        Shape::Wedge {
            angle_rad,
            length_mm,
            height_mm,
            ..
        } => within(height_mm) && p.y.abs() <= 0.5 * length_mm && p.x.abs() <= p.z * (0.5 * angle_rad).tan(),
        Shape::Stl { .. } => false,
        Shape::Union { ref parts } => parts
            .iter()
            .any(|part| is_in(&part.shape, part.whole_from_part.inverse_transform_point(p))),
    }
}

fn near() -> impl Strategy<Value = DVec3> {
    let lattice = (-10i32..=10).prop_map(f64::from);
    let coordinate = prop_oneof![3 => -10.0..10.0, 1 => lattice, 1 => Just(0.0)];
    (coordinate.clone(), coordinate.clone(), coordinate).prop_map(|(x, y, z)| DVec3::new(x, y, z + 3.0))
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 2000, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn the_gradient_is_a_unit_vector(p in near(), which in 0..7usize, edge in 0.0..1.4f64) {
        let found = field(&shapes(edge)[which]).signed_distance(p);
        prop_assert!(found.distance_mm.is_finite());
        prop_assert!((found.gradient.length() - 1.0).abs() < 1e-9, "{:?}", found);
    }

    #[test]
    fn no_distance_changes_faster_than_its_place(p in near(), q in near(), which in 0..7usize, edge in 0.0..1.4f64) {
        let field = field(&shapes(edge)[which]);
        let change = field.signed_distance(p).distance_mm - field.signed_distance(q).distance_mm;
        prop_assert!(change.abs() <= p.distance(q) * (1.0 + 1e-12) + 1e-12);
    }

    #[test]
    fn a_step_along_the_gradient_reaches_the_surface(p in near(), which in 0..7usize, edge in 0.0..1.4f64) {
        let field = field(&shapes(edge)[which]);
        let found = field.signed_distance(p);
        prop_assume!(found.distance_mm > 0.0);
        let closest = p - found.gradient * found.distance_mm;
        let rest = field.signed_distance(closest).distance_mm;
        prop_assert!(rest.abs() < 1e-9, "{:?} leaves {}", found, rest);
    }

    #[test]
    fn the_sign_says_what_is_inside(p in near(), which in 0..7usize) {
        let shape = &shapes(0.0)[which];
        let distance_mm = field(shape).signed_distance(p).distance_mm;
        prop_assume!(distance_mm.abs() > 1e-9);
        prop_assert_eq!(distance_mm < 0.0, is_in(shape, p), "{:?} is {} mm away", p, distance_mm);
    }

    #[test]
    fn rounding_only_takes_away(p in near(), which in 1..6usize, edge in 0.0..1.4f64) {
        // Except for an X, whose concave corners are filled by the rounding.
        prop_assume!(!matches!(shapes(0.0)[which], Shape::X { .. }));
        let (sharp, round) = (field(&shapes(0.0)[which]), field(&shapes(edge)[which]));
        prop_assert!(round.signed_distance(p).distance_mm >= sharp.signed_distance(p).distance_mm - 1e-9);
    }

    #[test]
    fn bounds_hold_the_shape(p in near(), which in 0..7usize, edge in 0.0..1.4f64) {
        let field = field(&shapes(edge)[which]);
        let (low, high) = field.bounds_mm();
        if field.signed_distance(p).distance_mm < -1e-9 {
            prop_assert!(p.cmpge(low - 1e-9).all() && p.cmple(high + 1e-9).all(), "{} outside {} {}", p, low, high);
        }
    }
}

#[test]
fn the_origin_is_the_point_of_first_touch() {
    for edge in [0.0, 0.7] {
        for shape in shapes(edge) {
            let field = field(&shape);
            let (low, _) = field.bounds_mm();
            assert!(low.z.abs() < 1e-12, "{shape:?}: {low}");
            // A ring touches with its rim; the other shapes touch at the origin.
            let at = if matches!(shape, Shape::Ring { .. }) {
                DVec3::X * 4.5
            } else {
                DVec3::ZERO
            };
            assert!(field.signed_distance(at).distance_mm.abs() < 1e-12, "{shape:?}");
            assert!(
                (field.signed_distance(at - DVec3::Z).distance_mm - 1.0).abs() < 1e-12,
                "{shape:?}"
            );
            let below = (0..400).map(|i| DVec3::new(f64::from(i % 20 - 10), f64::from(i / 20 - 10), -1e-6));
            assert!(
                below
                    .into_iter()
                    .all(|p| field.signed_distance(p).distance_mm > 0.0),
                "{shape:?}"
            );
        }
    }
}

#[test]
fn bounds_touch_the_surface() {
    for edge in [0.0, 0.7] {
        for shape in shapes(edge)
            .into_iter()
            .filter(|shape| !matches!(shape, Shape::X { .. } | Shape::Triangle { .. }))
        {
            let field = field(&shape);
            let (low, high) = field.bounds_mm();
            let middle = 0.5 * (low + high);
            // A rounded wedge is widest a little below its base.
            let level = if matches!(shape, Shape::Wedge { .. }) {
                high.z - edge
            } else {
                middle.z
            };
            for side in [
                middle.with_x(low.x),
                middle.with_x(high.x),
                middle.with_y(low.y),
                middle.with_y(high.y),
            ] {
                let distance_mm = field.signed_distance(side.with_z(level)).distance_mm;
                assert!(distance_mm.abs() < 1e-9, "{shape:?}: {distance_mm} at {side}");
            }
        }
    }
}

#[test]
fn closed_forms() {
    let distance = |shape: Shape, p: [f64; 3]| field(&shape).signed_distance(DVec3::from(p)).distance_mm;
    let near =
        |found: f64, expected: f64| assert!((found - expected).abs() < 1e-12, "{found}, expected {expected}");
    near(distance(Shape::Sphere { radius_mm: 3.0 }, [3.0, 4.0, 3.0]), 2.0);
    let sharp = || Shape::Box {
        size_mm: [4.0, 4.0, 2.0],
        edge_radius_mm: 0.0,
    };
    near(distance(sharp(), [3.0, 3.0, 3.0]), 3f64.sqrt());
    near(distance(sharp(), [0.0, 0.0, 1.0]), -1.0);
    let round = || Shape::Box {
        size_mm: [4.0, 4.0, 2.0],
        edge_radius_mm: 0.5,
    };
    near(distance(round(), [2.0, 2.0, 2.0]), 0.5 * (3f64.sqrt() - 1.0));
    near(distance(round(), [2.0, 0.0, 1.0]), 0.0);
    let ring = || Shape::Ring {
        outer_radius_mm: 5.0,
        inner_radius_mm: 3.0,
        height_mm: 4.0,
        edge_radius_mm: 0.0,
    };
    near(distance(ring(), [0.0, 0.0, 2.0]), 3.0);
    near(distance(ring(), [0.0, 0.0, -4.0]), 5.0);
    let triangle = || Shape::Triangle {
        side_mm: 6.0,
        height_mm: 4.0,
        edge_radius_mm: 0.0,
    };
    near(distance(triangle(), [2.0 * 3f64.sqrt(), 0.0, 2.0]), 0.0);
    near(distance(triangle(), [2.0 * 3f64.sqrt() + 1.0, 0.0, 2.0]), 1.0);
    let x = || Shape::X {
        length_mm: 10.0,
        width_mm: 2.0,
        height_mm: 4.0,
        edge_radius_mm: 0.0,
    };
    near(distance(x(), [2f64.sqrt(), 0.0, 2.0]), 0.0);
    near(distance(x(), [5.0, 0.0, 2.0]), (5.0 - 2f64.sqrt()) / 2f64.sqrt());
    let round = Shape::X {
        length_mm: 10.0,
        width_mm: 2.0,
        height_mm: 4.0,
        edge_radius_mm: 0.5,
    };
    // The centre of the rounding of a concave corner is half a millimetre beside both bars.
    near(distance(round, [1.5 * 2f64.sqrt(), 0.0, 2.0]), 0.5);
    let ridge = Shape::Wedge {
        angle_rad: 1.0,
        length_mm: 8.0,
        height_mm: 4.0,
        edge_radius_mm: 0.5,
    };
    // Near the ridge, the shape is a cylinder with the radius of the edge.
    near(distance(ridge, [0.0, 0.0, -0.5]), 0.5);
}

#[test]
fn impossible_shapes_name_the_field() {
    let field = |shape: Shape| shape.validate().unwrap_err().field;
    assert_eq!(field(Shape::Sphere { radius_mm: 0.0 }), "radius_mm");
    assert_eq!(field(Shape::Sphere { radius_mm: f64::NAN }), "radius_mm");
    assert_eq!(
        field(Shape::Box {
            size_mm: [1.0, -1.0, 1.0],
            edge_radius_mm: 0.0
        }),
        "size_mm[1]"
    );
    assert_eq!(
        field(Shape::Box {
            size_mm: [4.0, 4.0, 1.0],
            edge_radius_mm: 0.5
        }),
        "edge_radius_mm"
    );
    assert_eq!(
        field(Shape::Wedge {
            angle_rad: 3.2,
            length_mm: 1.0,
            height_mm: 1.0,
            edge_radius_mm: 0.0
        }),
        "angle_rad"
    );
    let ring = Shape::Ring {
        outer_radius_mm: 2.0,
        inner_radius_mm: 2.0,
        height_mm: 1.0,
        edge_radius_mm: 0.0,
    };
    assert_eq!(field(ring), "outer_radius_mm");
    let x = Shape::X {
        length_mm: 2.0,
        width_mm: 2.0,
        height_mm: 1.0,
        edge_radius_mm: 0.0,
    };
    assert_eq!(field(x), "length_mm");
    assert_eq!(field(Shape::Stl(SurfaceFile::new(""))), "path");
    assert_eq!(field(Shape::Union { parts: Vec::new() }), "parts");
    assert_eq!(
        field(whole(&[
            Shape::Sphere { radius_mm: 1.0 },
            Shape::Sphere { radius_mm: -1.0 }
        ])),
        "parts[1].shape.radius_mm"
    );
    let missing = Shape::Stl(SurfaceFile::new("tip.stl"))
        .signed_distance_field(&Surfaces::new())
        .err()
        .unwrap();
    assert!(
        missing.to_string().contains("`tip.stl`, which is not loaded"),
        "{missing}"
    );
}

/// Shapes beside each other, each turned and tilted.
fn whole(shapes: &[Shape]) -> Shape {
    let at = |(index, shape): (usize, &Shape)| Part {
        shape: shape.clone(),
        whole_from_part: Pose {
            position_mm: DVec3::new(4.0 * index as f64 - 6.0, 2.0, 1.0),
            rotation: DQuat::from_rotation_y(0.3) * DQuat::from_rotation_z(index as f64),
        },
    };
    Shape::Union {
        parts: shapes.iter().enumerate().map(at).collect(),
    }
}

proptest! {
    #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn a_point_is_in_a_union_if_it_is_in_a_part(p in near()) {
        let union = whole(&shapes(0.0));
        let found = field(&union).signed_distance(p);
        prop_assert!((found.gradient.length() - 1.0).abs() < 1e-9);
        prop_assert!(found.distance_mm.abs() < 1e-9 || is_in(&union, p) == (found.distance_mm < 0.0));
        let (low, high) = field(&union).bounds_mm();
        let nearest = p.clamp(low, high);
        prop_assert!(found.distance_mm.max(0.0) + 1e-9 >= p.distance(nearest), "nothing is beyond the bounds");
    }
}
