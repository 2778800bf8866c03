//! `W̄ = Σ_p μ_p/α_p (λ̄1^α_p + λ̄2^α_p + λ̄3^α_p - 3)` (Ogden, Proc. R. Soc. Lond. A 326, 1972).
//!
//! Its shear modulus is `½ Σ μ_p α_p`. Other programs use the factor `2 μ_p/α_p²`: multiply their
//! `μ_p` by `2/α_p` to get the `μ_p` of this program.

use serde::{Deserialize, Serialize};

use crate::error::finite;
use crate::stretches::Stretches;
use crate::wide::{Real, Wide};
use crate::{Elastic, MaterialError, StretchLaw, StretchSlopes};

/// `Σ μ_p/α_p (λ̄1^α_p + λ̄2^α_p + λ̄3^α_p - 3)` in the isochoric principal stretches (Ogden, 1972)
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Ogden {
    /// The terms, one or more.
    pub terms: Vec<OgdenTerm>,
}

/// A term of an Ogden series.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct OgdenTerm {
    /// Its modulus μ, kPa. It has the sign of α if the term by itself is stable.
    pub mu_kpa: f64,
    /// Its exponent α.
    pub alpha: f64,
}

impl Elastic for Ogden {
    type Law<'a> = Stretches<&'a Self>;

    #[inline(always)]
    fn law(&self) -> Stretches<&Self> {
        Stretches(self)
    }

    fn example() -> Self {
        let terms = [(9.0, 1.3), (0.6, 4.5), (-3.0, -2.0)];
        Self {
            terms: terms.map(|(mu_kpa, alpha)| OgdenTerm { mu_kpa, alpha }).to_vec(),
        }
    }

    fn check(&self) -> Result<(), MaterialError> {
        for (index, term) in self.terms.iter().enumerate() {
            finite(&format!("terms[{index}].mu_kpa"), term.mu_kpa)?;
            let field = format!("terms[{index}].alpha");
            finite(&field, term.alpha)?;
            if term.alpha == 0.0 {
                return Err(MaterialError::value(field, 0.0, "a number other than 0"));
            }
        }
        let sum_kpa = 2.0 * self.shear_modulus_kpa();
        if sum_kpa > 0.0 {
            return Ok(());
        }
        Err(MaterialError {
            field: "terms".into(),
            problem: format!("have products of mu_kpa and alpha that add up to {sum_kpa} kPa"),
            hint: "their sum, twice the shear modulus, has to be above 0".into(),
        })
    }

    fn shear_modulus_kpa(&self) -> f64 {
        0.5 * self
            .terms
            .iter()
            .map(|term| term.mu_kpa * term.alpha)
            .sum::<f64>()
    }

    fn in_words(&self) -> String {
        let terms = self
            .terms
            .iter()
            .map(|term| format!("μ {} kPa α {}", term.mu_kpa, term.alpha));
        terms.collect::<Vec<_>>().join(", ")
    }
}

impl StretchLaw for &Ogden {
    #[inline(always)]
    fn energy_and_slopes<T: Real>(&self, logarithms: &[Wide<T>; 3]) -> (Wide<T>, [Wide<T>; 3]) {
        let mut energy = Wide::zero();
        let mut slopes = [Wide::zero(); 3];
        for term in &self.terms {
            let powers = logarithms.map(|logarithm| (logarithm * Wide::splat(term.alpha)).exp());
            let sum = powers[0] + powers[1] + powers[2] - Wide::splat(3.0);
            energy = energy.plus_product(sum, Wide::splat(term.mu_kpa / term.alpha));
            for (slope, power) in slopes.iter_mut().zip(powers) {
                *slope = slope.plus_product(power, Wide::splat(term.mu_kpa));
            }
        }
        (energy, slopes)
    }

    #[inline(always)]
    fn derivatives<T: Real>(&self, logarithms: &[Wide<T>; 3]) -> StretchSlopes<T> {
        let zero = [Wide::zero(); 3];
        let mut found = StretchSlopes {
            slopes: zero,
            own: zero,
            between: zero,
        };
        for term in &self.terms {
            let exponents = logarithms.map(|logarithm| logarithm * Wide::splat(term.alpha));
            let powers = exponents.map(Wide::exp);
            let (mu, mu_alpha) = (Wide::splat(term.mu_kpa), Wide::splat(term.mu_kpa * term.alpha));
            for k in 0..3 {
                let (a, b) = ((k + 1) % 3, (k + 2) % 3);
                let quotient =
                    Wide::exponential_quotient([exponents[a], exponents[b]], [powers[a], powers[b]]);
                found.slopes[k] = found.slopes[k].plus_product(powers[k], mu);
                found.own[k] = found.own[k].plus_product(powers[k], mu_alpha);
                found.between[k] = found.between[k].plus_product(quotient, mu_alpha);
            }
        }
        found
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The constants of `materials/ecoflex-00-30-ogden.toml`, and the stresses of a stretched strip
    /// in their source.
    #[test]
    fn the_published_series_gives_the_published_stresses() {
        let terms = [(-0.98077, -3.848), (67.1192, 0.663), (1.69183, 4.225)];
        let terms = terms.map(|(mu_kpa, alpha)| OgdenTerm { mu_kpa, alpha }).to_vec();
        let law = Ogden { terms };
        assert!((law.shear_modulus_kpa() - 27.711).abs() < 1e-3);
        for (stretch, expected_kpa) in [(1.5_f64, 26.5), (2.0, 43.9)] {
            let logarithms = [stretch.ln(), -0.5 * stretch.ln(), -0.5 * stretch.ln()];
            let (_, slopes) = (&law).energy_and_slopes(&logarithms.map(Wide::<f64>::splat));
            let stress_kpa = (slopes[0].0[0] - slopes[1].0[0]) / stretch;
            assert!((stress_kpa - expected_kpa).abs() < 0.06, "{stress_kpa}");
        }
    }

    #[test]
    fn a_series_without_stiffness_is_refused() {
        let with = |terms: &[(f64, f64)]| {
            let terms = terms.iter().map(|&(mu_kpa, alpha)| OgdenTerm { mu_kpa, alpha });
            Ogden {
                terms: terms.collect(),
            }
            .check()
            .map_err(|found| found.to_string())
        };
        assert!(with(&[(-1.0, -2.0)]).is_ok());
        assert!(with(&[(1.0, 2.0), (1.0, -2.0)]).is_err_and(|found| found.contains("above 0")));
        assert!(with(&[]).is_err());
        assert!(with(&[(1.0, 0.0)]).is_err_and(|found| found.starts_with("`terms[0].alpha` is 0")));
        assert!(with(&[(f64::NAN, 2.0)]).is_err());
    }
}
