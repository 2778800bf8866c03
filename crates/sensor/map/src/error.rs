//! Errors of pressure maps.

/// Why a pressure map could not be made.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum MapError {
    /// Two inputs have different lengths, or a setting is out of its range.
    #[error("{what}: expected {expected}, found {found}")]
    Input {
        /// The wrong input.
        what: &'static str,
        /// The expected value.
        expected: String,
        /// The value found.
        found: String,
    },
    /// The interpolation through the taxels has no unique solution.
    #[error(
        "the pressure map cannot meet the taxels' values: two taxels are at the same location (pivot {pivot:e})"
    )]
    Singular {
        /// The smallest pivot, relative to a diagonal of one.
        pivot: f64,
    },
}

pub(crate) fn check_length(
    what: &'static str,
    values: &[f64],
    taxels_mm: &[[f64; 2]],
) -> Result<(), MapError> {
    if values.len() == taxels_mm.len() {
        return Ok(());
    }
    let expected = format!("one for each of {} taxels", taxels_mm.len());
    Err(input(what, &expected, values.len()))
}

/// Checks that readings are finite or missing (NaN).
pub(crate) fn check_finite_or_missing(above_kpa: &[f64]) -> Result<(), MapError> {
    let infinite = above_kpa.iter().find(|above| above.is_infinite());
    match infinite {
        Some(above) => {
            let expected = "finite ones, and NaN for a taxel without a reading";
            Err(input("readings of a pressure map", expected, above))
        }
        None => Ok(()),
    }
}

pub(crate) fn check_grid([columns, rows]: [usize; 2]) -> Result<(), MapError> {
    if columns == 0 || rows == 0 {
        return Err(input(
            "grid of a pressure map",
            "at least one cell",
            format!("{columns} x {rows}"),
        ));
    }
    Ok(())
}

pub(crate) fn input(what: &'static str, expected: &str, found: impl ToString) -> MapError {
    MapError::Input {
        what,
        expected: expected.to_owned(),
        found: found.to_string(),
    }
}
