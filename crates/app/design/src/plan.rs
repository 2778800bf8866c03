//! The values that are tried.

use rand::Rng;
use rand::seq::SliceRandom;
use twintac_random::stream;

use crate::Variable;

/// How the values of the designs are chosen within the bounds of the variables.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Plan {
    /// A Latin hypercube: each variable's range is divided into as many equal parts as there are
    /// designs, and each part has one value (McKay, Beckman and Conover, 1979).
    LatinHypercube {
        /// Number of designs.
        n_designs: usize,
        /// Seed of all random choices.
        seed: u64,
    },
    /// All combinations of evenly spaced values of each variable, bounds included.
    Grid {
        /// Number of values of each variable.
        n_values: usize,
    },
}

impl Plan {
    /// The number of designs; `None` if it is too large for the type.
    #[must_use]
    pub fn n_designs(&self, n_variables: usize) -> Option<usize> {
        match *self {
            Self::LatinHypercube { n_designs, .. } => Some(n_designs),
            Self::Grid { n_values } => n_values.checked_pow(u32::try_from(n_variables).ok()?),
        }
    }

    /// The values of each design, rounded to four digits; `[n_designs][n_variables]`.
    pub(crate) fn values(&self, variables: &[Variable]) -> Vec<Vec<f64>> {
        let place = |variable: &Variable, part: f64| {
            let [low, high] = variable.bounds;
            rounded(low + part * (high - low))
        };
        match *self {
            Self::LatinHypercube { n_designs, seed } => {
                let columns: Vec<Vec<f64>> = variables
                    .iter()
                    .map(|variable| {
                        let mut random = stream(seed, &variable.field);
                        let mut parts: Vec<usize> = (0..n_designs).collect();
                        parts.shuffle(&mut random);
                        parts
                            .into_iter()
                            .map(|part| {
                                let inside: f64 = random.random();
                                place(variable, (part as f64 + inside) / n_designs as f64)
                            })
                            .collect()
                    })
                    .collect();
                (0..n_designs)
                    .map(|design| columns.iter().map(|column| column[design]).collect())
                    .collect()
            }
            Self::Grid { n_values } => {
                let steps = n_values.saturating_sub(1).max(1) as f64;
                let n_designs = n_values.pow(variables.len() as u32);
                (0..n_designs)
                    .map(|mut design| {
                        let mut next = || {
                            let index = design % n_values;
                            design /= n_values;
                            index as f64 / steps
                        };
                        variables.iter().map(|variable| place(variable, next())).collect()
                    })
                    .collect()
            }
        }
    }
}

/// A number, rounded to four significant digits.
fn rounded(value: f64) -> f64 {
    format!("{value:.3e}").parse().unwrap_or(value)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn variables() -> Vec<Variable> {
        ["a=0..10", "b=-1..1"].map(|text| text.parse().unwrap()).to_vec()
    }

    #[test]
    fn each_part_of_each_range_has_one_value() {
        let values = Plan::LatinHypercube {
            n_designs: 10,
            seed: 3,
        }
        .values(&variables());
        let mut tenths: Vec<usize> = values.iter().map(|design| design[0] as usize).collect();
        tenths.sort_unstable();
        assert_eq!(tenths, (0..10).collect::<Vec<_>>());
        let mut fifths: Vec<i32> = values
            .iter()
            .map(|design| (5.0 * design[1]).floor() as i32)
            .collect();
        fifths.sort_unstable();
        assert_eq!(fifths, (-5..5).collect::<Vec<_>>());
        assert_eq!(
            values,
            Plan::LatinHypercube {
                n_designs: 10,
                seed: 3
            }
            .values(&variables())
        );
        assert_ne!(
            values,
            Plan::LatinHypercube {
                n_designs: 10,
                seed: 4
            }
            .values(&variables())
        );
    }

    #[test]
    fn a_grid_has_all_combinations_with_the_bounds() {
        let plan = Plan::Grid { n_values: 3 };
        let values = plan.values(&variables());
        assert_eq!(plan.n_designs(2), Some(9));
        assert_eq!(values.len(), 9);
        assert_eq!(values[0], [0.0, -1.0]);
        assert_eq!(values[8], [10.0, 1.0]);
        assert_eq!(Plan::Grid { n_values: 100 }.n_designs(40), None);
    }
}
