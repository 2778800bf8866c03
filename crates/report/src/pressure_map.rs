//! A continuous pressure map from a few taxels, by Gaussian radial basis functions (paper, equation 1).

use crate::ReportError;

/// An upright rectangle in the gel's plane, mm.
#[derive(Clone, Copy, Debug, Default, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct Rectangle {
    /// Corner with the smallest x and y, mm.
    pub min_mm: [f64; 2],
    /// Corner with the largest x and y, mm.
    pub max_mm: [f64; 2],
}

/// How the weight of each taxel's Gaussian is found.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Weights {
    /// The weight is the reading above the baseline, as in the paper: neighbours add up at the taxels.
    Readings,
    /// The weights are solved so that the map meets every taxel's reading above the baseline.
    Interpolating,
}

/// How to draw a map.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MapSettings {
    /// Columns and rows of the grid.
    pub grid: [usize; 2],
    /// Standard deviation of the Gaussian, mm; half the pitch of the taxels if `None`.
    pub width_mm: Option<f64>,
    /// How weights are found.
    pub weights: Weights,
}

impl Default for MapSettings {
    fn default() -> Self {
        MapSettings {
            grid: [96, 64],
            width_mm: None,
            weights: Weights::Interpolating,
        }
    }
}

/// Pressure over a grid of cell centres.
#[derive(Clone, Debug, PartialEq)]
pub struct PressureMap {
    /// The rectangle that the grid fills, mm.
    pub rectangle: Rectangle,
    /// Columns and rows.
    pub grid: [usize; 2],
    /// Pressure above the baseline, kPa, `[rows][columns]` flattened, the row of smallest y first.
    pub pressure_kpa: Vec<f64>,
}

/// Interpolates readings over a rectangle: `f(x) = Σᵢ wᵢ exp(-|x - xᵢ|² / 2σ²)`.
///
/// Without load (readings equal to the baseline) the map is zero everywhere. The paper writes the weights as
/// `λᵢ - p(xᵢ)`; here their sign is turned, so that more pressure is more. A reading that is not a number counts
/// as the baseline.
///
/// `taxels_mm`, `readings_kpa` and `baseline_kpa` have one entry a taxel.
///
/// # Errors
/// [`ReportError::Input`] if lengths differ, the grid is empty or the width is not positive;
/// [`ReportError::Singular`] if two taxels share a place and the map shall meet both.
pub fn pressure_map(
    taxels_mm: &[[f64; 2]],
    readings_kpa: &[f64],
    baseline_kpa: &[f64],
    rectangle: Rectangle,
    settings: &MapSettings,
) -> Result<PressureMap, ReportError> {
    for (what, found) in [
        ("readings of a pressure map", readings_kpa),
        ("baseline of a pressure map", baseline_kpa),
    ] {
        if found.len() != taxels_mm.len() {
            let expected = format!("one for each of {} taxels", taxels_mm.len());
            return Err(ReportError::Input {
                what,
                expected,
                found: found.len().to_string(),
            });
        }
    }
    let [columns, rows] = settings.grid;
    if columns == 0 || rows == 0 {
        let (expected, found) = ("at least one cell".into(), format!("{columns} x {rows}"));
        return Err(ReportError::Input {
            what: "grid of a pressure map",
            expected,
            found,
        });
    }
    let width_mm = settings.width_mm.unwrap_or_else(|| 0.5 * pitch_mm(taxels_mm));
    if !(width_mm > 0.0 && width_mm.is_finite()) {
        let (expected, found) = ("a positive number of mm".into(), width_mm.to_string());
        return Err(ReportError::Input {
            what: "width of a pressure map's Gaussian",
            expected,
            found,
        });
    }

    let above: Vec<f64> = readings_kpa
        .iter()
        .zip(baseline_kpa)
        .map(|(reading, baseline)| reading - baseline)
        .map(|above| if above.is_finite() { above } else { 0.0 })
        .collect();
    let weights = match settings.weights {
        Weights::Readings => above,
        Weights::Interpolating => solve(taxels_mm, width_mm, above)?,
    };

    let Rectangle { min_mm, max_mm } = rectangle;
    let centre = |cell: usize, cells: usize, axis: usize| {
        min_mm[axis] + (max_mm[axis] - min_mm[axis]) * (cell as f64 + 0.5) / cells as f64
    };
    let pressure_kpa = (0..rows)
        .flat_map(|row| (0..columns).map(move |column| (row, column)))
        .map(|(row, column)| {
            let place = [centre(column, columns, 0), centre(row, rows, 1)];
            let parts = taxels_mm.iter().zip(&weights);
            parts
                .map(|(&taxel, weight)| weight * gaussian(place, taxel, width_mm))
                .sum()
        })
        .collect();
    Ok(PressureMap {
        rectangle,
        grid: settings.grid,
        pressure_kpa,
    })
}

