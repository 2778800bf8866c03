//! Baselines for a twin: a prediction of zero, and a polynomial without physics.

use std::collections::BTreeMap;

use twintac_fit::Triangle;

use crate::PairedPress;

/// Highest power of the depth.
const DEPTH_DEGREE: usize = 3;
/// Highest degree in the position if all presses are on a line, and highest total degree if they
/// are in a plane.
const LINE_DEGREE: usize = 8;
const PLANE_DEGREE: usize = 6;
/// Ridge over the mean diagonal of the normal matrix.
const RIDGE: f64 = 1e-5;

/// Predicts zero for every reading, kPa; `[n_frames][n_taxels]`.
#[must_use]
pub(crate) fn zero(press: &PairedPress) -> Vec<Vec<f64>> {
    press
        .readings_kpa
        .iter()
        .map(|row| vec![0.0; row.len()])
        .collect()
}

/// A polynomial in depth and position for each indenter and taxel, fitted by ridge regression. It
/// does not use time, does not transfer between indenters, and does not extrapolate: positions are
/// clamped to the range of the training presses.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct StaticPolynomial {
    by_indenter: BTreeMap<String, Fit>,
}

impl StaticPolynomial {
    /// Fits training presses.
    #[must_use]
    pub(crate) fn fit(presses: &[&PairedPress]) -> Self {
        let mut groups: BTreeMap<String, Vec<&PairedPress>> = BTreeMap::new();
        for press in presses {
            groups.entry(press.indenter.clone()).or_default().push(press);
        }
        Self {
            by_indenter: groups
                .into_iter()
                .map(|(indenter, presses)| (indenter, Fit::new(&presses)))
                .collect(),
        }
    }

    /// Predicted readings of a press, kPa; `[n_frames][n_taxels]`. Zeros for an indenter that was
    /// not fitted.
    #[must_use]
    pub(crate) fn predict(&self, press: &PairedPress) -> Vec<Vec<f64>> {
        self.by_indenter
            .get(&press.indenter)
            .map_or_else(|| zero(press), |fit| fit.predict(press))
    }
}

#[derive(Clone, Debug, PartialEq)]
struct Fit {
    depth_mm: f64,
    /// Center and half range along x and y, mm.
    frame_mm: [[f64; 2]; 2],
    /// Degrees in depth, x and y; `[n_terms]`.
    terms: Vec<[usize; 3]>,
    /// Coefficients; `[n_taxels][n_terms]`.
    coefficients: Vec<Vec<f64>>,
}

impl Fit {
    fn new(presses: &[&PairedPress]) -> Self {
        let depths = presses.iter().flat_map(|press| press.features.depth_mm.iter());
        let depth_mm = depths.fold(0.0_f64, |a, b| a.max(*b)).max(1e-9);
        let frame_mm = [0, 1].map(|axis| {
            let places = presses.iter().map(|press| press.place_mm[axis]);
            let low = places.clone().fold(f64::INFINITY, f64::min);
            let high = places.fold(f64::NEG_INFINITY, f64::max);
            [0.5 * (low + high), 0.5 * (high - low)]
        });
        let n_axes = frame_mm.iter().filter(|[_, half]| *half > 1e-6).count();
        let degree = if n_axes == 2 { PLANE_DEGREE } else { LINE_DEGREE };
        let of_axis = |axis: usize| if frame_mm[axis][1] > 1e-6 { degree } else { 0 };
        let mut terms = Vec::new();
        for a in 1..=DEPTH_DEGREE {
            for b in 0..=of_axis(0) {
                terms.extend((0..=of_axis(1)).filter(|c| b + c <= degree).map(|c| [a, b, c]));
            }
        }
        let n_taxels = presses[0].readings_kpa.first().map_or(0, Vec::len);
        let mut fit = Self {
            depth_mm,
            frame_mm,
            terms,
            coefficients: Vec::new(),
        };
        let rows: Vec<Vec<Vec<f64>>> = presses
            .iter()
            .map(|p| {
                p.features
                    .depth_mm
                    .iter()
                    .map(|d| fit.row(*d, p.place_mm))
                    .collect()
            })
            .collect();
        fit.coefficients = (0..n_taxels)
            .map(|taxel| fit.regress(presses, &rows, taxel))
            .collect();
        fit
    }

