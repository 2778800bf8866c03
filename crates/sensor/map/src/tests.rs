//! Properties of maps.

use proptest::prelude::*;

use super::*;
use crate::geometry::{cells, distance_mm};
use crate::width::leave_one_out_width_mm;

const TAXELS: [[f64; 2]; 8] = [
    [-12.0, -4.0],
    [-4.0, -4.0],
    [4.0, -4.0],
    [12.0, -4.0],
    [-12.0, 4.0],
    [-4.0, 4.0],
    [4.0, 4.0],
    [12.0, 4.0],
];

/// The map's value at a location: a grid of one cell whose centre is there.
fn at(place: [f64; 2], readings: &[f64], weights: Weights) -> f64 {
    let rectangle = Rectangle {
        min_mm: place.map(|x| x - 1.0),
        max_mm: place.map(|x| x + 1.0),
    };
    let settings = MapSettings {
        grid: [1, 1],
        weights,
        ..MapSettings::default()
    };
    pressure_map(&TAXELS, readings, &[0.0; 8], rectangle, &settings)
        .unwrap()
        .pressure_kpa[0]
}

proptest! {
    #[test]
    fn the_interpolating_map_meets_every_taxel(readings in prop::array::uniform8(-20.0..900.0f64)) {
        for (taxel, reading) in TAXELS.iter().zip(readings) {
            prop_assert!((at(*taxel, &readings, Weights::Interpolating) - reading).abs() < 1e-8);
        }
    }

    #[test]
    fn no_load_is_zero_everywhere(baseline in prop::array::uniform8(80.0..120.0f64)) {
        let rectangle = Rectangle { min_mm: [-17.0, -9.0], max_mm: [17.0, 9.0] };
        for weights in [Weights::Readings, Weights::Interpolating] {
            let settings = MapSettings { weights, ..MapSettings::default() };
            let map = pressure_map(&TAXELS, &baseline, &baseline, rectangle, &settings).unwrap();
            prop_assert!(map.pressure_kpa.iter().all(|&pressure| pressure == 0.0));
        }
    }
}

#[test]
fn the_papers_map_is_the_sum_of_weighted_gaussians() {
    let mut readings = [0.0; 8];
    readings[1] = 100.0;
    // The pitch is 8 mm, so the width is 4 mm, and half a pitch is one standard deviation.
    let expected = 100.0 * (-0.5f64).exp();
    assert!((at([0.0, -4.0], &readings, Weights::Readings) - expected).abs() < 1e-12);
    assert!((at([-4.0, -4.0], &readings, Weights::Readings) - 100.0).abs() < 1e-12);
}

#[test]
fn rows_run_with_y_and_columns_with_x() {
    let rectangle = Rectangle {
        min_mm: [-16.0, -8.0],
        max_mm: [16.0, 8.0],
    };
    let settings = MapSettings {
        grid: [4, 2],
        ..MapSettings::default()
    };
    let readings: Vec<f64> = (0..8).map(f64::from).collect();
    let map = pressure_map(&TAXELS, &readings, &[0.0; 8], rectangle, &settings).unwrap();
    for (pressure, reading) in map.pressure_kpa.iter().zip(readings) {
        assert!((pressure - reading).abs() < 1e-9);
    }
}

#[test]
fn bad_input_is_named() {
    let rectangle = Rectangle {
        min_mm: [0.0; 2],
        max_mm: [1.0; 2],
    };
    let run = |taxels: &[[f64; 2]], readings: &[f64], settings: MapSettings| {
        pressure_map(taxels, readings, &vec![0.0; taxels.len()], rectangle, &settings).unwrap_err()
    };
    let default = MapSettings::default();
    assert!(matches!(run(&TAXELS, &[1.0], default), MapError::Input { .. }));
    assert!(matches!(
        run(
            &[],
            &[],
            MapSettings {
                grid: [0, 4],
                ..default
            }
        ),
        MapError::Input { .. }
    ));
    let narrow = MapSettings {
        width_mm: Some(-1.0),
        ..default
    };
    assert!(matches!(run(&[[0.0; 2]], &[1.0], narrow), MapError::Input { .. }));
    let twice = [[0.0; 2], [0.0; 2], [5.0, 0.0]];
    assert!(matches!(
        run(&twice, &[1.0, 2.0, 3.0], default),
        MapError::Singular { .. }
    ));
}

#[test]
fn no_taxels_and_no_numbers_still_give_a_map() {
    let rectangle = Rectangle {
        min_mm: [0.0; 2],
        max_mm: [1.0; 2],
    };
    let map = pressure_map(&[], &[], &[], rectangle, &MapSettings::default()).unwrap();
    assert!(map.pressure_kpa.iter().all(|&pressure| pressure == 0.0));
    assert!(at([0.0, 0.0], &[f64::NAN; 8], Weights::Interpolating).is_nan());
}

