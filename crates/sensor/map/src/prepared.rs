//! Many maps of the same taxels.

use crate::error::{check_finite_or_missing, check_grid, check_length};
use crate::fit::Fit;
use crate::geometry::{Rectangle, cells};
use crate::interpolate::through_answers;
use crate::{MapError, MapSettings};

/// Pressure maps of fixed taxels. A map is linear in its readings, so the share of each taxel in
/// each cell is computed once, and each map is a weighted sum.
#[derive(Clone, Debug)]
pub struct PreparedMap {
    rectangle: Rectangle,
    /// The settings, with the width that was chosen.
    settings: MapSettings,
    taxels_mm: Vec<[f64; 2]>,
    length_mm: f64,
    /// `[taxels][cells]`: pressure in the cell, kPa, for a reading of 1 kPa at the taxel.
    shares: Vec<Vec<f64>>,
}

impl PreparedMap {
    /// Prepares maps of these taxels over a rectangle. If the settings give no width, it is chosen
    /// by leave-one-out cross-validation on `fields_kpa`: readings above the baseline, one entry
    /// for each taxel. The list may be empty.
    ///
    /// # Errors
    /// See [`pressure_map`](crate::pressure_map).
    pub fn new(
        taxels_mm: &[[f64; 2]],
        rectangle: Rectangle,
        settings: &MapSettings,
        fields_kpa: &[&[f64]],
    ) -> Result<Self, MapError> {
        check_grid(settings.grid)?;
        let fit = Fit::new(taxels_mm, settings, fields_kpa)?;
        let mut shares = vec![Vec::with_capacity(settings.grid[0] * settings.grid[1]); taxels_mm.len()];
        for place in cells(rectangle, settings.grid) {
            for (share, of_cell) in shares.iter_mut().zip(fit.shares(place)) {
                share.push(of_cell);
            }
        }
        Ok(Self {
            rectangle,
            settings: MapSettings {
                width_mm: Some(fit.length_mm),
                ..*settings
            },
            taxels_mm: taxels_mm.to_vec(),
            length_mm: fit.length_mm,
            shares,
        })
    }

    /// The rectangle that the grid fills, mm.
    #[must_use]
    pub fn rectangle(&self) -> Rectangle {
        self.rectangle
    }

    /// Columns and rows.
    #[must_use]
    pub fn grid(&self) -> [usize; 2] {
        self.settings.grid
    }

    /// Standard deviation of the Gaussians, given or chosen, mm. For a thin plate, the taxels'
    /// pitch.
    #[must_use]
    pub fn width_mm(&self) -> f64 {
        self.length_mm
    }

    /// Fills `pressure_kpa` with a map, `[rows][columns]` flattened as in
    /// [`PressureMap`](crate::PressureMap), from one reading above the baseline for each taxel,
    /// kPa. A taxel without a reading (NaN) is left out: the map is then solved anew for the
    /// others, with the same width.
    ///
    /// # Errors
    /// [`MapError::Input`] if the number of readings is not that of the taxels, or one is infinite;
    /// those of [`pressure_map`](crate::pressure_map) if taxels are left out.
    pub fn fill(&self, above_kpa: &[f64], pressure_kpa: &mut Vec<f64>) -> Result<(), MapError> {
        check_length("readings of a pressure map", above_kpa, &self.taxels_mm)?;
        if above_kpa.iter().any(|above| above.is_nan()) {
            *pressure_kpa = through_answers(&self.taxels_mm, above_kpa, self.rectangle, &self.settings)?;
            return Ok(());
        }
        check_finite_or_missing(above_kpa)?;
        pressure_kpa.clear();
        pressure_kpa.resize(self.settings.grid[0] * self.settings.grid[1], 0.0);
        for (shares, above) in self.shares.iter().zip(above_kpa) {
            for (pressure, share) in pressure_kpa.iter_mut().zip(shares) {
                *pressure += above * share;
            }
        }
        Ok(())
    }
}
