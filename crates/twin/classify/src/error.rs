//! What can go wrong.

/// Trials that cannot be learned from.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum ClassifyError {
    /// Nothing to learn from.
    #[error("there are no trials to train with")]
    NoTrials,
    /// Trials of different sensors.
    #[error("a trial has {found} taxels, the first has {expected}")]
    Taxels {
        /// Of the first trial.
        expected: usize,
        /// Of another one.
        found: usize,
    },
    /// A class beyond the number of classes.
    #[error("a trial is of class {class}, but there are {n_classes}")]
    Class {
        /// Of the trial.
        class: usize,
        /// How many there are.
        n_classes: usize,
    },
    /// A setting that makes no sense.
    #[error("setting {0}")]
    Setting(#[from] twintac_config::Problem),
}
