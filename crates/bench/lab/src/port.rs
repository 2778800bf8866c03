//! A barometer's port and the air that is trapped in it.
//!
//! Gel that is cast over a barometer keeps a bubble of air in the port. The barometer reads the
//! pressure of this air. Two laws relate it to the pressure of the gel. `e` is the pressure of the
//! air above `p₀`, the pressure at which it was trapped, and `P` is the pressure of the gel in
//! front of the port:
//!
//! - The air keeps `p V` constant (Boyle's law: a bubble this small always has the temperature of
//!   its walls). So the volume of the gel that bulges into it is `ΔV = V₀ e / (p₀ + e)`.
//! - The gel resists the bulge. Beside the port it is bonded to the board. By symmetry it is then
//!   half of a body with a circular crack that a pressure `P - e` opens. The volume of such a crack
//!   is known (Sneddon, Proc. R. Soc. A 187, 1946, p. 229). Half of it is
//!   `ΔV = 8 (1 - ν²) a³ (P - e) / (3 E)`, which is `2 a³ (P - e) / (3 G)` for an incompressible
//!   gel, with the port radius `a` and the shear modulus `G`.
//!
//! Together they give `P = e + B e / (p₀ + e)` with `B = 3 G V₀ / (2 a³)`, a quadratic equation for
//! `e`. A port reads the fraction `p₀ / (p₀ + B)` of a small pressure, and a larger fraction of a
//! large pressure, which makes its bubble small. Assumptions: the bulge is small beside the port,
//! and does not relax.

use twintac_sensor::ATMOSPHERE_KPA;

/// How a barometer's port changes the pressure of the gel.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Port {
    pub(crate) gain: f64,
    pub(crate) offset_kpa: f64,
    pub(crate) offset_kpa_per_k: f64,
    /// Resistance of the gel to the compression of the bubble, `B` above, kPa. 0 without a bubble.
    pub(crate) bubble_kpa: f64,
}

impl Port {
    /// A port without imperfections.
    pub(crate) const PERFECT: Self = Self {
        gain: 1.0,
        offset_kpa: 0.0,
        offset_kpa_per_k: 0.0,
        bubble_kpa: 0.0,
    };

    /// Absolute pressure in the port, kPa, for a pressure of the gel, kPa, and a temperature rise
    /// since casting, K.
    pub(crate) fn absolute_kpa(&self, gel_kpa: f64, warmed_k: f64) -> f64 {
        ATMOSPHERE_KPA
            + self.offset_kpa
            + self.offset_kpa_per_k * warmed_k
            + air_kpa(self.bubble_kpa, self.gain * gel_kpa)
    }
}

/// The constant `B`, kPa, of a bubble with a volume, mm³, in a port with a radius, mm, under a gel
/// with a shear modulus, kPa.
pub(crate) fn bubble_kpa(volume_mm3: f64, radius_mm: f64, shear_modulus_kpa: f64) -> f64 {
    1.5 * shear_modulus_kpa * volume_mm3 / radius_mm.powi(3)
}

/// Pressure of the trapped air above the atmosphere's, kPa, under a pressure of the gel, kPa.
fn air_kpa(bubble_kpa: f64, gel_kpa: f64) -> f64 {
    if bubble_kpa == 0.0 {
        return gel_kpa;
    }
    let half = 0.5 * (gel_kpa + ATMOSPHERE_KPA - bubble_kpa);
    half + half.hypot((ATMOSPHERE_KPA * bubble_kpa).sqrt()) - ATMOSPHERE_KPA
}

#[cfg(test)]
mod tests {
    use std::f64::consts::PI;

    use super::*;

    #[test]
    fn air_and_gel_agree_on_the_volume_that_the_air_gives_up() {
        let (volume_mm3, radius_mm, shear_modulus_kpa) = (1.4, 0.9, 26.0);
        let bubble = bubble_kpa(volume_mm3, radius_mm, shear_modulus_kpa);
        for gel_kpa in [-40.0, -1.0, 0.0, 0.3, 20.0, 150.0, 900.0] {
            let air = air_kpa(bubble, gel_kpa);
            let by_boyle = volume_mm3 * (1.0 - ATMOSPHERE_KPA / (ATMOSPHERE_KPA + air));
            // The volume of a crack is 16 (1 - ν²) a³ p / (3 E). The bulge is half of it, with ν =
            // 1/2 and E = 3 G.
            let crack = 16.0 * 0.75 * radius_mm.powi(3) * (gel_kpa - air) / (9.0 * shear_modulus_kpa);
            assert!((by_boyle - 0.5 * crack).abs() < 1e-9, "{gel_kpa} {air}");
        }
    }

    #[test]
    fn a_bulge_of_the_form_of_half_a_crack_holds_what_its_volume_says() {
        // Opening of each side, Sneddon: 4 (1 - ν²) p / (π E) √(a² - r²).
        let (radius_mm, pressure_kpa, shear_modulus_kpa) = (1.3, 2.0, 26.0);
        let n = 20_000;
        let width = radius_mm / f64::from(n);
        let opening = |r: f64| {
            4.0 * 0.75 * pressure_kpa / (PI * 3.0 * shear_modulus_kpa)
                * (radius_mm * radius_mm - r * r).sqrt()
        };
        let volume: f64 = (0..n)
            .map(|i| (f64::from(i) + 0.5) * width)
            .map(|r| 2.0 * PI * r * opening(r) * width)
            .sum();
        // ΔV = V₀ (P - e) / B.
        let expected = pressure_kpa / bubble_kpa(1.0, radius_mm, shear_modulus_kpa);
        assert!((volume / expected - 1.0).abs() < 1e-5, "{volume} {expected}");
    }

    #[test]
    fn a_bubble_takes_its_share_of_a_small_pressure_and_less_of_a_large_one() {
        let bubble = 50.0;
        let small = air_kpa(bubble, 1e-6) / 1e-6;
        assert!((small - ATMOSPHERE_KPA / (ATMOSPHERE_KPA + bubble)).abs() < 1e-6);
        let shares = [1.0, 10.0, 100.0, 1000.0].map(|gel_kpa| air_kpa(bubble, gel_kpa) / gel_kpa);
        assert!(
            shares.windows(2).all(|pair| pair[0] < pair[1]) && shares[3] < 1.0,
            "{shares:?}"
        );
    }

    #[test]
    fn a_port_without_a_bubble_reads_the_gel() {
        let vanishing = air_kpa(1e-9, 37.0);
        assert!((vanishing - 37.0).abs() < 1e-8);
        assert_eq!(air_kpa(0.0, 37.0), 37.0);
    }
}