/// The mean distance of a taxel to its nearest neighbour, mm; 8 if there are fewer than two.
pub fn pitch_mm(taxels_mm: &[[f64; 2]]) -> f64 {
    const ALONE_MM: f64 = 8.0;
    let nearest = |index: usize| {
        let others = taxels_mm.iter().enumerate().filter(|&(other, _)| other != index);
        others
            .map(|(_, &other)| distance_mm(taxels_mm[index], other))
            .fold(f64::INFINITY, f64::min)
    };
    let distances: Vec<f64> = (0..taxels_mm.len())
        .map(nearest)
        .filter(|distance| distance.is_finite() && *distance > 0.0)
        .collect();
    if distances.is_empty() {
        ALONE_MM
    } else {
        distances.iter().sum::<f64>() / distances.len() as f64
    }
}

fn distance_mm(a: [f64; 2], b: [f64; 2]) -> f64 {
    (a[0] - b[0]).hypot(a[1] - b[1])
}

fn gaussian(place: [f64; 2], taxel: [f64; 2], width_mm: f64) -> f64 {
    let ratio = distance_mm(place, taxel) / width_mm;
    (-0.5 * ratio * ratio).exp()
}

/// Weights with which the sum of Gaussians meets `values` at the taxels: a Cholesky solve, as the matrix of
/// Gaussians between distinct places is positive definite (Schoenberg 1938).
fn solve(taxels_mm: &[[f64; 2]], width_mm: f64, mut values: Vec<f64>) -> Result<Vec<f64>, ReportError> {
    let n = taxels_mm.len();
    let mut factor = vec![vec![0.0; n]; n];
    for row in 0..n {
        for column in 0..=row {
            let entry = gaussian(taxels_mm[row], taxels_mm[column], width_mm);
            let done: f64 = (0..column).map(|k| factor[row][k] * factor[column][k]).sum();
            if row == column {
                let pivot = entry - done;
                if pivot.is_nan() || pivot < 1e-10 {
                    return Err(ReportError::Singular { pivot });
                }
                factor[row][row] = pivot.sqrt();
            } else {
                factor[row][column] = (entry - done) / factor[column][column];
            }
        }
    }
    for row in 0..n {
        let done: f64 = (0..row).map(|k| factor[row][k] * values[k]).sum();
        values[row] = (values[row] - done) / factor[row][row];
    }
    for row in (0..n).rev() {
        let done: f64 = (row + 1..n).map(|k| factor[k][row] * values[k]).sum();
        values[row] = (values[row] - done) / factor[row][row];
    }
    Ok(values)
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

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

    /// A grid of one cell whose centre is the place.
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
        // Pitch 8 mm, so the width is 4 mm: half a pitch away is one standard deviation.
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
        assert!(matches!(run(&TAXELS, &[1.0], default), ReportError::Input { .. }));
        assert!(matches!(
            run(
                &[],
                &[],
                MapSettings {
                    grid: [0, 4],
                    ..default
                }
            ),
            ReportError::Input { .. }
        ));
        let narrow = MapSettings {
            width_mm: Some(-1.0),
            ..default
        };
        assert!(matches!(
            run(&[[0.0; 2]], &[1.0], narrow),
            ReportError::Input { .. }
        ));
        let twice = [[0.0; 2], [0.0; 2], [5.0, 0.0]];
        assert!(matches!(
            run(&twice, &[1.0, 2.0, 3.0], default),
            ReportError::Singular { .. }
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
        assert_eq!(at([0.0, 0.0], &[f64::NAN; 8], Weights::Interpolating), 0.0);
    }
}
