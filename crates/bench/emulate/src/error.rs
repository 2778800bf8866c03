//! Errors when the emulated devices are set up.

/// Why the devices cannot be emulated.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum EmulateError {
    /// The operating system gave no socket or no thread.
    #[error("{what}: {source}")]
    System {
        /// What the socket or thread was for.
        what: &'static str,
        /// The error of the operating system.
        source: std::io::Error,
    },
    /// A setting is not valid.
    #[error("`{field}` {problem}")]
    Setting {
        /// The setting, as a dotted path.
        field: String,
        /// What is wrong, read after the field's name.
        problem: String,
    },
}

impl EmulateError {
    pub(crate) fn setting(field: impl Into<String>, problem: impl Into<String>) -> Self {
        Self::Setting {
            field: field.into(),
            problem: problem.into(),
        }
    }
}

/// Checks that numbers are finite and above zero.
pub(crate) fn check_positive(fields: &[(&str, f64)]) -> Result<(), EmulateError> {
    check(fields, "expected a number above zero", |number| number > 0.0)
}

/// Checks that numbers are finite and not below zero.
pub(crate) fn check_not_negative(fields: &[(&str, f64)]) -> Result<(), EmulateError> {
    check(fields, "expected zero or more", |number| number >= 0.0)
}

fn check(fields: &[(&str, f64)], expected: &str, is_fine: fn(f64) -> bool) -> Result<(), EmulateError> {
    match fields
        .iter()
        .find(|(_, number)| !number.is_finite() || !is_fine(*number))
    {
        Some((field, number)) => Err(EmulateError::setting(*field, format!("is {number}, {expected}"))),
        None => Ok(()),
    }
}