#[test]
fn a_taxel_without_a_reading_is_left_out() {
    let settings = with(Kernel::Gaussian, Weights::Interpolating);
    for missing in 0..8 {
        let mut readings = [5.0, 4.0, 6.0, 5.0, 5.5, 4.5, 5.0, 6.0];
        let (others_mm, others): (Vec<[f64; 2]>, Vec<f64>) = TAXELS
            .iter()
            .zip(readings)
            .enumerate()
            .filter(|(taxel, _)| *taxel != missing)
            .map(|(_, both)| both)
            .unzip();
        let expected = pressure_map(&others_mm, &others, &[0.0; 7], GEL, &settings).unwrap();
        readings[missing] = f64::NAN;
        assert_eq!(
            pressure_map(&TAXELS, &readings, &[0.0; 8], GEL, &settings).unwrap(),
            expected
        );
        assert!(at(TAXELS[missing], &readings, Weights::Interpolating) > 2.0);
        let mut prepared = Vec::new();
        let map = PreparedMap::new(&TAXELS, GEL, &settings, &[&[5.0; 8]]).unwrap();
        map.fill(&readings, &mut prepared).unwrap();
        assert!(prepared.iter().all(|pressure| pressure.is_finite()));
        let met = at_taxels(&TAXELS, &readings, settings);
        for taxel in (0..8).filter(|taxel| *taxel != missing) {
            assert!((met[taxel] - readings[taxel]).abs() < 1e-8);
        }
    }
}

#[test]
fn an_infinite_reading_is_named() {
    let mut readings = [5.0; 8];
    readings[3] = f64::INFINITY;
    let settings = MapSettings::default();
    let error = pressure_map(&TAXELS, &readings, &[0.0; 8], GEL, &settings).unwrap_err();
    assert!(error.to_string().contains("found inf"), "{error}");
    let prepared = PreparedMap::new(&TAXELS, GEL, &settings, &[]).unwrap();
    assert!(prepared.fill(&readings, &mut Vec::new()).is_err());
}

const GEL: Rectangle = Rectangle {
    min_mm: [-17.0, -9.0],
    max_mm: [17.0, 9.0],
};

fn with(kernel: Kernel, weights: Weights) -> MapSettings {
    MapSettings {
        kernel,
        weights,
        ..MapSettings::default()
    }
}

/// A prepared map at the taxels: each one has a cell with its centre there.
fn at_taxels(taxels_mm: &[[f64; 2]], above_kpa: &[f64], settings: MapSettings) -> Vec<f64> {
    let at = |taxel: &[f64; 2]| {
        let (min_mm, max_mm) = (taxel.map(|x| x - 1.0), taxel.map(|x| x + 1.0));
        let settings = MapSettings {
            grid: [1, 1],
            ..settings
        };
        let mut map = Vec::new();
        PreparedMap::new(taxels_mm, Rectangle { min_mm, max_mm }, &settings, &[above_kpa])
            .unwrap()
            .fill(above_kpa, &mut map)
            .unwrap();
        map[0]
    };
    taxels_mm.iter().map(at).collect()
}

proptest! {
    #[test]
    fn a_thin_plate_meets_every_taxel(above in prop::array::uniform8(-20.0..900.0f64)) {
        for (found, expected) in at_taxels(&TAXELS, &above, with(Kernel::ThinPlate, Weights::Interpolating)).iter().zip(above) {
            prop_assert!((found - expected).abs() < 1e-8);
        }
    }

    #[test]
    fn prepared_or_not_a_map_is_the_same(above in prop::array::uniform8(-20.0..900.0f64), ridge in 0.0..1.0f64) {
        let mut prepared = Vec::new();
        for settings in [
            with(Kernel::Gaussian, Weights::Readings),
            with(Kernel::Gaussian, Weights::Interpolating),
            with(Kernel::Gaussian, Weights::Regularised(ridge)),
            with(Kernel::ThinPlate, Weights::Regularised(ridge)),
        ] {
            let map = pressure_map(&TAXELS, &above, &[0.0; 8], GEL, &settings).unwrap();
            PreparedMap::new(&TAXELS, GEL, &settings, &[&above]).unwrap().fill(&above, &mut prepared).unwrap();
            for (one, other) in map.pressure_kpa.iter().zip(&prepared) {
                prop_assert!((one - other).abs() < 1e-7, "{one} {other}");
            }
        }
    }
}