    fn row(&self, depth_mm: f64, place_mm: [f64; 2]) -> Vec<f64> {
        let depth = depth_mm.max(0.0) / self.depth_mm;
        let [x, y] = [0, 1].map(|axis| {
            let [center, half] = self.frame_mm[axis];
            if half > 1e-6 {
                ((place_mm[axis] - center) / half).clamp(-1.0, 1.0)
            } else {
                0.0
            }
        });
        // Chebyshev polynomials keep terms of high degree apart.
        let chebyshev = |degree: usize, at: f64| (degree as f64 * at.acos()).cos();
        self.terms
            .iter()
            .map(|[a, b, c]| depth.powi(*a as i32) * chebyshev(*b, x) * chebyshev(*c, y))
            .collect()
    }

    fn regress(&self, presses: &[&PairedPress], rows: &[Vec<Vec<f64>>], taxel: usize) -> Vec<f64> {
        let n = self.terms.len();
        let (mut matrix, mut right) = (vec![0.0; n * n], vec![0.0; n]);
        for (press, rows) in presses.iter().zip(rows) {
            for (frame, row) in rows
                .iter()
                .enumerate()
                .filter(|(frame, _)| press.valid[*frame][taxel])
            {
                if press.features.depth_mm[frame] <= 0.0 {
                    continue;
                }
                for (i, a) in row.iter().enumerate() {
                    right[i] += a * press.readings_kpa[frame][taxel];
                    for (to, b) in matrix[i * n..=i * n + i].iter_mut().zip(row) {
                        *to += a * b;
                    }
                }
            }
        }
        let ridge = RIDGE * (0..n).map(|i| matrix[i * n + i]).sum::<f64>() / n as f64;
        (0..n).for_each(|i| matrix[i * n + i] += ridge.max(f64::MIN_POSITIVE));
        Triangle::of(matrix, n).solve(right)
    }

    fn predict(&self, press: &PairedPress) -> Vec<Vec<f64>> {
        let rows = press
            .features
            .depth_mm
            .iter()
            .map(|depth_mm| self.row(*depth_mm, press.place_mm));
        rows.map(|row| {
            self.coefficients
                .iter()
                .map(|own| own.iter().zip(&row).map(|(c, t)| c * t).sum())
                .collect()
        })
        .collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::synthetic::by_hand;

    #[test]
    fn a_polynomial_is_recovered_between_its_places() {
        let press = |x: f64| {
            let value = |d: f64| (1.0 + 0.3 * x - 0.1 * x * x) * d * d;
            let frames: Vec<(f64, [f64; 2])> = (-2..12)
                .map(|i| 0.2 * f64::from(i))
                .map(|d| (d, [value(d.max(0.0)), -d.max(0.0)]))
                .collect();
            by_hand("", "file", [x, 0.0], &frames)
        };
        let presses: Vec<PairedPress> = (0..12).map(|i| press(0.5 * f64::from(i))).collect();
        let fit = StaticPolynomial::fit(&presses.iter().collect::<Vec<_>>());
        let unseen = press(2.2);
        for (predicted, measured) in fit.predict(&unseen).iter().zip(&unseen.readings_kpa) {
            assert!(
                predicted.iter().zip(measured).all(|(p, m)| (p - m).abs() < 0.02),
                "{predicted:?} {measured:?}"
            );
        }
        let mut other = unseen.clone();
        other.indenter = "cube".into();
        assert_eq!(fit.predict(&other), zero(&other));
    }
}
