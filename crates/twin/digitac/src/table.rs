//! A sweep, read at any depth or any force.

use twintac_simulate::{Pchip, Sweep};

use crate::DigitacError;

/// Smallest step of depth, mm, or force, N, that counts as an increase.
const STEP: f64 = 1e-9;

/// Monotone cubics through a sweep: zero above the surface, the end of the table beyond it.
///
/// They run over depth^n, with n the power by which the force begins to grow (Hertz's 3/2 under a ball, 1
/// under a flat punch), over which everything begins as a straight line. A table of ten depths is then as
/// good as one of fifty.
#[derive(Clone, Debug)]
pub(crate) struct SweepTable {
    growth: f64,
    force_n: Pchip,
    /// From force to depth^n.
    loading: Pchip,
    /// Port pressures, then stress features; `[2 * n_taxels]`.
    features: Vec<Pchip>,
    max_depth_mm: f64,
    max_force_n: f64,
}

impl SweepTable {
    /// Tabulates the sweep up to its first frame that did not converge.
    pub(crate) fn new(index: usize, sweep: &Sweep, n_taxels: usize) -> Result<Self, DigitacError> {
        let wrong = |expected: String, found: String| DigitacError::WrongSweep {
            index,
            expected,
            found,
        };
        let frames: Vec<_> = sweep.frames.iter().take_while(|f| f.honesty.converged).collect();
        let mut knots = vec![Knot {
            depth_mm: 0.0,
            force_n: 0.0,
            features: vec![0.0; 2 * n_taxels],
        }];
        for frame in frames.iter().filter(|frame| frame.depth_mm > STEP) {
            let features = [&frame.port_pressure_kpa[..], &frame.stress_feature_kpa_per_mm[..]].concat();
            if features.len() != 2 * n_taxels {
                return Err(wrong(
                    format!("features of {n_taxels} taxels"),
                    format!("{} numbers", features.len()),
                ));
            }
            if !features
                .iter()
                .chain([&frame.force_n, &frame.depth_mm])
                .all(|value| value.is_finite())
            {
                return Err(wrong(
                    "finite features".into(),
                    format!("none at {:.3} mm", frame.depth_mm),
                ));
            }
            knots.push(Knot {
                depth_mm: frame.depth_mm,
                force_n: frame.force_n,
                features,
            });
        }
        if knots.len() < 2 {
            let why = sweep
                .failure
                .clone()
                .unwrap_or_else(|| "no frame below the surface converged".into());
            return Err(wrong("a press into the gel".into(), why));
        }
        Self::from_knots(&knots).ok_or_else(|| wrong("increasing depth".into(), "another order".into()))
    }

    fn from_knots(knots: &[Knot]) -> Option<Self> {
        let growth = growth(knots);
        let grown: Vec<f64> = knots.iter().map(|knot| knot.depth_mm.powf(growth)).collect();
        let last = knots.last()?;
        let mut loading: Vec<&Knot> = Vec::with_capacity(knots.len());
        for knot in knots {
            if loading
                .last()
                .is_none_or(|before| knot.force_n > before.force_n + STEP)
            {
                loading.push(knot);
            }
        }
        let curve =
            |value: &dyn Fn(&Knot) -> f64| Pchip::new(grown.clone(), knots.iter().map(value).collect());
        Some(Self {
            force_n: curve(&|knot| knot.force_n)?,
            growth,
            loading: Pchip::new(
                loading.iter().map(|knot| knot.force_n).collect(),
                loading.iter().map(|knot| knot.depth_mm.powf(growth)).collect(),
            )?,
            features: (0..last.features.len())
                .map(|k| curve(&|knot| knot.features[k]))
                .collect::<Option<_>>()?,
            max_depth_mm: last.depth_mm,
            max_force_n: loading.last()?.force_n,
        })
    }

    /// The weighted mean of tables of the same press, resampled at `n_knots` depths.
    pub(crate) fn blend(tables: &[&Self], weights: &[f64], n_knots: usize) -> Option<Self> {
        let max_depth_mm = tables
            .iter()
            .map(|table| table.max_depth_mm)
            .fold(f64::INFINITY, f64::min);
        let n_features = tables.first()?.features.len();
        let mean =
            |value: &dyn Fn(&Self) -> f64| tables.iter().zip(weights).map(|(t, w)| w * value(t)).sum::<f64>();
        let knots: Vec<Knot> = (0..n_knots)
            .map(|i| {
                let depth_mm = max_depth_mm * i as f64 / (n_knots - 1) as f64;
                Knot {
                    depth_mm,
                    force_n: mean(&|t| t.force_n(depth_mm)),
                    features: (0..n_features)
                        .map(|k| mean(&|t| t.features[k].at(t.grown(depth_mm))))
                        .collect(),
                }
            })
            .collect();
        Self::from_knots(&knots)
    }

