//! Errors of training.

/// Trials or settings that cannot be used for training.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum ClassifyError {
    /// There are no trials.
    #[error("there are no trials to train with")]
    NoTrials,
    /// Trials of sensors with different numbers of taxels.
    #[error("a trial has {found} taxels, the first has {expected}")]
    Taxels {
        /// Taxels of the first trial.
        expected: usize,
        /// Taxels of another trial.
        found: usize,
    },
    /// A class beyond the number of classes.
    #[error("a trial is of class {class}, but there are {n_classes}")]
    Class {
        /// Class of the trial.
        class: usize,
        /// Number of classes.
        n_classes: usize,
    },
    /// A setting outside its range.
    #[error("setting {0}")]
    Setting(#[from] twintac_config::Problem),
}
