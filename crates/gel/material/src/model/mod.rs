//! All models, each a file here. A new one needs two lines below: its module, and its entry in the list at the end.

mod logarithmic_neo_hookean;
mod mooney_rivlin;
mod neo_hookean;
mod ogden;
mod stable_neo_hookean;
mod yeoh;

use serde::{Deserialize, Serialize};

use crate::{Elastic, Law, LawProperties, MaterialError};

pub use ogden::OgdenTerm;

/// Work that is done with the law of a model, whichever that is.
pub trait Visitor {
    /// The result.
    type Output;

    /// Does the work.
    fn visit<L: Law>(self, law: L) -> Self::Output;
}

/// Makes the enumeration of models from their types, and the names that files have for them.
macro_rules! models {
    ($($file:ident::$model:ident = $name:literal,)+) => {
        $(pub use $file::$model;)+

        /// The elastic response to a change of shape: a model with its constants.
        #[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
        #[serde(tag = "model")]
        pub enum Model {
            $(#[doc = concat!("`", $name, "` in files")] #[serde(rename = $name)] $model($model),)+
        }

        impl Model {
            /// The name that files have for it.
            #[must_use]
            pub fn name(&self) -> &'static str {
                match self {
                    $(Self::$model(_) => $name,)+
                }
            }

            /// One of each model, of much the same stiffness: for tests that all models have to pass.
            #[must_use]
            pub fn examples() -> Vec<Self> {
                vec![$(Self::$model($model::example()),)+]
            }

            /// What its law is like.
            #[must_use]
            pub fn properties(&self) -> LawProperties {
                match self {
                    $(Self::$model(model) => LawProperties::of(&model.law()),)+
                }
            }

            /// Does some work with its law.
            #[inline(always)]
            pub fn visit<V: Visitor>(&self, visitor: V) -> V::Output {
                match self {
                    $(Self::$model(model) => visitor.visit(model.law()),)+
                }
            }

            /// Refuses constants that are not those of a material.
            ///
            /// # Errors
            /// The first constant that is wrong.
            pub fn check(&self) -> Result<(), MaterialError> {
                match self {
                    $(Self::$model(model) => model.check(),)+
                }
            }

            /// Shear modulus at small strain, kPa.
            #[must_use]
            pub fn shear_modulus_kpa(&self) -> f64 {
                match self {
                    $(Self::$model(model) => model.shear_modulus_kpa(),)+
                }
            }

            /// The constants besides the shear modulus, for people to read: `C10 8 kPa, C01 3.5 kPa`. May be empty.
            #[must_use]
            pub fn in_words(&self) -> String {
                match self {
                    $(Self::$model(model) => model.in_words(),)+
                }
            }

            /// The modulus κ of the mean volume change, kPa, with which the bulk modulus at small strain is the one given: the difference
            /// between that and the law's own resistance to a change of volume. Positive for a valid material.
            #[must_use]
            pub fn volume_modulus_kpa(&self, bulk_modulus_kpa: f64) -> f64 {
                match self {
                    $(Self::$model(model) => model.volume_modulus_kpa(bulk_modulus_kpa),)+
                }
            }
        }

        $(impl From<$model> for Model {
            fn from(model: $model) -> Self {
                Self::$model(model)
            }
        })+
    };
}

models! {
    neo_hookean::NeoHookean = "neo-hookean",
    mooney_rivlin::MooneyRivlin = "mooney-rivlin",
    yeoh::Yeoh = "yeoh",
    ogden::Ogden = "ogden",
    logarithmic_neo_hookean::LogarithmicNeoHookean = "logarithmic-neo-hookean",
    stable_neo_hookean::StableNeoHookean = "stable-neo-hookean",
}
