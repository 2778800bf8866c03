//! Errors of this crate.

/// An invalid constant.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("`{field}` {problem}; {hint}")]
pub struct MaterialError {
    /// The constant, with its name in files: `terms[1].alpha`.
    pub field: String,
    /// What is wrong: the end of a sentence that begins with the field's name.
    pub problem: String,
    /// What to do about it.
    pub hint: String,
}

impl MaterialError {
    /// A value that is not the expected one.
    pub(crate) fn value(field: impl Into<String>, found: f64, expected: &str) -> Self {
        Self {
            field: field.into(),
            problem: format!("is {found}"),
            hint: format!("give {expected}"),
        }
    }
}

/// Fails unless the number is finite.
pub(crate) fn finite(field: &str, value: f64) -> Result<(), MaterialError> {
    if value.is_finite() {
        Ok(())
    } else {
        Err(MaterialError::value(field, value, "a finite number"))
    }
}

/// Fails unless the number is finite and above zero.
pub(crate) fn positive(field: &str, value: f64) -> Result<(), MaterialError> {
    if value.is_finite() && value > 0.0 {
        Ok(())
    } else {
        Err(MaterialError::value(field, value, "a number above 0"))
    }
}
