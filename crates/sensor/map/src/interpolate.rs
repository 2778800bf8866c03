//! One map.

use crate::error::{check_grid, check_length};
use crate::fit::Fit;
use crate::geometry::{Rectangle, cells, finite_or_zero};
use crate::{MapError, MapSettings};

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
/// as the baseline. Of many maps of the same taxels, [`PreparedMap`](crate::PreparedMap) makes each about 90 times as fast (`cargo run --release -p twintac-map --example map_rate`).
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
