//! What every model provides.

use crate::{Law, MaterialError};

/// The constants of a model, in kPa where they are stresses. Field names are those of files.
pub trait Elastic: Sized {
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

    /// The constants besides the shear modulus, for people to read: `C10 8 kPa, C01 3.5 kPa`. May be empty.
    fn in_words(&self) -> String;

    /// The modulus κ of the mean volume change, kPa, with which the bulk modulus at small strain is the one given: the difference between that and
    /// the law's own resistance to a change of volume. Positive for a valid material.
    fn volume_modulus_kpa(&self, bulk_modulus_kpa: f64) -> f64 {
        bulk_modulus_kpa
    }
}
