//! Shapes that are too thin for a step, or for the mesh.

#![allow(clippy::unwrap_used, clippy::print_stdout)] // helpers of tests

mod common;

use common::{block, even, press};
use glam::DVec3;
use twintac_shape::{Distance, Shape, SignedDistance, Surfaces};
use twintac_softbody::{Material, SoftBody, SolveError, SolverSettings};

const TOP_MM: f64 = 6.0;

fn gel(settings: SolverSettings) -> SoftBody {
    let mesh = block(&even(-8.0, 8.0, 8), &even(-8.0, 8.0, 8), &even(0.0, TOP_MM, 4));
    SoftBody::new(&mesh, Material::neo_hookean(70.0, 0.45), settings).unwrap()
}

/// A plate at the end of a stem, which is so high that the box around both does not show how thin
/// the plate is.
struct OnStem(Box<dyn SignedDistance>);

impl SignedDistance for OnStem {
    fn signed_distance(&self, point_mm: DVec3) -> Distance {
        self.0.signed_distance(point_mm)
    }

    fn bounds_mm(&self) -> (DVec3, DVec3) {
        let (low_mm, high_mm) = self.0.bounds_mm();
        (low_mm, high_mm.with_z(20.0))
    }
}

fn plate(thickness_mm: f64) -> OnStem {
    let shape = Shape::Cylinder {
        radius_mm: 4.0,
        height_mm: thickness_mm,
        edge_radius_mm: 0.06,
    };
    OnStem(shape.signed_distance_field(&Surfaces::default()).unwrap())
}

#[test]
fn a_node_does_not_come_to_the_other_side_of_a_plate() {
    let thick_n = press(
        &gel(SolverSettings::default()),
        &mut gel(SolverSettings::default()).rest(),
        &plate(4.0),
        TOP_MM,
        0.5,
    )
    .unwrap()
    .indenter_force_n
    .z;
    // After one step of 0.5 mm, nodes are nearer to the upper side.
    let at_once = gel(SolverSettings {
        min_substep: 1.0,
        ..SolverSettings::default()
    });
    let mut state = at_once.rest();
    press(&at_once, &mut state, &plate(0.2), TOP_MM, -0.1).unwrap();
    let error = press(&at_once, &mut state, &plate(0.2), TOP_MM, 0.4).unwrap_err();
    println!("{error}");
    let SolveError::PassedThrough { thickness_mm, .. } = error else {
        panic!("{error}");
    };
    assert!((thickness_mm - 0.2).abs() < 0.1, "{error}");
    // The state is as before, and smaller steps succeed.
    assert_eq!(state.displacements_mm(), at_once.rest().displacements_mm());
    let in_parts = gel(SolverSettings::default());
    let mut state = in_parts.rest();
    press(&in_parts, &mut state, &plate(0.2), TOP_MM, -0.1).unwrap();
    press(&in_parts, &mut state, &plate(0.2), TOP_MM, 0.4).unwrap();
    let thin_n = press(&in_parts, &mut state, &plate(0.2), TOP_MM, 0.5)
        .unwrap()
        .indenter_force_n
        .z;
    println!("{thin_n} N, thick {thick_n} N");
    // With edges of a millimetre, gel beside the plate folds over it more or less than it should.
    assert!((thin_n / thick_n - 1.0).abs() < 0.15);
}

#[test]
fn a_blade_between_nodes_is_said() {
    let body = gel(SolverSettings::default());
    let blade = Shape::Box {
        size_mm: [0.2, 10.0, 8.0],
        edge_radius_mm: 0.05,
    };
    let blade = blade.signed_distance_field(&Surfaces::default()).unwrap();
    let mut state = body.rest();
    let mut last_n = 0.0;
    for tenth in 0..20 {
        match press(&body, &mut state, blade.as_ref(), TOP_MM, 0.1 * f64::from(tenth)) {
            Ok(frame) => {
                let force_n = -frame.indenter_force_n.z;
                assert!(force_n > last_n - 1e-3, "{force_n} N after {last_n} N");
                last_n = force_n;
            }
            Err(error) => {
                println!("{last_n} N, then {error}");
                assert!(matches!(error, SolveError::PassedThrough { .. }), "{error}");
                return;
            }
        }
    }
    println!("{last_n} N");
}

#[test]
fn a_surface_that_slips_around_a_ball_is_refused() {
    let mesh = block(&even(-12.0, 12.0, 9), &even(-10.0, 10.0, 8), &even(0.0, 8.0, 3));
    let settings = SolverSettings {
        min_substep: 1.0,
        ..SolverSettings::default()
    };
    let gel = SoftBody::new(&mesh, Material::neo_hookean(15.2, 0.495), settings).unwrap();
    let ball = Shape::Sphere { radius_mm: 5.0 };
    let ball = ball.signed_distance_field(&Surfaces::default()).unwrap();
    let mut state = gel.rest();
    for step in 1..=20 {
        let depth_mm = 0.38 * f64::from(step);
        let pressed = press(&gel, &mut state, ball.as_ref(), 8.0, depth_mm);
        match pressed {
            Ok(frame) => {
                let force_n = -frame.indenter_force_n.z;
                assert!(force_n > 0.0, "{force_n} N at {depth_mm} mm");
            }
            Err(error) => {
                assert!(matches!(error, SolveError::Pulled { .. }), "{error}");
                assert!(depth_mm > 5.0, "{error}");
                return;
            }
        }
    }
    panic!("the ball is 7.6 mm deep in a gel of 8 mm, with edges of 2.7 mm");
}
