//! A value whose digest is computed once.

use std::ops::Deref;

use serde::{Serialize, Serializer};

use crate::{Digest, StoreError};

/// A value that many recipes share, with its digest. It serializes as the digest.
#[derive(Clone, Copy, Debug)]
pub struct Keyed<T> {
    value: T,
    digest: Digest,
}

impl<T: Serialize> Keyed<T> {
    /// Takes the digest of everything that the value serializes to.
    ///
    /// # Errors
    /// The value cannot be written as JSON.
    pub fn new(value: T) -> Result<Self, StoreError> {
        let digest = Digest::of_value(&value).map_err(|source| StoreError::Json {
            what: "an input".to_owned(),
            source,
        })?;
        Ok(Self { value, digest })
    }
}

impl<T> Keyed<T> {
    /// A value that depends on these bytes alone, for example on the contents of a file.
    #[must_use]
    pub fn of_bytes(value: T, bytes: &[u8]) -> Self {
        let digest = Digest::of(bytes);
        Self { value, digest }
    }

    /// A value that depends on other values alone, which are in `from`.
    ///
    /// # Errors
    /// `from` cannot be written as JSON.
    pub fn from_inputs(value: T, from: &impl Serialize) -> Result<Self, StoreError> {
        let Keyed { digest, .. } = Keyed::new(from)?;
        Ok(Self { value, digest })
    }

    /// The digest that distinguishes the value from others.
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
