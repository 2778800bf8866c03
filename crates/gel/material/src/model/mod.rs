//! All models, one file each. A new model needs two lines below: its module, and its entry in the
//! list at the end.

mod logarithmic_neo_hookean;
mod mooney_rivlin;
mod neo_hookean;
mod ogden;
mod stable_neo_hookean;
mod yeoh;

use serde::{Deserialize, Serialize};

use crate::{Elastic, Law, LawProperties, MaterialError};

pub use ogden::OgdenTerm;

/// Code that can work with the law of any model.
pub trait Visitor {
    /// The result.
    type Output;

    /// Works with the law.
    fn visit<L: Law>(self, law: L) -> Self::Output;
}

/// Makes the enumeration of models from their types and the names that they have in files.
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
            /// The name that it has in files.
            #[must_use]
            pub fn name(&self) -> &'static str {
                match self {
                    $(Self::$model(_) => $name,)+
                }
            }

            /// One example of each model, all of similar stiffness: for tests that all models have
            /// to pass.
            #[must_use]
            pub fn examples() -> Vec<Self> {
                vec![$(Self::$model($model::example()),)+]
            }

            /// The properties of its law.
            #[must_use]
            pub fn properties(&self) -> LawProperties {
                match self {
                    $(Self::$model(model) => LawProperties::of(&model.law()),)+
                }
            }

            /// Calls `visitor` with its law.
            #[inline(always)]
            pub fn visit<V: Visitor>(&self, visitor: V) -> V::Output {
                match self {
                    $(Self::$model(model) => visitor.visit(model.law()),)+
                }
            }

            /// Checks that the constants are those of a material.
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

            /// The constants other than the shear modulus, as text: `C10 8 kPa, C01 3.5 kPa`. May
            /// be empty.
            #[must_use]
            pub fn in_words(&self) -> String {
                match self {
                    $(Self::$model(model) => model.in_words(),)+
                }
            }

            /// The modulus κ of the averaged volume change, kPa, that gives this bulk modulus at
            /// small strain: the bulk modulus minus the law's own resistance to a change of volume.
            /// It is positive for a valid material.
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
