//! The tasks by name.

use std::str::FromStr;

use twintac_shape::ShapeError;

/// A kind of task.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    /// Classify which of five shapes is pressed, by choosing where and how deep to press.
    ExploreShape,
    /// Hold a wanted force on an object of unknown stiffness.
    HoldForce,
    /// Slide along the edge of an object.
    FollowEdge,
}

impl Kind {
    /// All of them.
    pub const ALL: [Self; 3] = [Self::ExploreShape, Self::HoldForce, Self::FollowEdge];

    /// Its name.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::ExploreShape => "ExploreShape",
            Self::HoldForce => "HoldForce",
            Self::FollowEdge => "FollowEdge",
        }
    }
}

impl FromStr for Kind {
    type Err = TaskError;

    fn from_str(name: &str) -> Result<Self, TaskError> {
        let found = Self::ALL.into_iter().find(|kind| kind.name() == name);
        found.ok_or_else(|| TaskError::Name {
            name: name.to_owned(),
        })
    }
}

/// Why environments could not be made or drawn.
#[derive(Debug, thiserror::Error)]
pub enum TaskError {
    /// There is no task of this name.
    #[error("there is no task `{name}`; there are ExploreShape, HoldForce and FollowEdge")]
    Name {
        /// The name that was given.
        name: String,
    },
    /// The number of environments is out of range.
    #[error("`n_environments` is {found}, expected 1 to {most}")]
    Count {
        /// The number that was given.
        found: usize,
        /// Largest number of environments, each with a sensor of this gel.
        most: usize,
    },
    /// A shape of a task cannot exist.
    #[error(transparent)]
    Shape(#[from] ShapeError),
    /// A picture cannot be made.
    #[error(transparent)]
    Picture(#[from] twintac_plot::PlotError),
    /// A pressure map cannot be made.
    #[error(transparent)]
    Map(#[from] twintac_map::MapError),
}
