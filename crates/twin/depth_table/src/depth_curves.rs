//! A table over depth, read at any depth or any force.

use std::ops::Range;

use crate::{DepthTable, DepthTableError, MonotoneCubic};

/// Smallest step of depth, mm, or force, N, that counts as an increase.
const STEP: f64 = 1e-9;

/// Values of each taxel: pressure, stress feature and three slopes.
const COLUMNS: usize = 5;

/// Monotone cubics through a table over depth: zero above the surface. Beyond the table's end, the
/// force continues as a straight line over depth^n; pressures, stress features and slopes keep
/// their last values.
///
/// They run over depth^n. Here n is the power with which the force begins to grow (Hertz's 3/2
/// under a ball, 1 under a flat punch), because force and pressures begin as straight lines over
/// depth^n. A table of ten depths is then as accurate as one of fifty.
#[derive(Clone, Debug)]
pub struct DepthCurves {
    growth: f64,
    force_n: MonotoneCubic,
    /// From force to depth^n.
    loading: MonotoneCubic,
    /// Port pressures, then stress features, then the slopes of each port; `[5 * n_taxels]`.
    features: Vec<MonotoneCubic>,
    max_depth_mm: f64,
    max_force_n: f64,
}

impl DepthCurves {
    /// Interpolates a table.
    ///
    /// # Errors
    /// A table with another number of taxels, with values that are not finite, without a frame
    /// below the surface, or with depths that do not increase.
    pub fn new(table: &DepthTable, n_taxels: usize) -> Result<Self, DepthTableError> {
        let mut knots = vec![Knot {
            depth_mm: 0.0,
            force_n: 0.0,
            features: vec![0.0; COLUMNS * n_taxels],
        }];
        for frame in table.frames.iter().filter(|frame| frame.depth_mm > STEP) {
            let values = [&frame.port_pressure_kpa[..], &frame.stress_feature_kpa_per_mm[..]];
            let slopes = &frame.port_slope_kpa_per_mm;
            if let Some(found) = values
                .map(<[f64]>::len)
                .into_iter()
                .chain([slopes.len()])
                .find(|found| *found != n_taxels)
            {
                return Err(DepthTableError::Taxels {
                    expected: n_taxels,
                    found,
                });
            }
            let features = [values[0], values[1], slopes.as_flattened()].concat();
            if !features
                .iter()
                .chain([&frame.force_n, &frame.depth_mm])
                .all(|value| value.is_finite())
            {
                return Err(DepthTableError::NotFinite {
                    depth_mm: frame.depth_mm,
                });
            }
            knots.push(Knot {
                depth_mm: frame.depth_mm,
                force_n: frame.force_n,
                features,
            });
        }
        if knots.len() < 2 {
            let failure = table.failure.clone();
            return Err(DepthTableError::NoPress {
                found: failure.unwrap_or_else(|| "no frame below the surface".into()),
            });
        }
        Self::from_knots(&knots).ok_or(DepthTableError::Order)
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
        let curve = |value: &dyn Fn(&Knot) -> f64| {
            MonotoneCubic::new(grown.clone(), knots.iter().map(value).collect())
        };
        Some(Self {
            force_n: curve(&|knot| knot.force_n)?,
            growth,
            loading: MonotoneCubic::new(
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

    fn grown(&self, depth_mm: f64) -> f64 {
        depth_mm.max(0.0).powf(self.growth)
    }

    /// Force of the indenter at a depth, N.
    #[must_use]
    pub fn force_n(&self, depth_mm: f64) -> f64 {
        self.force_n.straight_on(self.grown(depth_mm))
    }

    /// Depth at a force, mm.
    #[must_use]
    pub fn depth_mm(&self, force_n: f64) -> f64 {
        self.loading.at(force_n).powf(self.growth.recip())
    }

    /// Port pressure of each taxel at a depth, kPa; `[n_taxels]`.
    #[must_use]
    pub fn pressure_kpa(&self, depth_mm: f64) -> Vec<f64> {
        self.pressures_kpa(depth_mm).collect()
    }

    /// As [`Self::pressure_kpa`], as an iterator.
    pub fn pressures_kpa(&self, depth_mm: f64) -> impl Iterator<Item = f64> {
        self.read(0..self.n_taxels(), depth_mm)
    }

    /// Stress feature of each taxel at a depth, kPa/mm; `[n_taxels]`.
    #[must_use]
    pub fn stress_kpa_per_mm(&self, depth_mm: f64) -> Vec<f64> {
        self.stresses_kpa_per_mm(depth_mm).collect()
    }

    /// As [`Self::stress_kpa_per_mm`], as an iterator.
    pub fn stresses_kpa_per_mm(&self, depth_mm: f64) -> impl Iterator<Item = f64> {
        self.read(self.n_taxels()..2 * self.n_taxels(), depth_mm)
    }

    /// Derivatives of each port's pressure with respect to its x, y and radius, at a depth, kPa/mm;
    /// `[n_taxels]`.
    #[must_use]
    pub fn slope_kpa_per_mm(&self, depth_mm: f64) -> Vec<[f64; 3]> {
        self.slopes_kpa_per_mm(depth_mm).collect()
    }

    /// As [`Self::slope_kpa_per_mm`], as an iterator.
    pub fn slopes_kpa_per_mm(&self, depth_mm: f64) -> impl Iterator<Item = [f64; 3]> {
        let grown = self.grown(depth_mm);
        let ports = self.features[2 * self.n_taxels()..].as_chunks::<3>().0.iter();
        ports.map(move |port| port.each_ref().map(|curve| curve.at(grown)))
    }

    fn n_taxels(&self) -> usize {
        self.features.len() / COLUMNS
    }

    fn read(&self, columns: Range<usize>, depth_mm: f64) -> impl Iterator<Item = f64> {
        let grown = self.grown(depth_mm);
        self.features[columns].iter().map(move |curve| curve.at(grown))
    }

    /// Depth at which the table ends, mm.
    #[must_use]
    pub fn max_depth_mm(&self) -> f64 {
        self.max_depth_mm
    }

    /// Force at which the table ends, N.
    #[must_use]
    pub fn max_force_n(&self) -> f64 {
        self.max_force_n
    }
}

/// The power of depth with which the force begins to grow, from the first two depths below the
/// surface.
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
    use crate::{PressFrame, SolveQuality};

    /// Hertz's force, and two pressures that are proportional to it.
    fn table() -> DepthTable {
        let frame = |i: i32| {
            let depth_mm = 2.0 * (f64::from(i) / 14.0).powf(1.25);
            let force_n = hertz_n(depth_mm);
            PressFrame {
                depth_mm,
                force_n,
                port_pressure_kpa: vec![10.0 * force_n, 5.0 * force_n],
                port_slope_kpa_per_mm: vec![[force_n, 2.0 * force_n, -force_n]; 2],
                stress_feature_kpa_per_mm: vec![3.0 * force_n, force_n],
                quality: SolveQuality {
                    iterations: 3,
                    residual: 0.0,
                    penetration_mm: 0.0,
                    smallest_volume_ratio: 0.9,
                    wall_time_s: 0.0,
                },
            }
        };
        DepthTable {
            indenter: "ball".into(),
            gel_from_indenter_at_touch: twintac_shape::Pose::IDENTITY,
            n_nodes: 1,
            frames: (0..=14).map(frame).collect(),
            failure: None,
        }
    }

    fn hertz_n(depth_mm: f64) -> f64 {
        2.0 * depth_mm.powf(1.5)
    }

    #[test]
    fn depth_and_force_agree_and_nothing_is_felt_above_the_gel() {
        let curves = DepthCurves::new(&table(), 2).unwrap();
        for depth_mm in [0.1, 0.77, 1.9] {
            let force_n = hertz_n(depth_mm);
            assert!((curves.force_n(depth_mm) / force_n - 1.0).abs() < 0.001);
            assert!((curves.depth_mm(force_n) - depth_mm).abs() < 0.001);
            assert!((curves.pressure_kpa(depth_mm)[1] / (5.0 * force_n) - 1.0).abs() < 0.001);
            assert!((curves.slope_kpa_per_mm(depth_mm)[1][1] / (2.0 * force_n) - 1.0).abs() < 0.001);
            assert!((curves.stress_kpa_per_mm(depth_mm)[0] / (3.0 * force_n) - 1.0).abs() < 0.001);
        }
        assert_eq!(curves.pressure_kpa(-0.3), [0.0; 2]);
        assert_eq!(curves.force_n(0.0), 0.0);
        // Hertz's force over depth^1.5 is a straight line.
        assert!((curves.force_n(2.3) / hertz_n(2.3) - 1.0).abs() < 0.01);
    }

    #[test]
    fn a_table_without_a_press_says_why() {
        let mut table = table();
        table.frames.truncate(1);
        table.failure = Some("at 0.1 mm: no".into());
        let error = DepthCurves::new(&table, 2).unwrap_err();
        assert!(error.to_string().contains("at 0.1 mm"), "{error}");
    }

    #[test]
    fn another_number_of_taxels_other_orders_and_nan_are_refused() {
        assert_eq!(
            DepthCurves::new(&table(), 8).unwrap_err(),
            DepthTableError::Taxels {
                expected: 8,
                found: 2
            }
        );
        let mut backwards = table();
        backwards.frames.reverse();
        assert_eq!(
            DepthCurves::new(&backwards, 2).unwrap_err(),
            DepthTableError::Order
        );
        let mut broken = table();
        broken.frames[3].force_n = f64::NAN;
        assert!(matches!(
            DepthCurves::new(&broken, 2).unwrap_err(),
            DepthTableError::NotFinite { .. }
        ));
    }
}
