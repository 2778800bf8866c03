//! All models.

use serde::{Deserialize, Serialize};

use crate::{
    Elastic, Law, LogarithmicNeoHookean, MaterialError, MooneyRivlin, NeoHookean, Ogden, StableNeoHookean,
    Yeoh,
};

/// Work that is done with whichever law a model has.
pub trait Visitor {
    /// What comes of it.
    type Output;

    /// Does it.
    fn visit<L: Law>(self, law: L) -> Self::Output;
}

/// Makes the enumeration of models from their types, and the names that files have for them.
macro_rules! models {
    ($($(#[$meaning:meta])* $model:ident = $name:literal,)+) => {
        /// The answer to a change of shape: a model with its constants.
        #[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
        #[serde(tag = "model")]
        pub enum Model {
            $($(#[$meaning])* #[serde(rename = $name)] $model($model),)+
        }

        impl Model {
            /// The name that files have for it.
            #[must_use]
            pub fn name(&self) -> &'static str {
                match self {
                    $(Self::$model(_) => $name,)+
                }
            }

            /// Does some work with its law.
            #[inline(always)]
            pub fn visit<V: Visitor>(&self, visitor: V) -> V::Output {
                match self {
                    $(Self::$model(model) => visitor.visit(model.law()),)+
                }
            }

            /// Refuses constants that make no material.
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

            /// See [`Elastic::in_words`].
            #[must_use]
            pub fn in_words(&self) -> String {
                match self {
                    $(Self::$model(model) => model.in_words(),)+
                }
            }

            /// See [`Elastic::volume_modulus_kpa`].
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
    /// See [`NeoHookean`].
    NeoHookean = "neo-hookean",
    /// See [`MooneyRivlin`].
    MooneyRivlin = "mooney-rivlin",
    /// See [`Yeoh`].
    Yeoh = "yeoh",
    /// See [`Ogden`].
    Ogden = "ogden",
    /// See [`LogarithmicNeoHookean`].
    LogarithmicNeoHookean = "logarithmic-neo-hookean",
    /// See [`StableNeoHookean`].
    StableNeoHookean = "stable-neo-hookean",
}
