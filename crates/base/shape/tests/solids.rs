//! Gels and the shell around them: properties that their distances, tops and volumes must have.

#![allow(clippy::unwrap_used)] // also in the helpers of tests

use glam::DVec3;
use proptest::prelude::*;
use twintac_shape::{Dome, Solid, SurfaceFile, Surfaces};

fn solids() -> Vec<Solid> {
    let block = |edge_radius_mm: f64| Solid::Block {
        size_mm: [12.0, 8.0, 5.0],
        center_mm: [1.0, -0.5],
        edge_radius_mm,
    };
    let dome = Solid::Dome(Dome {
        x_mm: [-5.0, 7.0],
        y_mm: [-4.0, 4.0],
        crown_at_mm: [0.0, 0.5],
        crown_mm: 5.0,
        drop_x_mm: [0.5, 2.0],
        drop_y_mm: [1.0, 0.7],
    });
    vec![block(0.0), block(1.5), dome]
}

fn near() -> impl Strategy<Value = DVec3> {
    let lattice = (-10i32..=10).prop_map(f64::from);
    let coordinate = prop_oneof![3 => -10.0..10.0, 1 => lattice];
    (coordinate.clone(), coordinate, -3.0..8.0).prop_map(|(x, y, z)| DVec3::new(x, y, z))
}

fn distance(solid: &Solid, p: DVec3) -> twintac_shape::Distance {
    solid.signed_distance(p, &Surfaces::new())
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 2000, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn the_inside_is_between_the_board_and_the_top(p in near(), which in 0..3usize) {
        let solid = &solids()[which];
        let found = distance(solid, p);
        prop_assume!(found.distance_mm.abs() > 1e-9);
        let under_top = solid.top_height_mm(p.x, p.y, &Surfaces::new()).is_some_and(|top_mm| p.z <= top_mm);
        prop_assert_eq!(found.distance_mm < 0.0, under_top && p.z >= 0.0, "{:?}", found);
    }

    #[test]
    fn distances_have_unit_gradients_and_no_steps(p in near(), q in near(), which in 0..3usize) {
        let solid = &solids()[which];
        let found = distance(solid, p);
        prop_assert!((found.gradient.length() - 1.0).abs() < 1e-9, "{:?}", found);
        let change = found.distance_mm - distance(solid, q).distance_mm;
        prop_assert!(change.abs() <= p.distance(q) + 1e-9);
    }

    #[test]
    fn a_step_along_the_gradient_reaches_the_surface(p in near(), which in 0..3usize) {
        let solid = &solids()[which];
        let found = distance(solid, p);
        let rest = distance(solid, p - found.gradient * found.distance_mm).distance_mm;
        // Outside of a block's ridges the distance is a lower bound: the step may end before the
        // surface, but never beyond it.
        let is_exact = found.distance_mm <= 0.0 || which == 2;
        prop_assert!(rest > -1e-7 && (rest < 1e-7 || !is_exact), "{:?} leaves {}", found, rest);
    }
}

#[test]
fn a_domes_inside_is_as_deep_as_a_dense_sampling_of_its_top_says() {
    let solid = &solids()[2];
    let top = |x: f64, y: f64| {
        solid
            .top_height_mm(x, y, &Surfaces::new())
            .map(|z| DVec3::new(x, y, z))
    };
    let samples: Vec<DVec3> = (0..=600)
        .flat_map(|i| (0..=400).map(move |j| (-5.0 + 0.02 * f64::from(i), -4.0 + 0.02 * f64::from(j))))
        .filter_map(|(x, y)| top(x, y))
        .collect();
    assert!(samples.len() > 200_000);
    for p in [
        [0.0, 0.5, 4.0],
        [1.0, 1.0, 3.5],
        [-2.0, -1.5, 4.0],
        [4.0, 0.0, 3.5],
        [5.0, 2.0, 2.9],
    ]
    .map(DVec3::from)
    {
        let sampled_mm = samples
            .iter()
            .map(|sample| sample.distance(p))
            .fold(f64::INFINITY, f64::min);
        let found_mm = -distance(solid, p).distance_mm;
        // The closest point of a lattice of 0.02 mm is at most 0.015 mm from the true one, which
        // changes the distance by 0.0003 mm.
        assert!(
            found_mm <= sampled_mm + 1e-9 && sampled_mm - found_mm < 3e-4,
            "{found_mm}, sampled {sampled_mm}, at {p}"
        );
    }
}

#[test]
fn volumes_are_the_integral_of_the_top() {
    for solid in solids() {
        let (low, high) = solid.bounds_mm(&Surfaces::new());
        let n = 1600;
        let at = |low: f64, high: f64, i: i32| low + (high - low) * (f64::from(i) + 0.5) / f64::from(n);
        let sum: f64 = (0..n)
            .flat_map(|i| (0..n).map(move |j| (i, j)))
            .filter_map(|(i, j)| {
                solid.top_height_mm(at(low.x, high.x, i), at(low.y, high.y, j), &Surfaces::new())
            })
            .sum();
        let sampled_mm3 = sum * (high.x - low.x) * (high.y - low.y) / f64::from(n * n);
        let volume_mm3 = solid.volume_mm3(&Surfaces::new());
        assert!(
            (volume_mm3 / sampled_mm3 - 1.0).abs() < 1e-5,
            "{solid:?}: {volume_mm3}, sampled {sampled_mm3}"
        );
    }
}

#[test]
fn impossible_gels_name_the_field() {
    let field = |solid: Solid| solid.validate().unwrap_err().field;
    let block = |size_mm, edge_radius_mm| Solid::Block {
        size_mm,
        center_mm: [0.0; 2],
        edge_radius_mm,
    };
    assert_eq!(field(block([1.0, 1.0, -1.0], 0.0)), "size_mm[2]");
    assert_eq!(field(block([4.0, 2.0, 4.0], 1.1)), "edge_radius_mm");
    let dome = |change: &dyn Fn(&mut Dome)| {
        let Solid::Dome(mut dome) = solids().remove(2) else {
            panic!("the third is a dome")
        };
        change(&mut dome);
        field(Solid::Dome(dome))
    };
    assert_eq!(dome(&|dome| dome.x_mm = [1.0, 1.0]), "x_mm[1]");
    assert_eq!(dome(&|dome| dome.crown_at_mm = [8.0, 0.0]), "crown_at_mm[0]");
    assert_eq!(dome(&|dome| dome.drop_y_mm = [-0.1, 0.0]), "drop_y_mm[0]");
    assert_eq!(dome(&|dome| dome.drop_x_mm = [0.0, 4.5]), "drop_x_mm[1]");
    assert!(solids().iter().all(|solid| solid.validate().is_ok()));
    assert_eq!(field(Solid::Stl(SurfaceFile::new(""))), "path");
    // The size is given in metres by mistake.
    assert_eq!(field(block([0.034, 0.018, 0.0085], 0.0)), "size_mm[0]");
}
