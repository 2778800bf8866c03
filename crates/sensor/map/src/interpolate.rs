//! A single map.

use crate::error::{check_finite_or_missing, check_grid, check_length};
use crate::fit::Fit;
use crate::geometry::{Rectangle, cells};
use crate::{MapError, MapSettings};

/// Pressure over a grid of cell centres.
#[derive(Clone, Debug, PartialEq)]
pub struct PressureMap {
    /// The rectangle that the grid fills, mm.
    pub rectangle: Rectangle,
    /// Columns and rows.
    pub grid: [usize; 2],
    /// Pressure above the baseline, kPa, `[rows][columns]` flattened, the row of smallest y first.
    /// NaN everywhere if no taxel has a reading.
    pub pressure_kpa: Vec<f64>,
}

/// Interpolates readings over a rectangle; with Gaussians `f(x) = Σᵢ wᵢ exp(-|x - xᵢ|² / 2σ²)`.
///
/// Without load (readings equal to the baseline) the map is zero everywhere. The paper writes the
/// weights as `λᵢ - p(xᵢ)`; here their sign is reversed, so that a larger pressure has a larger
/// value. A taxel without a reading (NaN) is left out: the map is that of the other taxels. For
/// many maps of the same taxels, [`PreparedMap`](crate::PreparedMap) computes each about 90 times
/// as fast (`cargo run --release -p twintac-map --example map_rate`).
///
/// `taxels_mm`, `readings_kpa` and `baseline_kpa` have one entry for each taxel.
///
/// # Errors
/// [`MapError::Input`] if lengths differ, a reading is infinite, the grid is empty or a setting is
/// out of its range; [`MapError::Singular`] if two taxels have the same position and the map must
/// pass through both readings.
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
    let above = readings_kpa.iter().zip(baseline_kpa);
    let above: Vec<f64> = above.map(|(reading, baseline)| reading - baseline).collect();
    Ok(PressureMap {
        rectangle,
        grid: settings.grid,
        pressure_kpa: through_answers(taxels_mm, &above, rectangle, settings)?,
    })
}

/// The map of the taxels with a reading above the baseline; NaN if there is none.
pub(crate) fn through_answers(
    taxels_mm: &[[f64; 2]],
    above_kpa: &[f64],
    rectangle: Rectangle,
    settings: &MapSettings,
) -> Result<Vec<f64>, MapError> {
    check_finite_or_missing(above_kpa)?;
    let answers = taxels_mm
        .iter()
        .zip(above_kpa)
        .filter(|(_, above)| !above.is_nan());
    let (answering_mm, above): (Vec<[f64; 2]>, Vec<f64>) = answers.unzip();
    if above.is_empty() && !taxels_mm.is_empty() {
        return Ok(vec![f64::NAN; settings.grid[0] * settings.grid[1]]);
    }
    let fit = Fit::new(&answering_mm, settings, &[&above])?;
    let weights = fit.weights(&above);
    let at = |place| {
        let terms = fit.functions(place).zip(&weights);
        terms.map(|(value, weight)| weight * value).sum()
    };
    Ok(cells(rectangle, settings.grid).map(at).collect())
}
