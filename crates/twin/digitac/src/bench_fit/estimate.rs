//! A fitted value with its standard error.

use serde::{Deserialize, Serialize};

/// A fitted value with its standard error.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Estimate {
    /// The value.
    pub value: f64,
    /// Its standard error, in the value's unit: from leaving out blocks of presses in turn.
    pub uncertainty: f64,
}

impl Estimate {
    /// The value from all data. The standard error comes from fits that each leave out one block
    /// (delete-a-group jackknife, Kott 2001).
    pub(crate) fn jackknife(value: f64, without_block: &[f64]) -> Self {
        let n = without_block.len() as f64;
        let mean = without_block.iter().sum::<f64>() / n.max(1.0);
        let squares: f64 = without_block.iter().map(|v| (v - mean).powi(2)).sum();
        Self {
            value,
            uncertainty: if n > 1.0 {
                ((n - 1.0) / n * squares).sqrt()
            } else {
                0.0
            },
        }
    }
}
