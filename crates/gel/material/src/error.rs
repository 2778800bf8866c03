//! Errors of this crate.

/// An invalid constant.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("`{field}` {problem}; {hint}")]
pub struct MaterialError {
    /// The constant, as files name it: `terms[1].alpha`.
    pub field: String,
    /// What is wrong, read after the field's name.
    pub problem: String,
    /// What to do about it.
    pub hint: String,
}

impl MaterialError {
    /// A value that is not as expected.
    pub(crate) fn value(field: impl Into<String>, found: f64, expected: &str) -> Self {
        Self {
            field: field.into(),
            problem: format!("is {found}"),
            hint: format!("give {expected}"),
        }
    }
}

/// Refuses what is not a finite number.
pub(crate) fn finite(field: &str, value: f64) -> Result<(), MaterialError> {
    if value.is_finite() {
        Ok(())
    } else {
        Err(MaterialError::value(field, value, "a finite number"))
    }
}

/// Refuses what is not a finite number above zero.
pub(crate) fn positive(field: &str, value: f64) -> Result<(), MaterialError> {
    if value.is_finite() && value > 0.0 {
        Ok(())
    } else {
        Err(MaterialError::value(field, value, "a number above 0"))
    }
}