#[test]
fn a_thin_plate_draws_a_plane_as_a_plane_also_on_a_line() {
    let plane = |[x, y]: [f64; 2]| 3.0 + 0.5 * x - 0.25 * y;
    let settings = with(Kernel::ThinPlate, Weights::Regularised(10.0)); // a plane does not bend, so it is not smoothed
    let row = [[-6.0, -3.0], [-2.0, -1.0], [2.0, 1.0], [6.0, 3.0]];
    for taxels in [&TAXELS[..], &row[..], &row[..2], &row[..1]] {
        let above: Vec<f64> = taxels.iter().map(|&taxel| plane(taxel)).collect();
        for (found, expected) in at_taxels(taxels, &above, settings).iter().zip(&above) {
            assert!((found - expected).abs() < 1e-10, "{taxels:?}: {found} {expected}");
        }
    }
    let above = TAXELS.map(plane);
    let map = pressure_map(&TAXELS, &above, &[0.0; 8], GEL, &settings).unwrap();
    for (found, place) in map.pressure_kpa.iter().zip(cells(GEL, settings.grid)) {
        assert!((found - plane(place)).abs() < 1e-9);
    }
}

#[test]
fn more_regularisation_is_smoother_and_further_from_the_readings() {
    let noisy = [0.0, 10.0, -4.0, 9.0, 3.0, -8.0, 12.0, 1.0];
    for kernel in [Kernel::Gaussian, Kernel::ThinPlate] {
        let miss = |ridge: f64| -> f64 {
            let settings = MapSettings {
                width_mm: Some(6.0),
                ..with(kernel, Weights::Regularised(ridge))
            };
            let found = at_taxels(&TAXELS, &noisy, settings);
            found
                .iter()
                .zip(noisy)
                .map(|(found, reading)| (found - reading).powi(2))
                .sum()
        };
        let misses = [0.0, 0.01, 0.1, 1.0, 10.0].map(miss);
        assert!(misses[0] < 1e-16 && misses.is_sorted(), "{kernel:?}: {misses:?}");
    }
}

/// For a field that is one wide Gaussian, the width of the taxels' Gaussians has to grow with it.
/// The chosen width has to be close to the best one for the field between the taxels, which the
/// choice has not seen.
#[test]
fn leave_one_out_finds_a_width_for_the_field() {
    let array: Vec<[f64; 2]> = (0..36)
        .map(|i| [f64::from(i % 6) * 4.0, f64::from(i / 6) * 4.0])
        .collect();
    let rectangle = Rectangle {
        min_mm: [2.0; 2],
        max_mm: [18.0; 2],
    };
    let chosen = [2.5, 4.0].map(|spread_mm: f64| {
        let field =
            |place: [f64; 2]| 50.0 * (-0.5 * (distance_mm(place, [9.0, 11.0]) / spread_mm).powi(2)).exp();
        let above: Vec<f64> = array.iter().map(|&taxel| field(taxel)).collect();
        let error = |width_mm: f64| -> f64 {
            let settings = MapSettings {
                width_mm: Some(width_mm),
                grid: [30, 30],
                ..MapSettings::default()
            };
            let map = pressure_map(&array, &above, &vec![0.0; 36], rectangle, &settings).unwrap();
            let misses = map.pressure_kpa.iter().zip(cells(rectangle, settings.grid));
            (misses
                .map(|(found, place)| (found - field(place)).powi(2))
                .sum::<f64>()
                / 900.0)
                .sqrt()
        };
        let chosen_mm = leave_one_out_width_mm(&array, &[&above], 0.0);
        let best = (3..=13)
            .map(|tenth| error(0.1 * f64::from(tenth) * 4.0))
            .fold(f64::INFINITY, f64::min);
        assert!(
            error(chosen_mm) < 2.0 * best,
            "{chosen_mm} mm: {} kPa, best {best} kPa",
            error(chosen_mm)
        );
        assert!(
            error(chosen_mm) < 0.5 * error(0.3 * 4.0),
            "no better than with bumps that do not meet"
        );
        chosen_mm
    });
    assert!(chosen[0] < chosen[1], "{chosen:?}");
}

#[test]
fn where_nothing_tells_the_width_is_half_the_pitch() {
    assert_eq!(leave_one_out_width_mm(&TAXELS, &[], 0.0), 4.0);
    assert_eq!(
        leave_one_out_width_mm(&TAXELS, &[&[0.0; 8][..], &[f64::NAN; 8], &[1.0]], 0.0),
        4.0
    );
    assert_eq!(leave_one_out_width_mm(&TAXELS[..2], &[&[1.0, 2.0]], 0.0), 4.0);
}

#[test]
fn settings_that_make_no_sense_are_named() {
    for settings in [
        with(Kernel::ThinPlate, Weights::Readings),
        with(Kernel::Gaussian, Weights::Regularised(-1.0)),
        with(Kernel::Gaussian, Weights::Regularised(f64::NAN)),
    ] {
        let error = pressure_map(&TAXELS, &[0.0; 8], &[0.0; 8], GEL, &settings).unwrap_err();
        assert!(matches!(error, MapError::Input { .. }));
    }
    let prepared = PreparedMap::new(&TAXELS, GEL, &MapSettings::default(), &[]).unwrap();
    assert!(prepared.fill(&[1.0], &mut Vec::new()).is_err());
}
