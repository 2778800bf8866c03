//! The tasks by name.

use std::str::FromStr;

use twintac_shape::ShapeError;

/// A task.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    /// To tell which of five shapes is pressed by choosing where and how deep to press.
    ExploreShape,
    /// To press with a wanted force something that yields by an unknown amount.
    HoldForce,
    /// To slide along the edge of something.
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

/// A task that cannot be.
#[derive(Debug, thiserror::Error)]
pub enum TaskError {
    /// There is no task of this name.
    #[error("there is no task `{name}`; there are ExploreShape, HoldForce and FollowEdge")]
    Name {
        /// What was asked for.
        name: String,
    },
    /// A number of environments that can't be.
    #[error("`n_environments` is {found}, expected 1 to {most}")]
    Count {
        /// What was asked for.
        found: usize,
        /// Most environments, each with a sensor of this gel.
        most: usize,
    },
    /// A shape of a task can't be.
    #[error(transparent)]
    Shape(#[from] ShapeError),
    /// A picture cannot be made.
    #[error(transparent)]
    Picture(#[from] twintac_plot::PlotError),
    /// A pressure map cannot be made.
    #[error(transparent)]
    Map(#[from] twintac_map::MapError),
}
