//! Confusion matrices.

use serde::{Deserialize, Serialize};

/// Numbers of trials by true and by found class.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Confusion {
    /// True class, found class; `[n_classes][n_classes]`.
    pub counts: Vec<Vec<usize>>,
}

impl Confusion {
    /// A matrix of zeros.
    #[must_use]
    pub fn new(n_classes: usize) -> Self {
        Self {
            counts: vec![vec![0; n_classes]; n_classes],
        }
    }

    /// Counts a trial.
    ///
    /// # Panics
    /// If a class is not below the number of classes.
    pub fn count(&mut self, truth: usize, found: usize) {
        self.counts[truth][found] += 1;
    }

    /// Adds the counts of another matrix with the same number of classes.
    pub fn add(&mut self, other: &Self) {
        for (row, others) in self.counts.iter_mut().zip(&other.counts) {
            row.iter_mut()
                .zip(others)
                .for_each(|(count, other)| *count += other);
        }
    }

    /// Fraction of the trials whose class was found, %; `None` if there are no trials.
    #[must_use]
    pub fn accuracy_percent(&self) -> Option<f64> {
        let right: usize = self
            .counts
            .iter()
            .enumerate()
            .map(|(class, row)| row[class])
            .sum();
        let all: usize = self.counts.iter().flatten().sum();
        (all > 0).then(|| 100.0 * right as f64 / all as f64)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn accuracy_is_the_part_on_the_diagonal() {
        let mut confusion = Confusion::new(3);
        assert_eq!(confusion.accuracy_percent(), None);
        for (truth, found) in [(0, 0), (1, 1), (2, 1), (2, 2)] {
            confusion.count(truth, found);
        }
        assert_eq!(confusion.counts[2], [0, 1, 1]);
        assert_eq!(confusion.accuracy_percent(), Some(75.0));
        confusion.add(&confusion.clone());
        assert_eq!(confusion.counts[2], [0, 2, 2]);
    }
}
