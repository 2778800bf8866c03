//! Errors of impossible shapes.

/// A shape that is not possible.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[error("`{field}` is {found}, expected {expected}")]
pub struct ShapeError {
    /// The offending field.
    pub field: String,
    /// What was found.
    pub found: String,
    /// What was expected.
    pub expected: String,
}

impl ShapeError {
    pub(crate) fn new(field: &str, found: impl Into<String>, expected: impl Into<String>) -> Self {
        Self {
            field: field.to_owned(),
            found: found.into(),
            expected: expected.into(),
        }
    }

    /// The same error for a shape that is a field of another one.
    pub(crate) fn within(self, field: &str) -> Self {
        Self {
            field: format!("{field}.{}", self.field),
            ..self
        }
    }
}

/// Checks that a number is above zero.
pub(crate) fn above_zero(field: &str, found: f64) -> Result<(), ShapeError> {
    if found > 0.0 && found.is_finite() {
        return Ok(());
    }
    Err(ShapeError::new(field, found.to_string(), "a number above 0"))
}

/// Checks that a number is within limits, which are allowed themselves.
pub(crate) fn between(field: &str, found: f64, least: f64, most: f64) -> Result<(), ShapeError> {
    if (least..=most).contains(&found) {
        return Ok(());
    }
    Err(ShapeError::new(
        field,
        found.to_string(),
        format!("{least} to {most}"),
    ))
}
