//! What was found, or why it was not.

use serde::Serialize;

/// A figure, or why the recordings do not give it. Nothing is ever put in a figure's place.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Finding<T> {
    /// The recordings give it.
    Found(T),
    /// They do not, and why.
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

    /// Why it was not found, if it was not.
    #[must_use]
    pub(crate) fn why_not(&self) -> Option<&str> {
        match self {
            Self::Found(_) => None,
            Self::NotGiven(why) => Some(why),
        }
    }
}

impl<T> Finding<Vec<T>> {
    /// The list, unless it is empty.
    pub(crate) fn of_list(list: Vec<T>, why: &str) -> Self {
        if list.is_empty() {
            Self::NotGiven(why.to_owned())
        } else {
            Self::Found(list)
        }
    }
}
