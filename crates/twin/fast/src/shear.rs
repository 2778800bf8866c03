//! Effect of a force along the gel's surface on the pressure at its base.

use std::f64::consts::TAU;
use std::sync::Arc;

use glam::DVec2;

use crate::footprint::Footprint;

/// Spacing of the table's entries, as a fraction of the layer's height.
const STEP: f64 = 0.02;

/// End of the table, in layer heights: the effect farther away is negligible.
const FURTHEST: f64 = 5.0;

/// Step and end of the wave numbers that are summed, radians per layer height.
const WAVE_STEP: f64 = 0.05;
const SHORTEST_WAVE: f64 = 25.0;

/// Pressure at the rigid base of an elastic layer that is bonded to it and pulled along its surface
/// at a point: `F κ(r/h)/h² cos θ`, for a force `F` and a location of the base at the distance `r`
/// in a direction `θ` from that of the force. The pressure is higher ahead of the force and lower
/// behind it.
///
/// The layer's equations are solved for waves `exp(ikx)` by Papkovich-Neuber potentials `φ + zψ`,
/// with zero displacement at `z = 0`, and the traction `q` along x at `z = h`: with `H = kh`,
/// `p = -i q ⅔(1 + ν) ((1 - 2ν) sinh H + H cosh H) / (4(1 - ν)² cosh² H + H² - (1 - 2ν)² sinh² H)`.
/// Waves across the pull give no pressure. The effect of a point force is the sum of all waves (a
/// Hankel transform of the first order).
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Shear {
    /// `κ` at equal distances, from 0 on.
    kernel: Arc<[f64]>,
}

impl Shear {
    /// The pressure in a layer with this Poisson's ratio.
    pub(crate) fn of(poissons_ratio: f64) -> Self {
        let n_waves = (SHORTEST_WAVE / WAVE_STEP) as u32;
        let waves: Vec<(f64, f64)> = (1..=n_waves)
            .map(|wave| WAVE_STEP * f64::from(wave))
            .map(|wave| {
                (
                    wave,
                    floor_pressure(wave, poissons_ratio) * wave * WAVE_STEP / TAU,
                )
            })
            .collect();
        let at = |distance: f64| -> f64 {
            waves
                .iter()
                .map(|(wave, part)| part * libm::j1(wave * distance))
                .sum()
        };
        let n_entries = (FURTHEST / STEP) as u32 + 1;
        Self {
            kernel: (0..n_entries).map(|entry| at(STEP * f64::from(entry))).collect(),
        }
    }

    /// Adds the effect of a force along the surface, N, to the pressure at the ports, kPa. The
    /// force is distributed over the locations that carry a body.
    pub(crate) fn add(
        &self,
        footprint: &Footprint,
        force_n: DVec2,
        ports_mm: &[DVec2],
        pressure_kpa: &mut [f32],
    ) {
        let height_mm = footprint.thickness_mm();
        let all: f32 = footprint.places().map(|(_, share)| share).sum();
        // N/mm² = 1000 kPa
        let scale = 1e3 / (f64::from(all) * height_mm * height_mm);
        for (port_mm, pressure_kpa) in ports_mm.iter().zip(pressure_kpa) {
            let felt = footprint.places().map(|(place_mm, share)| {
                let way_mm = *port_mm - place_mm;
                let length_mm = way_mm.length();
                let per_mm = length_mm.recip();
                if !per_mm.is_finite() {
                    return 0.0;
                }
                f64::from(share) * force_n.dot(way_mm * per_mm) * self.at(length_mm / height_mm)
            });
            *pressure_kpa += (scale * felt.sum::<f64>()) as f32;
        }
    }

    /// `κ` at a distance in layer heights.
    fn at(&self, distance: f64) -> f64 {
        let entries = distance / STEP;
        let entry = entries as usize;
        let Some([low, high]) = self.kernel.get(entry..entry + 2) else {
            return 0.0;
        };
        low + (entries - entry as f64) * (high - low)
    }
}

/// Pressure at the base for a wave of traction of height 1, a quarter of a wavelength behind it.
fn floor_pressure(wave: f64, poissons_ratio: f64) -> f64 {
    let (sinh, cosh) = (wave.sinh(), wave.cosh());
    let compressible = 1.0 - 2.0 * poissons_ratio;
    let below = (2.0 * (1.0 - poissons_ratio) * cosh).powi(2) + wave * wave - (compressible * sinh).powi(2);
    2.0 / 3.0 * (1.0 + poissons_ratio) * (compressible * sinh + wave * cosh) / below
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn long_waves_press_in_proportion_to_their_number() {
        // The limit of the formula was derived by hand: an error in its hyperbolic terms would not
        // have this limit. Comparisons with FEM solutions test the rest (`friction`).
        let (wave, poissons_ratio) = (1e-3, 0.4);
        let expected = (1.0 + poissons_ratio) / (3.0 * (1.0 - poissons_ratio)) * wave;
        assert!((floor_pressure(wave, poissons_ratio) / expected - 1.0).abs() < 1e-3);
    }
}
