//! Errors of a fit.

/// A fit that cannot be made.
#[derive(Debug, thiserror::Error)]
pub enum CalibrateError {
    /// A parameter that does not exist.
    #[error("there is no parameter `{name}`; with the material as it is described there are {known}")]
    Parameter {
        /// The requested name.
        name: String,
        /// The names that exist.
        known: String,
    },
    /// A parameter that this fit cannot vary.
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
    /// The number of usable samples does not exceed the number of unknowns.
    #[error(
        "{found} usable samples cannot determine {unknowns} unknowns; expected more samples than unknowns"
    )]
    TooFew {
        /// Usable samples of all curves.
        found: usize,
        /// Unknowns.
        unknowns: usize,
    },
    /// A press that cannot be simulated with the initial values.
    #[error("{curve}: {error}")]
    Simulate {
        /// Name of the curve.
        curve: String,
        /// Why.
        error: twintac_simulate::SimulateError,
    },
}
