//! What is prepared once for all sensors of a kind.

use std::sync::Arc;

use twintac_config::Checked;
use twintac_fast::FastGel;
use twintac_shape::Surfaces;

use crate::error::InverseError;
use crate::fast_model::{FastModel, KnownShape};
use crate::hypothesis::Prior;
use crate::model::ContactModel;
use crate::settings::InverseSettings;
use crate::starts::Starts;

/// A forward model, and the tables that are prepared for its known shapes.
#[derive(Clone, Debug)]
pub struct Inverse<M> {
    pub(crate) model: M,
    pub(crate) shapes: Arc<Vec<Prepared>>,
    pub(crate) settings: InverseSettings,
}

#[derive(Clone, Debug)]
pub(crate) struct Prepared {
    pub(crate) prior: Prior,
    pub(crate) starts: Starts,
}

impl Inverse<FastModel> {
    /// For a [`FastGel`] and the shapes that may touch it, upright. Takes a fraction of a second
    /// for a few shapes, on all threads.
    ///
    /// # Errors
    /// No shape, an impossible shape, a setting outside its range, or too many ports for a search.
    pub fn of_fast_gel(
        gel: &FastGel,
        shapes: &[KnownShape],
        surfaces: &Surfaces,
        settings: InverseSettings,
    ) -> Result<Self, InverseError> {
        settings.checked().map_err(InverseError::Setting)?;
        Self::new(
            FastModel::new(gel, shapes, surfaces, settings.deepest_mm)?,
            settings,
        )
    }
}

impl<M: ContactModel> Inverse<M> {
    /// For any forward model.
    ///
    /// # Errors
    /// No shape, a setting outside its range, or a shape whose table is too large to be searched.
    pub fn new(model: M, settings: InverseSettings) -> Result<Self, InverseError> {
        settings.checked().map_err(InverseError::Setting)?;
        if model.n_shapes() == 0 {
            return Err(InverseError::NoShape);
        }
        let prepared = |shape| {
            Ok(Prepared {
                starts: Starts::of(&model, shape)?,
                prior: Prior::of(&model, shape),
            })
        };
        let shapes: Result<Vec<Prepared>, InverseError> = (0..model.n_shapes()).map(prepared).collect();
        Ok(Self {
            shapes: Arc::new(shapes?),
            model,
            settings,
        })
    }

    /// The forward model.
    #[must_use]
    pub fn model(&self) -> &M {
        &self.model
    }

    /// The settings.
    #[must_use]
    pub fn settings(&self) -> &InverseSettings {
        &self.settings
    }

    /// Number of known shapes.
    #[must_use]
    pub fn n_shapes(&self) -> usize {
        self.shapes.len()
    }
}
