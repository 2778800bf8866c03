//! A continuous pressure map from a few taxels, by radial basis functions (paper, equation 1).
//!
//! [`pressure_map`] makes one map. [`PreparedMap`] makes many of the same taxels, each as one weighted sum.
//!
//! ```
//! use twintac_map::{MapSettings, Rectangle, pressure_map};
//!
//! let taxels_mm = [[-4.0, 0.0], [4.0, 0.0]];
//! let gel = Rectangle { min_mm: [-8.0, -4.0], max_mm: [8.0, 4.0] };
//! let settings = MapSettings { grid: [32, 16], ..MapSettings::default() };
//! let map = pressure_map(&taxels_mm, &[12.0, 3.0], &[0.0, 0.0], gel, &settings)?;
//! assert_eq!(map.pressure_kpa.len(), 32 * 16);
//! # Ok::<(), twintac_map::MapError>(())
//! ```

mod error;
mod fit;
mod kernel;
mod prepared;
#[cfg(test)]
mod tests;
mod width;

pub use error::MapError;
pub use prepared::PreparedMap;
pub use width::leave_one_out_width_mm;

use fit::Fit;

/// An upright rectangle in the gel's plane, mm.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Rectangle {
    /// Corner with the smallest x and y, mm.
    pub min_mm: [f64; 2],
    /// Corner with the largest x and y, mm.
    pub max_mm: [f64; 2],
}

/// The function around each taxel that a map is a weighted sum of.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Kernel {
    /// A Gaussian, as in the paper: the map fades to the baseline away from the taxels.
    #[default]
    Gaussian,
    /// `r² ln r` and a plane: the surface through the readings that bends least (Duchon 1977). It has no width, and goes on as a
    /// slope beyond the taxels.
    ThinPlate,
}

/// How the weight of each taxel's function is found.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Weights {
    /// The weight is the reading above the baseline, as in the paper: neighbours add up at the taxels. Wants [`Kernel::Gaussian`].
    Readings,
    /// The weights are solved so that the map meets every taxel's reading above the baseline.
    Interpolating,
    /// The weights are solved so that squared misses at the taxels, and this many times the map's roughness (`wᵀ K w`), are least:
    /// for noisy readings (ridge regression; smoothing spline, Wahba 1990). 0 interpolates; the kernel has no unit.
    Regularised(f64),
}

/// How to draw a map.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MapSettings {
    /// Columns and rows of the grid.
    pub grid: [usize; 2],
    /// The function around each taxel.
    pub kernel: Kernel,
    /// Standard deviation of the Gaussian, mm. `None`: where weights are solved, the one that [`leave_one_out_width_mm`] chooses; else
    /// half the pitch of the taxels.
    pub width_mm: Option<f64>,
    /// How weights are found.
    pub weights: Weights,
}

impl Default for MapSettings {
    fn default() -> Self {
        MapSettings {
            grid: [96, 64],
            kernel: Kernel::Gaussian,
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

/// Interpolates readings over a rectangle; with Gaussians `f(x) = Σᵢ wᵢ exp(-|x - xᵢ|² / 2σ²)`.
///
/// Without load (readings equal to the baseline) the map is zero everywhere. The paper writes the weights as
/// `λᵢ - p(xᵢ)`; here their sign is turned, so that more pressure is more. A reading that is not a number counts
/// as the baseline. Of many maps of the same taxels, [`PreparedMap`] makes each about 90 times as fast (`cargo run --release -p twintac-map --example map_rate`).
///
/// `taxels_mm`, `readings_kpa` and `baseline_kpa` have one entry a taxel.
///
/// # Errors
/// [`MapError::Input`] if lengths differ, the grid is empty or a setting is out of its range;
/// [`MapError::Singular`] if two taxels share a place and the map shall meet both.
pub fn pressure_map(
    taxels_mm: &[[f64; 2]],
    readings_kpa: &[f64],
    baseline_kpa: &[f64],
    rectangle: Rectangle,
    settings: &MapSettings,
) -> Result<PressureMap, MapError> {
    check_length("readings of a pressure map", readings_kpa, taxels_mm)?;
    check_length("baseline of a pressure map", baseline_kpa, taxels_mm)?;
    check_grid(settings.grid)?;
    let above: Vec<f64> = readings_kpa
        .iter()
        .zip(baseline_kpa)
        .map(|(reading, baseline)| finite_or_zero(reading - baseline))
        .collect();
    let fit = Fit::new(taxels_mm, settings, &[&above])?;
    let weights = fit.weights(&above);
    let at = |place| {
        fit.functions(place)
            .zip(&weights)
            .map(|(value, weight)| weight * value)
            .sum()
    };
    Ok(PressureMap {
        rectangle,
        grid: settings.grid,
        pressure_kpa: cells(rectangle, settings.grid).map(at).collect(),
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

fn finite_or_zero(value: f64) -> f64 {
    if value.is_finite() { value } else { 0.0 }
}

/// The centres of a grid's cells, row by row.
fn cells(rectangle: Rectangle, [columns, rows]: [usize; 2]) -> impl Iterator<Item = [f64; 2]> {
    let Rectangle { min_mm, max_mm } = rectangle;
    let centre = move |cell: usize, cells: usize, axis: usize| {
        min_mm[axis] + (max_mm[axis] - min_mm[axis]) * (cell as f64 + 0.5) / cells as f64
    };
    (0..rows).flat_map(move |row| {
        (0..columns).map(move |column| [centre(column, columns, 0), centre(row, rows, 1)])
    })
}

fn check_length(what: &'static str, values: &[f64], taxels_mm: &[[f64; 2]]) -> Result<(), MapError> {
    if values.len() == taxels_mm.len() {
        return Ok(());
    }
    let expected = format!("one for each of {} taxels", taxels_mm.len());
    Err(input(what, &expected, values.len()))
}

fn check_grid([columns, rows]: [usize; 2]) -> Result<(), MapError> {
    if columns == 0 || rows == 0 {
        return Err(input(
            "grid of a pressure map",
            "at least one cell",
            format!("{columns} x {rows}"),
        ));
    }
    Ok(())
}

fn input(what: &'static str, expected: &str, found: impl ToString) -> MapError {
    MapError::Input {
        what,
        expected: expected.to_owned(),
        found: found.to_string(),
    }
}
