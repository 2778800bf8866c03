//! The errors of a fit.

/// A fit that can't be made.
#[derive(Debug, thiserror::Error)]
pub enum CalibrateError {
    /// A parameter that does not exist.
    #[error("there is no parameter `{name}`; with the material as it is described there are {known}")]
    Parameter {
        /// What was asked for.
        name: String,
        /// What there is.
        known: String,
    },
    /// A parameter that this fit can't have.
    #[error("`{name}` can't be free: {reason}")]
    NotFree {
        /// The parameter.
        name: String,
        /// Why not.
        reason: String,
    },
    /// A curve that cannot be fitted.
    #[error("{curve}: {problem}")]
    Curve {
        /// Its name.
        curve: String,
        /// What is wrong with it.
        problem: String,
    },
    /// Not more usable samples than unknowns.
    #[error("{found} usable samples can't tell {unknowns} unknowns; expected more samples than unknowns")]
    TooFew {
        /// Usable samples of all curves.
        found: usize,
        /// Unknowns.
        unknowns: usize,
    },
    /// A press that could not be simulated with the initial values.
    #[error("{curve}: {error}")]
    Simulate {
        /// Name of the curve.
        curve: String,
        /// Why.
        error: twintac_simulate::SimulateError,
    },
}
