//! The error for a surrogate of one gel used with a sensor of another.

use std::fmt;

/// A surrogate and a sensor that do not belong together.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[error("the surrogate of the gel of sensor `{of}` is not that of `{sensor}`: {}; train one with `twintac fast train`", list(.differences))]
pub struct FastGelMismatch {
    /// Name of the sensor that the surrogate was trained for.
    pub of: String,
    /// Name of the sensor that it was used with.
    pub sensor: String,
    pub(crate) differences: Vec<Difference>,
}

impl FastGelMismatch {
    /// An error if there are differences. `of` and `sensor` are names of sensors: the one that the
    /// surrogate was trained for, and the one that it was used with.
    pub(crate) fn of((of, sensor): (&str, &str), differences: Vec<Difference>) -> Result<(), Self> {
        if differences.is_empty() {
            return Ok(());
        }
        Err(Self {
            of: of.to_owned(),
            sensor: sensor.to_owned(),
            differences,
        })
    }
}

/// One difference between a surrogate and a sensor.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Difference {
    pub(crate) what: String,
    pub(crate) fast: String,
    pub(crate) sensor: String,
}

impl fmt::Display for Difference {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { what, fast, sensor } = self;
        write!(f, "{what}: {fast}, the sensor's {sensor}")
    }
}

fn list(differences: &[Difference]) -> String {
    let texts: Vec<String> = differences.iter().map(Difference::to_string).collect();
    texts.join("; ")
}
