//! A figure, or the reason why there is none.

use serde::Serialize;

/// A figure, or the reason why the recordings do not give it. A missing figure is never replaced by
/// an estimate.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Finding<T> {
    /// The figure.
    Found(T),
    /// The recordings do not give it; the text says why.
    NotGiven(String),
}

impl<T> Finding<T> {
    /// The figure, if it was found.
    #[must_use]
    pub fn found(&self) -> Option<&T> {
        match self {
            Self::Found(figure) => Some(figure),
            Self::NotGiven(_) => None,
        }
    }

    /// The reason, if the figure was not found.
    #[must_use]
    pub(crate) fn why_not(&self) -> Option<&str> {
        match self {
            Self::Found(_) => None,
            Self::NotGiven(why) => Some(why),
        }
    }
}

impl<T> Finding<Vec<T>> {
    /// The list as a finding; an empty list is a [`NotGiven`](Self::NotGiven) with this reason.
    pub(crate) fn of_list(list: Vec<T>, why: &str) -> Self {
        if list.is_empty() {
            Self::NotGiven(why.to_owned())
        } else {
            Self::Found(list)
        }
    }
}
