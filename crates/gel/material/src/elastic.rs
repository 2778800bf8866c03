//! The interface of all models.

use crate::{Law, MaterialError};

/// The constants of a model; stresses are in kPa. The names of the fields are those in files.
pub(crate) trait Elastic: Sized {
    /// The law with these constants.
    type Law<'a>: Law
    where
        Self: 'a;

    /// The law; its energies are in kPa.
    fn law(&self) -> Self::Law<'_>;

    /// Constants of a soft silicone with a shear modulus of about 23 kPa, which the tests of all
    /// models use.
    fn example() -> Self;

    /// Checks that the constants are those of a material.
    ///
    /// # Errors
    /// The first constant that is wrong.
    fn check(&self) -> Result<(), MaterialError>;

    /// Shear modulus at small strain, kPa.
    fn shear_modulus_kpa(&self) -> f64;

    /// See [`crate::Model::in_words`].
    fn in_words(&self) -> String;

    /// See [`crate::Model::volume_modulus_kpa`].
    fn volume_modulus_kpa(&self, bulk_modulus_kpa: f64) -> f64 {
        bulk_modulus_kpa
    }
}