    fn grown(&self, depth_mm: f64) -> f64 {
        depth_mm.max(0.0).powf(self.growth)
    }

    /// Force of the indenter at a depth, N.
    pub(crate) fn force_n(&self, depth_mm: f64) -> f64 {
        self.force_n.at(self.grown(depth_mm))
    }

    /// Depth at a force, mm.
    pub(crate) fn depth_mm(&self, force_n: f64) -> f64 {
        self.loading.at(force_n).powf(self.growth.recip())
    }

    /// Port pressure of each taxel at a depth, kPa; `[n_taxels]`.
    pub(crate) fn pressure_kpa(&self, depth_mm: f64) -> Vec<f64> {
        let grown = self.grown(depth_mm);
        self.features[..self.features.len() / 2]
            .iter()
            .map(|curve| curve.at(grown))
            .collect()
    }

    /// Stress feature of each taxel at a depth, kPa/mm; `[n_taxels]`.
    pub(crate) fn stress_kpa_per_mm(&self, depth_mm: f64) -> Vec<f64> {
        let grown = self.grown(depth_mm);
        self.features[self.features.len() / 2..]
            .iter()
            .map(|curve| curve.at(grown))
            .collect()
    }

    /// Depth at which the table ends, mm.
    pub(crate) fn max_depth_mm(&self) -> f64 {
        self.max_depth_mm
    }

    /// Force at which the table ends, N.
    pub(crate) fn max_force_n(&self) -> f64 {
        self.max_force_n
    }
}

/// The power of depth with which the force begins to grow, from the first two depths below the surface.
fn growth(knots: &[Knot]) -> f64 {
    match knots {
        [_, a, b, ..] if a.force_n > 0.0 && b.force_n > a.force_n && b.depth_mm > a.depth_mm => {
            ((b.force_n / a.force_n).ln() / (b.depth_mm / a.depth_mm).ln()).clamp(1.0, 2.0)
        }
        _ => 1.5,
    }
}

struct Knot {
    depth_mm: f64,
    force_n: f64,
    features: Vec<f64>,
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::SweepSource;
    use crate::synthetic::Formula;

    fn sweep() -> Sweep {
        let touch = twintac_shape::Pose::from_position(glam::DVec3::new(1.0, 0.0, 6.0));
        let request = crate::SweepRequest {
            indenter: "tip".into(),
            gel_from_indenter_at_touch: touch,
            max_depth_mm: 2.0,
            enough_force_n: None,
            tip_radius_mm: None,
        };
        Formula.sweeps(&[request]).unwrap().remove(0)
    }

    #[test]
    fn depth_and_force_agree_and_nothing_is_felt_above_the_gel() {
        let table = SweepTable::new(0, &sweep(), 4).unwrap();
        for depth_mm in [0.1, 0.77, 1.9] {
            let (force_n, pressure, _) =
                Formula::at(glam::DVec3::X, depth_mm, crate::synthetic::DESCRIBED_RADIUS_MM);
            assert!((table.force_n(depth_mm) / force_n - 1.0).abs() < 0.001);
            assert!((table.depth_mm(force_n) - depth_mm).abs() < 0.001);
            assert!((table.pressure_kpa(depth_mm)[1] / pressure[1] - 1.0).abs() < 0.01);
        }
        assert_eq!(table.pressure_kpa(-0.3), [0.0; 4]);
        assert_eq!(table.force_n(0.0), 0.0);
    }

    #[test]
    fn a_table_ends_where_the_solver_gave_up() {
        let mut sweep = sweep();
        sweep.frames[9].honesty.converged = false;
        let table = SweepTable::new(0, &sweep, 4).unwrap();
        assert_eq!(table.max_depth_mm(), sweep.frames[8].depth_mm);
        sweep.frames[1].honesty.converged = false;
        sweep.failure = Some("at 0.1 mm: no".into());
        assert!(
            SweepTable::new(3, &sweep, 4)
                .unwrap_err()
                .to_string()
                .contains("at 0.1 mm")
        );
    }

    #[test]
    fn another_number_of_taxels_is_refused() {
        assert!(SweepTable::new(0, &sweep(), 8).is_err());
    }
}
