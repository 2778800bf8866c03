//! What every model provides.

use crate::{Law, MaterialError};

/// The constants of a model, in kPa where they are stresses. Field names are those of files.
pub(crate) trait Elastic: Sized {
    /// The law with these constants.
    type Law<'a>: Law
    where
        Self: 'a;

    /// The law; its energies are in kPa.
    fn law(&self) -> Self::Law<'_>;

    /// Constants of a soft silicone, with a shear modulus of about 23 kPa: what tests of all models use.
    fn example() -> Self;

    /// Refuses constants that are not those of a material.
    ///
    /// # Errors
    /// The first constant that is wrong.
    fn check(&self) -> Result<(), MaterialError>;

    /// Shear modulus at small strain, kPa.
    fn shear_modulus_kpa(&self) -> f64;

    /// As [`crate::Model::in_words`].
    fn in_words(&self) -> String;

    /// As [`crate::Model::volume_modulus_kpa`].
    fn volume_modulus_kpa(&self, bulk_modulus_kpa: f64) -> f64 {
        bulk_modulus_kpa
    }
}
