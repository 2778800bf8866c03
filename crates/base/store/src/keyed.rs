//! A value whose digest is computed once.

use std::ops::Deref;

use serde::{Serialize, Serializer};

use crate::{Digest, StoreError};

/// A value that many recipes share, with its digest. It is written as that.
#[derive(Clone, Copy, Debug)]
pub struct Keyed<T> {
    value: T,
    digest: Digest,
}

impl<T: Serialize> Keyed<T> {
    /// Takes the digest of all that the value is written as.
    ///
    /// # Errors
    /// A value that JSON has no form for.
    pub fn new(value: T) -> Result<Self, StoreError> {
        let digest = Digest::of_value(&value).map_err(|source| StoreError::Json {
            what: "an input".to_owned(),
            source,
        })?;
        Ok(Self { value, digest })
    }
}

impl<T> Keyed<T> {
    /// A value that follows from these bytes alone, such as what a file says.
    #[must_use]
    pub fn of_bytes(value: T, bytes: &[u8]) -> Self {
        let digest = Digest::of(bytes);
        Self { value, digest }
    }

    /// A value that follows from others alone, which `from` has.
    ///
    /// # Errors
    /// A value that JSON has no form for.
    pub fn from_inputs(value: T, from: &impl Serialize) -> Result<Self, StoreError> {
        let Keyed { digest, .. } = Keyed::new(from)?;
        Ok(Self { value, digest })
    }

    /// What tells it from others.
    #[must_use]
    pub fn digest(&self) -> Digest {
        self.digest
    }
}

impl<T> Deref for Keyed<T> {
    type Target = T;

    fn deref(&self) -> &T {
        &self.value
    }
}

impl<T> Serialize for Keyed<T> {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        self.digest.serialize(serializer)
    }
}
