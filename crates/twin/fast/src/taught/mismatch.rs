//! A fast gel beside a sensor whose gel it is not.

use std::fmt;

/// A fast gel and a sensor that do not belong together.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[error("the fast gel of the sensor `{of}` is not that of `{sensor}`: {}; make one with `twintac fast train`", list(.differences))]
pub struct FastGelMismatch {
    /// Name of the sensor that the fast gel was taught for.
    pub of: String,
    /// Name of the sensor that it was put together with.
    pub sensor: String,
    pub(crate) differences: Vec<Difference>,
}

impl FastGelMismatch {
    /// An error if there are differences. Names are those of the sensors: the one that was taught,
    /// and the one that it was put together with.
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

/// One difference between a fast gel and a sensor.
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
