//! How unlike a contact is to all that was taught.

mod descriptor;
mod nearest;

pub(crate) use descriptor::N_TRAITS;
pub(crate) use nearest::Novelty;
